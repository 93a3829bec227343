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
def solve_groups(
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
        kind = bodies[KIND]
        n = number[e]
        status = SOLVED
        if kind == RRR:
            status = embed_rrr(bodies, n, body, rate, base, coordinate)
        elif kind == DRIVEN:
            embed_driven(bodies, n, body, rate, coordinate, drive)
        elif kind == WELDED:
            status = embed_welded(bodies, n, body, rate, coordinate)
        elif kind == RRP:
            status = embed_rrp(bodies, n, body, rate, base, coordinate)
        elif kind == RPR:
            status = embed_rpr(bodies, n, body, rate, base, coordinate)
        elif kind == YOKE:
            status = embed_yoke(bodies, n, body, rate, coordinate)
        elif kind == PRP:
            status = embed_prp(bodies, n, body, rate, coordinate)
        elif kind == ROD:
            status = embed_rod(bodies, n, body, rate, base, coordinate, drive)
        elif kind == TRAIN:
            status = embed_train(bodies, n, body, rate, base, coordinate)
        elif kind == BLOCK:
            status = embed_block(
                bodies[LAW], block, block_number, numbers, work, body, rate, base, coordinate, drive, gravity, sums
            )  # fmt: skip
        else:
            status = embed_slide(bodies, n, body, rate, coordinate, drive)
        if status != SOLVED:
            return status
        a = bodies[FIRST]
        b = bodies[SECOND]
        if single and kind == BLOCK:
            total += sums[0]
            push += sums[1]
        elif single:
            mass = body[a, MASS]
            inertia = body[a, INERTIA]
            cx = rate[a, 0]
            cy = rate[a, 1]
            omega = rate[a, 2]
            total += mass * (cx * cx + cy * cy) + inertia * omega * omega
            push += mass * (cx * (gravity[0] - rate[a, 3]) + cy * (gravity[1] - rate[a, 4]))
            push -= inertia * omega * rate[a, 5]
            if b >= 0:
                mass = body[b, MASS]
                inertia = body[b, INERTIA]
                cx = rate[b, 0]
                cy = rate[b, 1]
                omega = rate[b, 2]
                total += mass * (cx * cx + cy * cy) + inertia * omega * omega
                push += mass * (cx * (gravity[0] - rate[b, 3]) + cy * (gravity[1] - rate[b, 4]))
                push -= inertia * omega * rate[b, 5]
    sums[0] = total
    sums[1] = push
    return SOLVED
