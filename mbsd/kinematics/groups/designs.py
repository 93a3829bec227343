"""Positions alone, over many designs: numbers change, the plan and the drivers' angles stay.

The formulas are those of all groups, without rates (cases.py). Directions are kept as cosine and sine, so
nothing but a square root or two is left for a step; the angles of drivers are tabulated once for all designs. The sine
of each group must go on smoothly from its last two values; where its other sign is as near, the design is given up as
doubted.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.compiling.jit import threaded
from mbsd.kinematics.groups.carried import COS, DOUBTED, SIN, SINE, SOLVED, WOUND, X, Y
from mbsd.kinematics.groups.cases import PoseAlone
from mbsd.kinematics.groups.solve import solve_group

NEAR = 0.25
"""Part of the angle to the other branch by which the extrapolated motion may be missed."""


class Wanted(NamedTuple):
    """Points and angles that are wanted of n designs."""

    body: Any
    """(points,) of each point."""
    arm: Any
    """(n, points, 2) from the centre of mass."""
    turned: Any
    """(bodies,) whose angles are wanted."""


class Placed(NamedTuple):
    """Results of n designs."""

    out: Any
    """(n, points, T, 2)"""
    angle: Any
    """(n, bodies, T)"""
    status: Any
    """(n,)"""


class Scratch(NamedTuple):
    """Scratch of one thread."""

    place: Any
    """(nb, 7), with cosine 1 for ground."""
    rate: Any
    """(1, 1)"""
    roots: Any
    """(g, 2)"""
    last: Any
    """(bodies,)"""


@threaded
def place_designs(group, row, start, driven, every, wanted, placed, scratch):
    """Fill ``placed`` with the ``wanted`` of n designs with rows (n, g, 21) of Groups.row.

    Poses are solved equally far apart in time; every ``every``th is kept. Angles go on from start (3 nb,).
    driven (every (T - 1) + 1, g, 2) cosine and sine of DRIVEN groups' angles, values of the other laws.
    """
    body = wanted.body
    arm = wanted.arm
    turned = wanted.turned
    out = placed.out
    angle = placed.angle
    status = placed.status
    place = scratch.place
    roots = scratch.roots
    last = scratch.last
    for design in range(row.shape[0]):
        status[design] = SOLVED
        for i in range(turned.shape[0]):
            last[i] = start[3 * turned[i] + 2]
        for k in range(driven.shape[0]):
            state = SOLVED
            case = PoseAlone(group, row[design], place, scratch.rate, driven[k])
            for e in range(group.shape[0]):
                state = solve_group(case, e)
                if state != SOLVED:
                    break
                root = math.sqrt(row[design, e, SINE])
                if k > 1 and not abs(root - (2.0 * roots[e, 0] - roots[e, 1])) < 2.0 * NEAR * root:
                    state = DOUBTED
                    break
                roots[e, 1] = roots[e, 0]
                roots[e, 0] = root
            if state != SOLVED:
                status[design] = state
                break
            for i in range(turned.shape[0]):
                now = math.atan2(place[turned[i], SIN], place[turned[i], COS])
                now += 2.0 * math.pi * math.floor((last[i] - now) / (2.0 * math.pi) + 0.5)
                if k > 0 and not abs(now - last[i]) <= WOUND:
                    status[design] = DOUBTED
                last[i] = now
            if status[design] != SOLVED:
                break
            if k % every != 0:
                continue
            for i in range(body.shape[0]):
                c = place[body[i], COS]
                s = place[body[i], SIN]
                out[design, i, k // every, 0] = place[body[i], X] + c * arm[design, i, 0] - s * arm[design, i, 1]
                out[design, i, k // every, 1] = place[body[i], Y] + s * arm[design, i, 0] + c * arm[design, i, 1]
            for i in range(turned.shape[0]):
                angle[design, i, k // every] = last[i]
