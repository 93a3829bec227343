"""Where a point stands to a surface in the axes of marker i: the line y = 0, or a profile of pieces.

Matter is below the line, and on the right of a profile as its parameter rises. Numbers from OWN on are those of
curve_pieces.py; with 0 pieces the surface is the line. The law's own numbers come after them, from :func:`after`.

    d  signed distance of the point,  t unit tangent at the foot,  n = t_perp outwards
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, kernel
from mbsd.equations.relative.curve_pieces import COUNT, CX, CY, DX, DY, LATER, TABLE, WIDTH, find_foot
from mbsd.equations.relative.equation import X, Y

DISTANCE, TX, TY = 20, 21, 22
"""Places in the state, filled by :func:`stand`."""


@internal
def after(numbers):
    """Where the law's own numbers begin."""
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
    """Distance and tangent out (T, 3) of points x, y (T,), for callers outside the compiled loops."""
    for k in range(x.shape[0]):
        state[X] = x[k]
        state[Y] = y[k]
        stand(numbers, state)
        out[k, 0] = state[DISTANCE]
        out[k, 1] = state[TX]
        out[k, 2] = state[TY]
