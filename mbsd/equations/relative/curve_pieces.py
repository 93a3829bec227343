"""A plane curve as quintic pieces of a parameter, and the point of it that is nearest to a given one.

Numbers, from ``OWN`` on: offset D (m), radius r (m), 1 if closed, span of the parameter, count of pieces, how far the
foot may go at once (0: as far as it likes); then of each piece, 15: begin u, six coefficients of x(u) and of y(u),
lowest first, arc length and tangent angle at its begin; at last arc length and turning of all of it, place and
derivative at its end, and how far a place is from its nearest node at most, 0 where the nearest node is known to lead
to the foot. Beyond its ends an open curve goes on straight.

The foot of a point p: (p - c(u)) . c'(u) = 0, by Newton from the nearest of the nodes; where the curve is bent about
the point the second derivative is left out (Gauss-Newton), which always leads downhill. Where parts of the curve pass
so close by each other that a node of another part may be nearer, or turn sharply between two nodes, each node that can
lead to a nearer foot is tried. Beyond the ends the straight lines are compared with the nearest of the pieces.

On a curve that crosses itself or its straight continuations the nearest foot may be on the other branch. There all
feet are found, and the one is taken that is least off, |d - D| + |u - u_last| / 4, from the parameter last accepted
(mbsd/arrays/curve_branches.py): the point goes on along the branch it is on. A step that takes the foot farther than
it may go at once is divided.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, kernel
from mbsd.equations.relative.equation import OWN, X, Y
from mbsd.equations.system import LAST

DISTANCE, RADIUS, CLOSED, SPAN, COUNT, FARTHEST, TABLE = range(OWN, OWN + 7)
WIDTH = 15
ARC, TANGENT = 13, 14
"""Columns of a piece."""
LENGTH, TURNING, END_X, END_Y, END_DX, END_DY, REACH = range(7)
"""After the last piece."""
LATER = 7
"""Numbers after the last piece."""
U, PIECE, CX, CY, DX, DY, DDX, DDY, DDDX, DDDY = range(4, 14)
"""Places in the scratch after the relative pose: parameter, piece, and place and derivatives by u there."""
LOOKS = 48
"""Nodes looked at before the ones between the best two."""
MOST_STEPS = 40
NEARER, CLOSE = 0.999999, 1e-9
"""Part of a square, and of REACH, by which another foot is nearer by more than rounding."""
AWAY = 0.25
"""Weight of one metre along the curve against one metre off it."""


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
    """Return the piece that holds u; the first or last beyond the ends."""
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
    if numbers[FARTHEST] > 0.0 and relative[LAST] == relative[LAST]:
        _find_following_foot(numbers, relative, x, y, count)
        return
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
    u = numbers[TABLE + WIDTH * best]
    if numbers[CLOSED] == 0.0:  # the end of the last piece is no node
        square = _square_to_end(numbers, x, y)
        if square < least:
            least = square
            u = numbers[TABLE] + numbers[SPAN]
    if numbers[TABLE + WIDTH * count + REACH] > 0.0:
        u, least = _nearest_foot(numbers, relative, x, y, u, count)
    if numbers[CLOSED] == 0.0:
        line, square = _nearest_continuation(numbers, x, y, least)
        if square < least and line != u:
            _go_to_foot(numbers, relative, x, y, u)
            if (relative[CX] - x) ** 2 + (relative[CY] - y) ** 2 <= square:
                return
            u = line
    _go_to_foot(numbers, relative, x, y, u)


@internal
def _square_to_end(numbers, x, y):
    end = TABLE + WIDTH * int(numbers[COUNT])
    dx = numbers[end + END_X] - x
    dy = numbers[end + END_Y] - y
    return dx * dx + dy * dy


@internal
def _nearest_foot(numbers, relative, x, y, u, count):
    """Return the nearest foot that u and all nodes lead to, and its squared distance.

    A place of a piece is at most REACH from one of its ends, so that nodes farther away lead to no nearer one.
    """
    first = u
    _go_to_foot(numbers, relative, x, y, u)
    u = relative[U]
    least = (relative[CX] - x) ** 2 + (relative[CY] - y) ** 2
    reach = numbers[TABLE + WIDTH * count + REACH]
    limit = (math.sqrt(least) + reach) ** 2
    small = (CLOSE * reach) ** 2
    for node in range(count if numbers[CLOSED] != 0.0 else count + 1):
        if node < count:
            square = _square_to(numbers, node, x, y)
        else:
            square = _square_to_end(numbers, x, y)
        begun = numbers[TABLE + WIDTH * node] if node < count else numbers[TABLE] + numbers[SPAN]
        if square < limit and begun != first:
            _go_to_foot(numbers, relative, x, y, begun)
            square = (relative[CX] - x) ** 2 + (relative[CY] - y) ** 2
            if square + small < NEARER * least:
                least = square
                u = relative[U]
                limit = (math.sqrt(least) + reach) ** 2
    return u, least


@internal
def _nearest_continuation(numbers, x, y, least):
    """Return the end beyond which a straight line passes closest, and the squared distance.

    The end is a parameter; only distances below ``least`` count.
    """
    end = TABLE + WIDTH * int(numbers[COUNT])
    u = numbers[TABLE]
    for side in range(2):
        px = x - (numbers[end + END_X] if side else numbers[TABLE + 1])
        py = y - (numbers[end + END_Y] if side else numbers[TABLE + 7])
        dx = numbers[end + END_DX] if side else -numbers[TABLE + 2]
        dy = numbers[end + END_DY] if side else -numbers[TABLE + 8]
        if px * dx + py * dy > 0.0:
            square = (px * dy - py * dx) ** 2 / (dx * dx + dy * dy)
            if square < least:
                least = square
                u = numbers[TABLE] + side * numbers[SPAN]
    return u, least


@internal
def _find_following_foot(numbers, relative, x, y, count):
    closed = numbers[CLOSED] != 0.0
    span = numbers[SPAN]
    last = relative[LAST]
    best = last
    cost = _cost(numbers, relative, x, y, last, closed)
    best = relative[U]
    before = _square_to(numbers, count - 1, x, y) if closed else math.inf
    here = _square_to(numbers, 0, x, y)
    for node in range(count + 1):
        if node < count - 1:
            after = _square_to(numbers, node + 1, x, y)
        elif node == count - 1 and closed:
            after = _square_to(numbers, 0, x, y)
        elif node == count - 1:
            place_on(numbers, node, numbers[TABLE] + span, relative)
            after = (relative[CX] - x) ** 2 + (relative[CY] - y) ** 2
        else:
            if closed:
                break
            after = math.inf
        if here <= before and here <= after:
            u = numbers[TABLE + WIDTH * node] if node < count else numbers[TABLE] + span
            off = _cost(numbers, relative, x, y, u, closed)
            if off < cost:
                cost = off
                best = relative[U]
        before = here
        here = after
    _go_to_foot(numbers, relative, x, y, best)


@internal
def _cost(numbers, relative, x, y, u, closed):
    """Return how much the foot that is found from u is off; leaves the foot in the scratch."""
    _go_to_foot(numbers, relative, x, y, u)
    speed = math.sqrt(relative[DX] * relative[DX] + relative[DY] * relative[DY])
    d = (relative[DX] * (y - relative[CY]) - relative[DY] * (x - relative[CX])) / speed
    away = abs(relative[U] - relative[LAST])
    if closed:
        away = min(away, numbers[SPAN] - away)
    return abs(d - numbers[DISTANCE]) + AWAY * away


@internal
def _go_to_foot(numbers, relative, x, y, u):
    """Find the foot by Newton from u; leave it in the scratch."""
    begin = numbers[TABLE]
    span = numbers[SPAN]
    longest = span / numbers[COUNT]
    piece = 0
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
        open_ended = numbers[CLOSED] == 0.0
        if open_ended and ((u <= begin and slope < 0.0) or (u >= begin + span and slope > 0.0)):
            step = slope / speed  # on the straight line beyond an end, which does not bend, the first step is exact
        elif open_ended and u < begin:
            step = min(slope / speed, begin - u)
        elif open_ended and u > begin + span:
            step = max(slope / speed, begin + span - u)
        else:  # the foot is within a piece of the nearest node
            step = slope / (bend if bend > 1e-6 * speed else speed)
            step = min(max(step, -longest), longest)
        u += step
        if abs(step) <= 1e-15 * span:
            break
    relative[U] = u
    relative[PIECE] = piece


@kernel
def foot(numbers, x, y, scratch):
    """Return the parameter of the foot of (x, y), for callers in Python; scratch (16,) with LAST."""
    scratch[X] = x
    scratch[Y] = y
    find_foot(numbers, scratch)
    return scratch[U]
