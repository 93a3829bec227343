"""Positions, rates for each column, and convective accelerations of all groups, one after the other.

Each kind's equations stand in its file in mbsd/kinematics/groups/kinds/. The rates are solved for each column of B, and
once more for the convective accelerations, whose right-hand sides have the terms in omega^2 besides.
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined
from mbsd.dynamics.independent.block import embed_block
from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.carrying.cases import PerCoordinate
from mbsd.kinematics.groups.carrying.columns import INERTIA, MASS
from mbsd.kinematics.groups.carrying.rates import SOLVED
from mbsd.kinematics.groups.groups import FIRST, KIND, LAW, SECOND
from mbsd.kinematics.groups.kinds.train import embed_train
from mbsd.kinematics.groups.solve_group import solve_group


@inlined
def with_body(body, rate, gravity, i, total, push):
    """The sums c . M c and c . M (g - b) with those of body i: its rate is c, its convective acceleration b."""
    mass = body[i, MASS]
    inertia = body[i, INERTIA]
    cx = rate[i, 0]
    cy = rate[i, 1]
    omega = rate[i, 2]
    total += mass * (cx * cx + cy * cy) + inertia * omega * omega
    push += mass * (cx * (gravity[0] - rate[i, 3]) + cy * (gravity[1] - rate[i, 4]))
    return total, push - inertia * omega * rate[i, 5]


@inlined
def embed_groups(
    group, number, block, block_number, numbers, work, body, rate, base, coordinate, drive, gravity, sums
):  # fmt: skip
    """Fill ``body`` and ``rate`` from coordinate and drive; returns SOLVED, or DOUBTED where a group's pose is unclear.

    With a single coordinate its inertia and M (g - c) are summed on the way, while numbers are at hand.
    """
    single = rate.shape[1] == 6
    total = 0.0
    push = 0.0
    case = PerCoordinate(group, number, body, rate, base, coordinate, drive)
    for e in range(group.shape[0]):
        bodies = group[e]
        if bodies[KIND] == BLOCK:
            status = embed_block(
                bodies[LAW], block, block_number, numbers, work, body, rate, base, coordinate, drive, gravity, sums
            )  # fmt: skip
        elif bodies[KIND] == TRAIN:
            status = embed_train(bodies, number[e], body, rate, base, coordinate)
        else:
            status = solve_group(case, e)
        if status != SOLVED:
            return status
        if single and bodies[KIND] == BLOCK:
            total += sums[0]
            push += sums[1]
        elif single:
            total, push = with_body(body, rate, gravity, bodies[FIRST], total, push)
            if bodies[SECOND] >= 0:
                total, push = with_body(body, rate, gravity, bodies[SECOND], total, push)
    sums[0] = total
    sums[1] = push
    return SOLVED
