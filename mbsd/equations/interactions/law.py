"""Arguments of an interaction's function, which is compiled only when a model uses it.

    void force(const double *numbers, const double *state, double *out)

``state`` holds the pose of marker j in the axes of marker i, its rate as seen there, the time and a law of time;
``out`` takes the force on body j at the point of marker j, in the axes of marker i, and the torque on body j. Body i
feels the opposite at the same point of space, so power and reaction follow for all kinds at once.

``numbers`` begin at OWN, as those of constraints, and places 4 to 13 of the state are scratch of curve_pieces.py.
Those whose force has a kink or a jump set SWITCHES and tell where, see switching.py.
"""

from __future__ import annotations

import importlib

from mbsd.base.codes import MOST_STATES
from mbsd.compiling.jit import COMPILED
from mbsd.equations.relative.equation import _PYTHON, OWN, A, X, Y, equation

VX, VY, OMEGA, TIME, LAW, LAW_RATE = 14, 15, 16, 17, 18, 19
"""Places in ``state`` after X, Y, A: rates (m/s, m/s, rad/s), time (s), value and rate of the law of time, else 0."""
SIDE = 23
"""Place in ``state``: 1 or -1 for the force of that side of its switch, smoothly beyond it, too; else 0."""
APPROACH = 24
"""Place in ``state``: SPEED where SWITCH last went above 0 (m/s), not a number before it ever did: see switching.py."""
CRANK, CRANK_RATE = 25, 26
"""Places in ``state``: angle and rate of the interaction's crank against body i (rad, rad/s)."""
OWN_STATE = 27
"""The first of the states that the force itself carries, as speeds (mbsd/arrays/states.py)."""
STATE = OWN_STATE + MOST_STATES
"""Numbers of a state."""
FX, FY, TORQUE, SWITCH, POWER, SPEED, RATE = 0, 1, 2, 3, 4, 5, 6
"""Places in ``out``. SWITCH: what changes its sign where the force has a kink or a jump (m), above 0 where it acts.
POWER: by which power of that it grows, if that is no whole number. SPEED: rate of SWITCH, of forces that ask for
APPROACH (m/s). RATE: the first of the rates of its own states."""
RESULTS = RATE + MOST_STATES
"""Numbers of ``out``."""

__all__ = [
    "APPROACH", "CRANK", "CRANK_RATE", "FX", "FY", "LAW", "LAW_RATE", "OMEGA", "OWN", "OWN_STATE",
    "POWER", "RATE", "RESULTS", "SIDE", "SPEED", "STATE", "SWITCH", "TIME", "TORQUE", "VX", "VY", "A", "X", "Y",
]  # fmt: skip

interaction = equation
"""Decorator: a force at an address."""


def switches(name: str) -> bool:
    """Return True if the force of this file has kinks or jumps that it tells."""
    return getattr(importlib.import_module(f"mbsd.equations.interactions.{name}"), "SWITCHES", False)


def address_of(name: str) -> int:
    """Where the force of this file of mbsd/equations/interactions is; compiles it at first."""
    made = importlib.import_module(f"mbsd.equations.interactions.{name}").force
    return made.address if COMPILED else _PYTHON.index(made)
