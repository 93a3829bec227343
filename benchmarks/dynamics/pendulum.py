"""A01, the simple pendulum of the IFToMM benchmark library: 1 kg on a massless rod of 1 m.

It starts from rest in the horizontal.

Error: largest drift of the energy over 10 s (J); the library accepts 5e-5 J. Energy 0 is that of the start.
"""

from __future__ import annotations

from benchmarks.dynamics.pins import GROUND, Pin, Pinned, Record, Solid, energy_drift

NAME = "A01 pendulum"
LENGTH = 1.0
MASS = 1.0
GRAVITY = 9.81
DURATION = 10.0
LIMITS = {"energy drift (J)": 5e-5}
BAR = 5.0
"""How many times our time the best peer takes at least."""


def model() -> Pinned:
    """The point mass is a body without inertia; its frame's x axis points from the pivot to the mass."""
    mass = Solid(MASS, 0.0, (-LENGTH, 0.0, 3.141592653589793))
    return Pinned((mass,), (Pin(GROUND, (0.0, 0.0), 0, (-LENGTH, 0.0)),), GRAVITY)


def errors(record: Record) -> dict[str, float]:
    """By the names of LIMITS."""
    return {"energy drift (J)": energy_drift(model(), record)}
