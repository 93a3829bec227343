"""Columns of arrays of independent coordinates for closed forms (mbsd/dynamics/independent/arrays.py)."""

from __future__ import annotations

X, Y, COS, SIN, OMEGA, MASS, INERTIA = range(7)
"""Columns of EmbeddingScratch.body: place of the centre of mass, turn, rate of turning; kg, kg m^2."""
NUMBERS = 21
SIGN, NEAR, SINE, AVOID, CHANGE = range(16, 21)
"""Columns of Groups.row that change: branch, whether it may change within a step, squared sine of its angle; the
squared sine below which the pose is unclear, a number of the run; the rate of the squared sine (1/s)."""
THETA, BEND, TURNS = 0, 1, 2
"""Columns of EmbeddingScratch.base: angle, convective acceleration, then the rates of turning."""
VALUE, SPEED, BASE = 0, 1, 2
"""Columns of EmbeddingScratch.coordinate."""
