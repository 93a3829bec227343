"""A plane curve as quintic pieces of a parameter, and the point of it that is nearest to a given one.

Numbers, from ``OWN`` on: offset D (m), radius r (m), 1 if closed, span of the parameter, count of pieces; then of each
piece, 15: begin u, six coefficients of x(u) and of y(u), lowest first, arc length and tangent angle at its begin.
Beyond its ends an open curve goes on straight.

The foot of a point p: (p - c(u)) . c'(u) = 0, by Newton from the nearest of the nodes; where the curve is bent about
the point the second derivative is left out (Gauss-Newton), which always leads downhill.
"""

from __future__ import annotations

import math

from mbsd.constraints.equation import OWN, X, Y
from mbsd.jit import internal

DISTANCE, RADIUS, CLOSED, SPAN, COUNT, TABLE = OWN, OWN + 1, OWN + 2, OWN + 3, OWN + 4, OWN + 5
WIDTH = 15
ARC, TANGENT = 13, 14
"""Of a piece."""
U, PIECE, CX, CY, DX, DY, DDX, DDY, DDDX, DDDY = range(4, 14)
"""Of the scratch after the relative pose: parameter, piece, and place and derivatives by u there."""
LOOKS = 48
"""Nodes looked at before the ones between the best two."""
MOST_STEPS = 40


@internal
def place_on(numbers, piece, u, scratch):
    """Place and three derivatives by u, on the piece or straight on beyond an end of an open curve."""
    row = TABLE + WIDTH * piece
    s = u - numbers[row]
    beyond = 0.0
    if numbers[CLOSED] == 0.0:
        longest = numbers[TABLE] + numbers[SPAN] - numbers[row]
        if piece == 0 and s < 0.0:
            beyond = s
            s = 0.0
        elif s > longest:
            beyond = s - longest
            s = longest
    for axis in range(2):
        value = 0.0
        first = 0.0
        second = 0.0
        third = 0.0
        for k in range(6):
            third = third * s + 3.0 * second
            second = second * s + 2.0 * first
            first = first * s + value
            value = value * s + numbers[row + 1 + 6 * axis + 5 - k]
        if beyond != 0.0:
            value += first * beyond
            second = 0.0
            third = 0.0
        scratch[CX + axis] = value
        scratch[DX + axis] = first
        scratch[DDX + axis] = second
        scratch[DDDX + axis] = third


@internal
def _square_to(numbers, node, x, y):
    row = TABLE + WIDTH * node
    dx = numbers[row + 1] - x
    dy = numbers[row + 7] - y
    return dx * dx + dy * dy


@internal
def _piece_at(numbers, u):
    """The piece that holds u; the first or last beyond the ends."""
    low = 0
    high = int(numbers[COUNT])
    while high - low > 1:
        middle = (low + high) // 2
        if numbers[TABLE + WIDTH * middle] <= u:
            low = middle
        else:
            high = middle
    return low


@internal
def find_foot(numbers, relative):
    """Leave in the scratch after ``relative`` the parameter of the foot of (x, y), and the curve there."""
    x = relative[X]
    y = relative[Y]
    count = int(numbers[COUNT])
    stride = max(count // LOOKS, 1)
    best = 0
    least = math.inf
    for node in range(0, count, stride):
        square = _square_to(numbers, node, x, y)
        if square < least:
            least = square
            best = node
    for node in range(max(best - stride + 1, 0), min(best + stride, count)):
        square = _square_to(numbers, node, x, y)
        if square < least:
            least = square
            best = node
    begin = numbers[TABLE]
    span = numbers[SPAN]
    u = numbers[TABLE + WIDTH * best]
    if best == count - 1 and numbers[CLOSED] == 0.0:  # the end of the last piece is no node
        place_on(numbers, best, begin + span, relative)
        if (relative[CX] - x) ** 2 + (relative[CY] - y) ** 2 < least:
            u = begin + span
    longest = span / count
    for _ in range(MOST_STEPS):
        if numbers[CLOSED] != 0.0:
            u -= span * math.floor((u - begin) / span)
        piece = _piece_at(numbers, u)
        place_on(numbers, piece, u, relative)
        px = x - relative[CX]
        py = y - relative[CY]
        speed = relative[DX] * relative[DX] + relative[DY] * relative[DY]
        slope = px * relative[DX] + py * relative[DY]
        bend = speed - px * relative[DDX] - py * relative[DDY]
        step = slope / (bend if bend > 1e-6 * speed else speed)
        off = numbers[CLOSED] == 0.0 and ((u <= begin and step < 0.0) or (u >= begin + span and step > 0.0))
        if not off:  # the foot is within a piece of the nearest node, or on the straight line beyond an end
            step = min(max(step, -longest), longest)
        u += step
        if abs(step) <= 1e-15 * span:
            break
    relative[U] = u
    relative[PIECE] = piece
