"""Columns of the arrays of independent coordinates that closed forms use (mbsd/dynamics/embedding/arrays.py)."""

from __future__ import annotations

X, Y, COS, SIN, OMEGA, MASS, INERTIA = range(7)
"""Columns of EmbeddingScratch.body: place of the centre of mass, turn, rate of turning; kg, kg m^2."""
NUMBERS = 20
SIGN, NEAR, SINE, AVOID = 16, 17, 18, 19
"""Columns of Embedding.number that change: branch, whether it may change within a step, squared sine of its angle;
and the squared sine below which the pose is unclear, a number of the run."""
THETA, BEND, TURNS = 0, 1, 2
"""Columns of EmbeddingScratch.base: angle, convective acceleration, then the rates of turning."""
VALUE, SPEED, BASE = 0, 1, 2
"""Columns of EmbeddingScratch.coordinate."""
