"""Positions alone, over many designs: numbers change from one to the next, the plan and the drivers' angles stay.

The formulas are those of solve.py without rates, in kinds/. Directions are kept as cosine and sine, so nothing but a
square root or two is left for a step; the angles of drivers are tabulated once for all designs. What is drawn as a root
(the height of C over PQ, or the way along a slide) must go on smoothly from its last two values; where its other sign
is as near, the design is given up as doubted.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import threaded
from mbsd.kinematics.groups.carrying.places import point_of
from mbsd.kinematics.groups.carrying.rates import DOUBTED, SOLVED, WOUND
from mbsd.kinematics.groups.groups import DRIVEN, PRP, ROD, RPR, RRP, RRR, SLIDE, WELDED
from mbsd.kinematics.groups.kinds.driven import place_driven
from mbsd.kinematics.groups.kinds.prp import place_prp
from mbsd.kinematics.groups.kinds.rod import place_rod
from mbsd.kinematics.groups.kinds.rpr import place_rpr
from mbsd.kinematics.groups.kinds.rrp import place_rrp
from mbsd.kinematics.groups.kinds.rrr import place_rrr
from mbsd.kinematics.groups.kinds.slide import place_slide
from mbsd.kinematics.groups.kinds.welded import place_welded
from mbsd.kinematics.groups.kinds.yoke import place_yoke

NEAR = 0.25
"""Part of the angle to the other branch by which the extrapolated motion may be missed."""


@threaded
def place_designs(
    groups, numbers, start, driven, every, fixed, place, point, roots, last, body, arm, turned, out, angle, status
):
    """Fill out (n, points, T, 2), angle (n, bodies, T) and status (n,) of n designs with numbers (n, g, 14).

    Poses are solved equally far apart in time; every ``every``th is kept.
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
                bodies = groups.body[e]
                n = numbers[design, e]
                if kind == DRIVEN:
                    place_driven(bodies, n, driven[k, e], place, p)
                    continue
                if kind == WELDED:
                    place_welded(bodies, n, fixed[e, 0], place, p)
                    continue
                if kind == SLIDE:
                    place_slide(bodies, n, driven[k, e], fixed[e, 0], place, p)
                    continue
                if kind == PRP:
                    root = place_prp(bodies, n, fixed[e, 0], fixed[e, 1], place, p, r)
                    if root == 0.0 or (k > 0 and roots[e, 0] * root < 0.0):
                        state = DOUBTED
                        break
                    roots[e, 0] = root
                    continue
                if kind == RRR:
                    root = place_rrr(bodies, n, place, p, r)
                elif kind == ROD:
                    root = place_rod(bodies, n, driven[k, e], place, p, r)
                elif kind == RRP:
                    root = place_rrp(bodies, n, fixed[e, 1], place, p, r)
                elif kind == RPR:
                    root = place_rpr(bodies, n, fixed[e, 1], place, p, r)
                else:
                    place_yoke(bodies, n, fixed[e, 0], place, p, r)
                    continue
                if root < 0.0:
                    state = int(-root)
                    break
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
                point_of(place, body[i], arm[design, i, 0], arm[design, i, 1], out[design, i, k // every])
            for i in range(turned.shape[0]):
                angle[design, i, k // every] = last[i]
