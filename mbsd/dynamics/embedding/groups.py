"""Positions, rates for each column, and convective accelerations of all groups, one after the other.

Each kind's equations stand in its file in mbsd/kinematics/groups/kinds/. The rates are solved for each column of B, and
once more for the convective accelerations, whose right-hand sides have the terms in omega^2 besides.
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined
from mbsd.dynamics.embedding.blocks.block import embed_block
from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.carrying.columns import INERTIA, MASS
from mbsd.kinematics.groups.carrying.rates import SOLVED
from mbsd.kinematics.groups.groups import DRIVEN, FIRST, KIND, LAW, PRP, ROD, RPR, RRP, RRR, SECOND, WELDED, YOKE
from mbsd.kinematics.groups.kinds.driven import embed_driven
from mbsd.kinematics.groups.kinds.prp import embed_prp
from mbsd.kinematics.groups.kinds.rod import embed_rod
from mbsd.kinematics.groups.kinds.rpr import embed_rpr
from mbsd.kinematics.groups.kinds.rrp import embed_rrp
from mbsd.kinematics.groups.kinds.rrr import embed_rrr
from mbsd.kinematics.groups.kinds.slide import embed_slide
from mbsd.kinematics.groups.kinds.train import embed_train
from mbsd.kinematics.groups.kinds.welded import embed_welded
from mbsd.kinematics.groups.kinds.yoke import embed_yoke


@inlined
def embed_group(bodies, n, body, rate, base, coordinate, drive):
    """The group of the kind that ``bodies`` names; returns its status."""
    kind = bodies[KIND]
    if kind == RRR:
        return embed_rrr(bodies, n, body, rate, base, coordinate)
    if kind == DRIVEN:
        embed_driven(bodies, n, body, rate, coordinate, drive)
        return SOLVED
    if kind == WELDED:
        return embed_welded(bodies, n, body, rate, coordinate)
    if kind == RRP:
        return embed_rrp(bodies, n, body, rate, base, coordinate)
    if kind == RPR:
        return embed_rpr(bodies, n, body, rate, base, coordinate)
    if kind == YOKE:
        return embed_yoke(bodies, n, body, rate, coordinate)
    if kind == PRP:
        return embed_prp(bodies, n, body, rate, coordinate)
    if kind == ROD:
        return embed_rod(bodies, n, body, rate, base, coordinate, drive)
    if kind == TRAIN:
        return embed_train(bodies, n, body, rate, base, coordinate)
    return embed_slide(bodies, n, body, rate, coordinate, drive)


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
    for e in range(group.shape[0]):
        bodies = group[e]
        if bodies[KIND] == BLOCK:
            status = embed_block(
                bodies[LAW], block, block_number, numbers, work, body, rate, base, coordinate, drive, gravity, sums
            )  # fmt: skip
        else:
            status = embed_group(bodies, number[e], body, rate, base, coordinate, drive)
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
