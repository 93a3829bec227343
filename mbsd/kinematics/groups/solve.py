"""The compiled closed forms: positions, velocities and accelerations of all groups at all times.

Each kind's equations and discriminant stand in its file in kinds/, blocks of Newton-Raphson in newton/. The sign of a
discriminant tells whether its group closes, and its rates tell whether it does between two poses (carrying/rates.py).

The branch is that of the start. A step is doubted, and a pose between is asked for, where the discriminant may vanish
between its ends, where a body turns too far to count turns, or where a law moves too far or jumps.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.kinematics.groups.blocks import BLOCK, DOUBTED_BEFORE, NEAR_AT, ROWS_AT, TRAIN, TREE_AT
from mbsd.kinematics.groups.carrying.rates import DOUBTED, SOLVED, dip, wound
from mbsd.kinematics.groups.groups import DRIVEN, FIRST, PRP, ROD, RPR, RRP, RRR, SECOND, SLIDE, WELDED, YOKE
from mbsd.kinematics.groups.kinds.driven import solve_driven
from mbsd.kinematics.groups.kinds.prp import solve_prp
from mbsd.kinematics.groups.kinds.rod import solve_rod
from mbsd.kinematics.groups.kinds.rpr import solve_rpr
from mbsd.kinematics.groups.kinds.rrp import solve_rrp
from mbsd.kinematics.groups.kinds.rrr import solve_rrr
from mbsd.kinematics.groups.kinds.slide import solve_slide
from mbsd.kinematics.groups.kinds.train import CARRIES_ON, solve_train
from mbsd.kinematics.groups.kinds.welded import solve_welded
from mbsd.kinematics.groups.kinds.yoke import solve_yoke
from mbsd.kinematics.groups.newton.call import call_block
from mbsd.kinematics.law_step import jumps


@kernel
def solve_groups(
    groups, blocks, start, times, drives, stride, tiny, first_row, q, v, a, determinant, turn, point, before
):
    """Fill rows ``first_row`` .. of q, v, a (T, 3 nb) at times (T,) with drives (T, motions + 1, 3).

    Angles go on from start (3 nb,). ``stride`` (motions + 1,) is how far each law may go in one step, ``tiny`` (m^2)
    the square of a length that counts as zero. The row ``first_row`` itself is not compared with the one before it.
    ``determinant`` (blocks, T, 1) is filled for the blocks (mbsd/kinematics/groups/blocks.py).
    Scratch: ``turn`` (nb, 2) with (1, 0) for ground, ``point`` (4, 8), ``before`` (g, 2) discriminants and their rates.
    Returns (status, index, part): where a step was DOUBTED, the part of it at which a pose is asked for.
    """
    for k in range(first_row, times.shape[0]):
        qk = q[k]
        vk = v[k]
        ak = a[k]
        last = start if k == 0 else q[k - 1]
        goes_on = k > first_row
        h = times[k] - times[k - 1] if goes_on else 0.0
        for e in range(groups.kind.shape[0]):
            kind = groups.kind[e]
            bodies = groups.body[e]
            motion = groups.motion[e]
            n = groups.number[e]
            turning = 3 * bodies[FIRST] + 2
            driven = motion > 0 and kind in (DRIVEN, SLIDE, ROD)
            if driven and goes_on and jumps(drives[k, motion], drives[k - 1, motion], h, stride[motion]):
                return DOUBTED, k, 0.5
            if kind == DRIVEN:
                solve_driven(bodies, n, drives[k, motion], qk, vk, ak, turn, point)
                continue
            if kind == WELDED:
                solve_welded(bodies, n, qk, vk, ak, turn, point)
                continue
            if kind == SLIDE:
                solve_slide(bodies, n, drives[k, motion], qk, vk, ak, turn, point)
                continue
            if kind == TRAIN:
                train = blocks.train[motion]
                solve_train(bodies, n, train, blocks.train_body, blocks.share, qk, vk, ak, turn, point)
                if goes_on and n[CARRIES_ON] > 0.0 and wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, turning):
                    return DOUBTED, k, 0.5
                continue
            if kind == BLOCK:
                head = blocks.head[motion]
                state = call_block(
                    blocks.address[0], k,
                    (
                        head, blocks.tree[head[TREE_AT] :], blocks.rows[head[ROWS_AT] :], blocks.near[head[NEAR_AT] :],
                        blocks.frame[head[TREE_AT] :], blocks.arms[head[ROWS_AT] :], times, drives, q, v, a, turn,
                        start, blocks.numbers, determinant[motion], point, blocks.unknown, blocks.jac,
                        blocks.out, blocks.du, blocks.scratch,
                    ),
                )  # fmt: skip
                if state == DOUBTED_BEFORE:
                    return DOUBTED, k - 1, 0.5
                if state != SOLVED:
                    return state, k, 0.5
                continue
            if kind == RRR:
                state = solve_rrr(bodies, n, qk, vk, ak, last, turn, point)
            elif kind == RRP:
                state = solve_rrp(bodies, n, qk, vk, ak, last, turn, point)
            elif kind == RPR:
                state = solve_rpr(bodies, n, qk, vk, ak, last, tiny, turn, point)
            elif kind == YOKE:
                state = solve_yoke(bodies, n, qk, vk, ak, turn, point)
            elif kind == PRP:
                state = solve_prp(bodies, n, qk, vk, ak, turn, point)
            else:
                state = solve_rod(bodies, n, drives[k, motion], qk, vk, ak, last, turn, point)
            if state != SOLVED:
                return state, k, 0.0
            left = point[3, 0]
            rate_of_left = point[3, 1]
            if goes_on:
                if wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, turning):
                    return DOUBTED, k, 0.5
                if kind == RRR and wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, 3 * bodies[SECOND] + 2):
                    return DOUBTED, k, 0.5
                part = dip(h * before[e, 1], before[e, 0], h * rate_of_left, left)
                if part > 0.0:
                    return DOUBTED, k, part
            before[e, 0] = left
            before[e, 1] = rate_of_left
    return SOLVED, times.shape[0], 0.0
