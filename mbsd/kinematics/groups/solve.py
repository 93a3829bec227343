"""The compiled closed forms: positions, velocities and accelerations of all groups at all times.

Each kind's equations stand in its file in kinds/, blocks of Newton-Raphson in newton/. The squared sine of a group
tells whether it closes, and its rate tells whether it does between two poses (carried.py).

The branch is that of the start. A step is doubted, and a pose between is asked for, where the squared sine may vanish
between its ends, where a body turns too far to count turns, or where a law moves too far or jumps.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.compiling.jit import internal, kernel, merged
from mbsd.kinematics.groups.blocks import (
    BLOCK,
    BODIES,
    BODY,
    DOUBTED_BEFORE,
    NEAR_AT,
    ROWS_AT,
    TRAIN,
    TREE_AT,
    Block,
    History,
    Work,
)
from mbsd.kinematics.groups.carried import CHANGE, COS, DOUBTED, OMEGA, SIN, SINE, SOLVED, X, Y, dip, wound
from mbsd.kinematics.groups.cases import AlongLaws
from mbsd.kinematics.groups.groups import (
    DRIVEN,
    FIRST,
    KIND,
    LAW,
    PRP,
    ROD,
    RPR,
    RRP,
    RRR,
    SECOND,
    WATCHED,
    WELDED,
    YOKE,
)
from mbsd.kinematics.groups.kinds.driven import SENSE, solve_driven
from mbsd.kinematics.groups.kinds.prp import solve_prp
from mbsd.kinematics.groups.kinds.rod import solve_rod
from mbsd.kinematics.groups.kinds.rpr import solve_rpr
from mbsd.kinematics.groups.kinds.rrp import solve_rrp
from mbsd.kinematics.groups.kinds.rrr import solve_rrr
from mbsd.kinematics.groups.kinds.slide import solve_slide
from mbsd.kinematics.groups.kinds.train import CARRIES_ON, solve_train
from mbsd.kinematics.groups.kinds.welded import solve_welded
from mbsd.kinematics.groups.kinds.yoke import solve_yoke
from mbsd.kinematics.groups.newton.block import solve_block
from mbsd.kinematics.newton import jumps


@merged
def solve_group(case, e):
    """Place the bodies of group e and fill their rates; see kinds/prp.py. Returns SOLVED, or why not."""
    kind = case.group[e, KIND]
    if kind == RRR:
        return solve_rrr(case, e)
    if kind == DRIVEN:
        return solve_driven(case, e)
    if kind == WELDED:
        return solve_welded(case, e)
    if kind == RRP:
        return solve_rrp(case, e)
    if kind == RPR:
        return solve_rpr(case, e)
    if kind == YOKE:
        return solve_yoke(case, e)
    if kind == PRP:
        return solve_prp(case, e)
    if kind == ROD:
        return solve_rod(case, e)
    return solve_slide(case, e)


CLOSE_ENDS = 2e-4
"""Squared sine of a group at the first or last step below which a change point may be near."""
SOLVED_CLOSE = 4


@internal
def write_motion(body, rate, b, q, v, a, turn):
    """Copy pose and rates of body b from the closed forms to a row of the motion, without the angle."""
    at = 3 * b
    q[at] = body[b, X]
    q[at + 1] = body[b, Y]
    turn[b, 0] = body[b, COS]
    turn[b, 1] = body[b, SIN]
    for c in range(3):
        v[at + c] = rate[b, c]
        a[at + c] = rate[b, 3 + c]


@internal
def read_motion(body, rate, b, q, v, a, turn):
    """Take pose and rates of body b from a row of the motion to the closed forms."""
    at = 3 * b
    body[b, X] = q[at]
    body[b, Y] = q[at + 1]
    body[b, COS] = turn[b, 0]
    body[b, SIN] = turn[b, 1]
    body[b, OMEGA] = v[at + 2]
    for c in range(3):
        rate[b, c] = v[at + c]
        rate[b, 3 + c] = a[at + c]


@internal
def turned_on(body, b, before):
    """Return angle of body b (rad), whose cosine and sine are known, next to the angle ``before``."""
    angle = math.atan2(body[b, SIN], body[b, COS])
    return angle + 2.0 * math.pi * math.floor((before - angle) / (2.0 * math.pi) + 0.5)


class Poses(NamedTuple):
    """Scratch: all bodies at one time."""

    body: Any
    """(nb, 7), with cosine 1 for ground."""
    rate: Any
    """(nb, 6)"""
    turn: Any
    """(nb, 2), with cosine 1 for ground."""
    point: Any
    """(4, 8)"""
    before: Any
    """(g, 3) squared sines and their rates; the last column keeps the squared sines of the first row of all."""


@internal
def _solve_block_of(blocks, n, k, motion, turn, start, determinant, point):
    """Solve block n at row k of the motion; returns SOLVED, or why not."""
    head = blocks.head[n]
    return solve_block(
        k,
        Block(
            head, blocks.tree[head[TREE_AT] :], blocks.rows[head[ROWS_AT] :], blocks.near[head[NEAR_AT] :],
            blocks.frame[head[TREE_AT] :], blocks.arms[head[ROWS_AT] :], blocks.numbers,
        ),
        History(motion.times, motion.drives, motion.q, motion.v, motion.a, turn, start, determinant[n]),
        Work(blocks.unknown, blocks.jac, blocks.out, blocks.du, blocks.scratch, point),
    )  # fmt: skip


@kernel
def solve_groups(groups, blocks, start, motion, determinant, poses, tiny, first_row):
    """Fill q, v, a of ``motion`` (kinematics/newton.py) from row ``first_row`` on.

    Angles go on from start (3 nb,); ``tiny`` (m^2) is the square of a length that counts as zero. The row ``first_row``
    itself is not compared with the one before it. ``determinant`` (blocks, T, 1) is filled for the blocks
    (mbsd/kinematics/groups/blocks.py). Returns (status, index, part): where a step was DOUBTED, the part of it at which
    a pose is asked for. The status is SOLVED_CLOSE where all are solved and both poses of a group are close to each
    other at the first or the last.
    """
    times = motion.times
    drives = motion.drives
    q = motion.q
    v = motion.v
    a = motion.a
    body = poses.body
    rate = poses.rate
    turn = poses.turn
    before = poses.before
    for k in range(first_row, times.shape[0]):
        qk = q[k]
        vk = v[k]
        ak = a[k]
        last = start if k == 0 else q[k - 1]
        goes_on = k > first_row
        h = times[k] - times[k - 1] if goes_on else 0.0
        case = AlongLaws(groups.group, groups.row, body, rate, drives[k], tiny)
        for e in range(groups.kind.shape[0]):
            kind = groups.kind[e]
            bodies = groups.group[e]
            n = groups.row[e]
            if kind == TRAIN:
                train = blocks.train[groups.motion[e]]
                solve_train(bodies, n, train, blocks.train_body, blocks.share, qk, vk, ak, turn, poses.point)
                turning = 3 * bodies[FIRST] + 2
                if goes_on and n[CARRIES_ON] > 0.0 and wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, turning):
                    return DOUBTED, k, 0.5
                read_motion(body, rate, bodies[FIRST], qk, vk, ak, turn)
                continue
            if kind == BLOCK:
                state = _solve_block_of(blocks, groups.motion[e], k, motion, turn, start, determinant, poses.point)
                if state == DOUBTED_BEFORE:
                    return DOUBTED, k - 1, 0.5
                if state != SOLVED:
                    return state, k, 0.5
                head = blocks.head[groups.motion[e]]
                for i in range(head[TREE_AT], head[TREE_AT] + head[BODIES]):
                    read_motion(body, rate, blocks.tree[i, BODY], qk, vk, ak, turn)
                continue
            law = bodies[LAW]
            if law > 0 and goes_on and jumps(drives[k, law], drives[k - 1, law], h, motion.stride[law]):
                return DOUBTED, k, 0.5
            state = solve_group(case, e)
            if state != SOLVED:
                return state, k, 0.0
            for side in range(2):
                b = bodies[FIRST + side]
                if b < 0:
                    break
                write_motion(body, rate, b, qk, vk, ak, turn)
                leader = groups.turning[e, side]
                if kind == DRIVEN:
                    qk[3 * b + 2] = qk[3 * leader + 2] + n[SENSE] * (groups.angle[e, side] + drives[k, law, 0])
                elif leader >= 0:
                    qk[3 * b + 2] = qk[3 * leader + 2] + groups.angle[e, side]
                else:
                    qk[3 * b + 2] = turned_on(body, b, last[3 * b + 2])
            watched = groups.turning[e, WATCHED]
            if goes_on and watched > 0:
                if wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, 3 * bodies[FIRST] + 2):
                    return DOUBTED, k, 0.5
                if watched > 1 and wound(qk, last, vk, v[k - 1], ak, a[k - 1], h, 3 * bodies[SECOND] + 2):
                    return DOUBTED, k, 0.5
                part = dip(h * before[e, 1], before[e, 0], h * n[CHANGE], n[SINE])
                if part > 0.0:
                    return DOUBTED, k, part
            before[e, 0] = n[SINE]
            before[e, 1] = n[CHANGE]
            if k == 0:
                before[e, 2] = n[SINE]
    return SOLVED_CLOSE if comes_close(before) else SOLVED, times.shape[0], 0.0


@internal
def comes_close(before):
    """Return True if both poses of a group are close to each other at the first or the last row."""
    for e in range(before.shape[0]):
        for c in range(0, 3, 2):
            if 0.0 < before[e, c] < CLOSE_ENDS:
                return True
    return False
