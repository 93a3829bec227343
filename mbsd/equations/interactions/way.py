"""Distance or relative angle of two markers, with its rate and the direction in which it grows."""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal
from mbsd.equations.interactions.law import OMEGA, VX, VY, A, X, Y


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
