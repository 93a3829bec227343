"""Positions alone, over many designs: numbers change from one to the next, the plan and the drivers' angles stay.

The formulas are those of solve.py and slides.py without rates. Directions are kept as cosine and sine, so nothing but a
square root or two is left for a step; the angles of drivers are tabulated once for all designs. What is drawn as a root
(the height of C over PQ, or the way along a slide) must go on smoothly from its last two values; where its other sign
is as near, the design is given up as doubted.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined, threaded
from mbsd.kinematics.groups.groups import DRIVEN, PRP, ROD, RPR, RRP, RRR, SLIDE, WELDED
from mbsd.kinematics.groups.points import DOUBTED, OPEN, SOLVED, WOUND

NEAR = 0.25
"""Part of the angle to the other branch by which the extrapolated motion may be missed."""
FLAT = 1e-10
"""Discriminant over squared lengths at which branches meet."""
PARALLEL = 1e-3
"""Sine of the angle between two slides below which their crossing is in doubt."""


@inlined
def _turned(place, b, x, y, out):
    """World place of the point with arm (x, y) of body b; place (nb, 4): x, y, cosine, sine."""
    out[0] = place[b, 0] + place[b, 2] * x - place[b, 3] * y
    out[1] = place[b, 1] + place[b, 3] * x + place[b, 2] * y


@inlined
def _hang(place, b, px, py, x, y):
    """Place body b, whose direction is known, so that its point with arm (x, y) is (px, py)."""
    place[b, 0] = px - place[b, 2] * x + place[b, 3] * y
    place[b, 1] = py - place[b, 3] * x - place[b, 2] * y


@inlined
def _aim(place, b, x, y, lx, ly):
    """Turn body b so that its direction (lx, ly) points along (x, y)."""
    scale = 1.0 / math.sqrt((x * x + y * y) * (lx * lx + ly * ly))
    place[b, 2] = (x * lx + y * ly) * scale
    place[b, 3] = (y * lx - x * ly) * scale


@inlined
def _follow(place, b, leader, turn):
    """Turn body b as its leader, further by the angle of cosine and sine ``turn`` (2,)."""
    place[b, 2] = place[leader, 2] * turn[0] - place[leader, 3] * turn[1]
    place[b, 3] = place[leader, 3] * turn[0] + place[leader, 2] * turn[1]


@threaded
def place_designs(
    groups, numbers, start, driven, every, fixed, place, point, roots, last, body, arm, turned, out, angle, status
):
    """Fill out (n, points, T, 2), angle (n, bodies, T) and status (n,) of n designs with numbers (n, g, 14).

    Of the poses solved, equally far apart in time, every ``every``th is kept.
    driven (every (T - 1) + 1, g, 2) cosine and sine of DRIVEN groups' angles, values of the other laws; fixed (g, 2, 2)
    cosine and sine of the constant angles of A and B of the other groups.
    Points: body (points,) and arm (n, points, 2) from centres of mass; turned (bodies,) whose angles are wanted, going
    on from start (3 nb,). Scratch: place (nb, 4) with (0, 0, 1, 0) for ground, point (2, 2), roots (g, 2), last
    (bodies,).
    """
    p = point[0]
    r = point[1]
    for design in range(numbers.shape[0]):
        status[design] = SOLVED
        for i in range(turned.shape[0]):
            last[i] = start[3 * turned[i] + 2]
        for k in range(driven.shape[0]):
            state = SOLVED
            for e in range(groups.kind.shape[0]):
                kind = groups.kind[e]
                a = groups.body[e, 0]
                b = groups.body[e, 1]
                k1 = groups.body[e, 2]
                k2 = groups.body[e, 3]
                n = numbers[design, e]
                root = 1.0
                _turned(place, k1, n[0], n[1], p)
                if kind == DRIVEN:
                    _follow(place, a, k2, driven[k, e])
                    _hang(place, a, p[0], p[1], n[2], n[3])
                    continue
                if kind == WELDED:
                    _follow(place, a, k1, fixed[e, 0])
                    _hang(place, a, p[0], p[1], n[2], n[3])
                    continue
                if kind == SLIDE:
                    way = driven[k, e, 0]
                    _turned(place, k1, n[0] + way * n[2], n[1] + way * n[3], p)
                    _follow(place, a, k1, fixed[e, 0])
                    _hang(place, a, p[0], p[1], n[5], n[6])
                    continue
                if kind == PRP:
                    _turned(place, k2, n[7], n[8], r)
                    ex = place[k1, 2] * n[2] - place[k1, 3] * n[3]
                    ey = place[k1, 3] * n[2] + place[k1, 2] * n[3]
                    ux = place[k2, 2] * n[9] - place[k2, 3] * n[10]
                    uy = place[k2, 3] * n[9] + place[k2, 2] * n[10]
                    root = ux * ey - uy * ex
                    if not abs(root) > PARALLEL:
                        state = DOUBTED
                        break
                    if k > 0 and roots[e, 0] * root < 0.0:
                        state = DOUBTED
                        break
                    roots[e, 0] = root
                    slide = (ux * (r[1] - p[1]) - uy * (r[0] - p[0])) / root
                    _follow(place, a, k1, fixed[e, 0])
                    _hang(place, a, p[0] + slide * ex, p[1] + slide * ey, n[5], n[6])
                    if b >= 0:
                        _follow(place, b, k2, fixed[e, 1])
                        _hang(place, b, p[0] + slide * ex, p[1] + slide * ey, n[12], n[13])
                    continue
                if kind in (RRR, ROD):
                    _turned(place, k2, n[6], n[7], r)
                    lx = n[4] - n[2]
                    ly = n[5] - n[3]
                    mx = n[10] - n[8]
                    my = n[11] - n[9]
                    second = mx * mx + my * my
                    branch = n[12]
                    if kind == ROD:
                        second = (n[8] + driven[k, e, 0]) ** 2
                        branch = n[9]
                    first = lx * lx + ly * ly
                    dx = r[0] - p[0]
                    dy = r[1] - p[1]
                    square = dx * dx + dy * dy
                    inverse = 1.0 / square
                    along = 0.5 * (square + first - second) * inverse
                    left = first * inverse - along * along
                    state = OPEN if left < -FLAT else (SOLVED if left > FLAT else DOUBTED)
                    if state != SOLVED:
                        break
                    root = math.sqrt(left)
                    height = branch * root
                    ux = along * dx - height * dy
                    uy = along * dy + height * dx
                    _aim(place, a, ux, uy, lx, ly)
                    _hang(place, a, p[0], p[1], n[2], n[3])
                    if b >= 0:
                        _aim(place, b, ux - dx, uy - dy, mx, my)
                        _hang(place, b, r[0], r[1], n[8], n[9])
                elif kind == RRP:
                    _turned(place, k2, n[6], n[7], r)
                    lx = n[4] - n[2]
                    ly = n[5] - n[3]
                    square = lx * lx + ly * ly
                    ex = place[k2, 2] * n[8] - place[k2, 3] * n[9]
                    ey = place[k2, 3] * n[8] + place[k2, 2] * n[9]
                    dx = r[0] - p[0]
                    dy = r[1] - p[1]
                    across = dx * ey - dy * ex
                    left = 1.0 - across * across / square
                    state = OPEN if left < -FLAT else (SOLVED if left > FLAT else DOUBTED)
                    if state != SOLVED:
                        break
                    root = math.sqrt(left)
                    slide = n[13] * math.sqrt(square) * root - (dx * ex + dy * ey)
                    ux = dx + slide * ex
                    uy = dy + slide * ey
                    _aim(place, a, ux, uy, lx, ly)
                    _hang(place, a, p[0], p[1], n[2], n[3])
                    if b >= 0:
                        _follow(place, b, k2, fixed[e, 1])
                        _hang(place, b, p[0] + ux, p[1] + uy, n[11], n[12])
                elif kind == RPR:
                    _turned(place, k2, n[7], n[8], r)
                    dx = r[0] - p[0]
                    dy = r[1] - p[1]
                    square = dx * dx + dy * dy
                    left = 1.0 - n[6] * n[6] / square
                    state = OPEN if left < -FLAT else (SOLVED if left > FLAT else DOUBTED)
                    if state != SOLVED:
                        break
                    root = math.sqrt(left)
                    way = n[12] * root * math.sqrt(square)
                    _aim(place, a, dx, dy, way * n[4] - n[6] * n[5], way * n[5] + n[6] * n[4])
                    _hang(place, a, p[0], p[1], n[2], n[3])
                    if b >= 0:
                        _follow(place, b, a, fixed[e, 1])
                        _hang(place, b, r[0], r[1], n[10], n[11])
                else:
                    _turned(place, k2, n[6], n[7], r)
                    ex = place[k1, 2] * n[2] - place[k1, 3] * n[3]
                    ey = place[k1, 3] * n[2] + place[k1, 2] * n[3]
                    nx = place[k1, 2] * n[4] - place[k1, 3] * n[5]
                    ny = place[k1, 3] * n[4] + place[k1, 2] * n[5]
                    slide = (nx * (r[0] - p[0]) + ny * (r[1] - p[1])) / (nx * ex + ny * ey)
                    _follow(place, a, k1, fixed[e, 0])
                    _hang(place, a, p[0] + slide * ex, p[1] + slide * ey, n[9], n[10])
                    continue
                if k > 1 and not abs(root - (2.0 * roots[e, 0] - roots[e, 1])) < 2.0 * NEAR * root:
                    state = DOUBTED
                    break
                roots[e, 1] = roots[e, 0]
                roots[e, 0] = root
            if state != SOLVED:
                status[design] = state
                break
            for i in range(turned.shape[0]):
                now = math.atan2(place[turned[i], 3], place[turned[i], 2])
                now += 2.0 * math.pi * math.floor((last[i] - now) / (2.0 * math.pi) + 0.5)
                if k > 0 and not abs(now - last[i]) <= WOUND:
                    status[design] = DOUBTED
                last[i] = now
            if status[design] != SOLVED:
                break
            if k % every != 0:
                continue
            for i in range(body.shape[0]):
                _turned(place, body[i], arm[design, i, 0], arm[design, i, 1], out[design, i, k // every])
            for i in range(turned.shape[0]):
                angle[design, i, k // every] = last[i]
