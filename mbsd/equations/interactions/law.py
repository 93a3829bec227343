"""Arguments of interactions' functions, which are compiled when a model uses them; shared laws.

    void force(const double *numbers, const double *state, double *out)

``state`` holds the pose of marker j in the axes of marker i, its rate as seen there, the time and a law of time;
``out`` takes the force on body j at the point of marker j, in the axes of marker i, and the torque on body j. Body i
feels the opposite at the same point of space, so power and reaction follow for all kinds at once.

``numbers`` begin at OWN, as those of constraints, and places 4 to 13 of the state are scratch of curve_pieces.py.
Forces with a kink or a jump set SWITCHES and tell where, see switching.py.

Shared by several laws: the distance or relative angle of the markers (:func:`measure`), the place of a point at a
surface (:func:`stand`), and the normal force N between two that touch:

    surface   the line y = 0, or a profile of pieces; matter is below the line, on the right as the parameter rises
              d signed distance of the point,  t unit tangent at the foot,  n = t_perp outwards
    normal    N = k depth^e max(1 + D rate, 0),   D as given, or loss / approach, the speed with which it began

Numbers of a profile are those of curve_pieces.py from OWN on; with 0 pieces the surface is the line. The law's own
numbers come after them, from :func:`after`.
"""

from __future__ import annotations

import importlib
import math

from mbsd.base.codes import MOST_STATES
from mbsd.compiling.jit import COMPILED, inlined, internal, kernel
from mbsd.equations.relative.curve_pieces import COUNT, CX, CY, DX, DY, LATER, TABLE, WIDTH, find_foot
from mbsd.equations.relative.equation import _PYTHON, OWN, A, X, Y, equation

VX, VY, OMEGA, TIME, LAW, LAW_RATE = 14, 15, 16, 17, 18, 19
"""Places in ``state`` after X, Y, A: rates (m/s, m/s, rad/s), time (s), value and rate of the law of time, else 0."""
SIDE = 23
"""Place in ``state``: 1 or -1 for the force of that side of its switch, smoothly beyond it, too; else 0."""
APPROACH = 24
"""Place in ``state``: SPEED where SWITCH last went above 0 (m/s), not a number before it ever did: see switching.py."""
CRANK, CRANK_RATE = 25, 26
"""Places in ``state``: angle and rate of the interaction's crank against body i (rad, rad/s)."""
BODY_X, BODY_Y = 27, 28
"""Places in ``state``: centre of mass of that body in the axes of marker i (m)."""
OWN_STATE = 29
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
    "APPROACH", "BODY_X", "BODY_Y", "CRANK", "CRANK_RATE", "FX", "FY", "LAW", "LAW_RATE", "OMEGA", "OWN", "OWN_STATE",
    "POWER", "RATE", "RESULTS", "SIDE", "SPEED", "STATE", "SWITCH", "TIME", "TORQUE", "VX", "VY", "A", "X", "Y",
]  # fmt: skip

interaction = equation
"""Decorator: a force at an address."""


def switches(name: str) -> bool:
    """Return True if the force of this file has kinks or jumps that it tells."""
    return getattr(importlib.import_module(f"mbsd.equations.interactions.{name}"), "SWITCHES", False)


def address_of(name: str) -> int:
    """Return where the force of this file of mbsd/equations/interactions is; compiles it at first."""
    made = importlib.import_module(f"mbsd.equations.interactions.{name}").force
    return made.address if COMPILED else _PYTHON.index(made)


@internal
def measure(turning, state):
    """Return value, rate and unit vector in marker i's axes.

    The vector is zero for an angle and at zero distance.
    """
    if turning:
        return state[A], state[OMEGA], 0.0, 0.0
    length = math.sqrt(state[X] * state[X] + state[Y] * state[Y])
    if length == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    ux = state[X] / length
    uy = state[Y] / length
    return length, ux * state[VX] + uy * state[VY], ux, uy


DISTANCE, TX, TY = 20, 21, 22
"""Places in the state, filled by :func:`stand`."""


@internal
def after(numbers):
    """Return where the law's own numbers begin."""
    return TABLE + WIDTH * int(numbers[COUNT]) + LATER


@internal
def stand(numbers, state):
    """Fill distance and tangent."""
    if numbers[COUNT] == 0.0:
        state[DISTANCE] = state[Y]
        state[TX] = 1.0
        state[TY] = 0.0
        return
    find_foot(numbers, state)
    speed = math.sqrt(state[DX] * state[DX] + state[DY] * state[DY])
    tx = state[DX] / speed
    ty = state[DY] / speed
    state[DISTANCE] = tx * (state[Y] - state[CY]) - ty * (state[X] - state[CX])
    state[TX] = tx
    state[TY] = ty


@kernel
def tabulate_stand(numbers, x, y, state, out):
    """Fill out (T, 3) with distance and tangent of points x, y (T,), for callers in Python."""
    for k in range(x.shape[0]):
        state[X] = x[k]
        state[Y] = y[k]
        stand(numbers, state)
        out[k, 0] = state[DISTANCE]
        out[k, 1] = state[TX]
        out[k, 2] = state[TY]


@inlined
def note(out, depth, rate, exponent):
    """Tell those who watch where contacts begin (switching.py) what this one does."""
    out[SWITCH] = depth
    out[SPEED] = rate
    out[POWER] = exponent if exponent != math.floor(exponent) else 0.0


@inlined
def touches(state, depth):
    """Return True if the two touch: as the step holds it, else by depth."""
    return state[SIDE] > 0.0 or (state[SIDE] == 0.0 and depth > 0.0)


@inlined
def normal_force(state, depth, rate, stiffness, exponent, damping, loss, least_approach):
    """Return n; ``loss`` above 0 takes the place of ``damping``."""
    approach = state[APPROACH]
    if loss > 0.0 and approach == approach:  # no number: the motion began with the two pressed into each other
        damping = loss / max(approach, least_approach)
    normal = depth
    if exponent != 1.0:
        normal = math.copysign(abs(depth) ** exponent, depth)
    return normal * stiffness * max(1.0 + damping * rate, 0.0)


@inlined
def end_stop(state, out, by, rate, stroke, stiffness, damping):
    """Return the force (N) of stops at 0 and ``stroke`` against a travel ``by`` (m).

    The depth goes into SWITCH.
    """
    way = 1.0
    depth = by - stroke
    if -by > depth:
        way = -1.0
        depth = -by
    out[SWITCH] = depth
    if touches(state, depth):
        return way * stiffness * depth * max(1.0 + way * damping * rate, 0.0)
    return 0.0


@inlined
def act_along(out, turning, size, ux, uy):
    """Fill out with a force (N) along a unit vector, or a torque (N m) if it is ``turning``.

    See measure.
    """
    out[FX] = ux * size
    out[FY] = uy * size
    out[TORQUE] = size if turning else 0.0
