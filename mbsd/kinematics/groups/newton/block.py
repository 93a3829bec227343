"""One block at one time by Newton-Raphson in its few unknowns, with the branch guard of newton.py.

    predict   poses from the quintic through the last two
    correct   G du = -F,  G = J B;  B the rates of the bodies for unit rates of the unknowns
    then      G u' = f' - J v,   G u'' = gamma + f'' - J a      v, a of the block with its unknowns held

It is compiled when a plan with blocks is first solved.
"""

from __future__ import annotations

from mbsd.compiling.jit import lazy
from mbsd.kinematics.groups.blocks import (
    BODIES,
    BODY,
    EQUATIONS,
    MOTION,
    SIZE,
    STRIDE,
)
from mbsd.kinematics.groups.carrying.rates import DOUBTED, MEETING, SOLVED
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.guard import in_doubt
from mbsd.kinematics.groups.newton.iteration import iterate
from mbsd.kinematics.groups.newton.matrix import held, solve
from mbsd.kinematics.groups.newton.records import Motion
from mbsd.kinematics.groups.newton.rows import bend_of, move, read_unknowns
from mbsd.kinematics.law_step import jumps
from mbsd.kinematics.newton import ROUNDING
from mbsd.kinematics.predictor import quintic_factors, quintic_value


@fused
def predict(k, block, history):
    """Fill row k of q for the block's bodies."""
    tree = block.tree
    q = history.q
    factors = quintic_factors(history.times, k, history.times[k]) if k > 0 else (0.0, 0.0, 0.0, 0.0, 0.0)
    for e in range(block.head[BODIES]):
        for c in range(3 * tree[e, BODY], 3 * tree[e, BODY] + 3):
            q[k, c] = history.start[c] if k == 0 else quintic_value(factors, k, q, history.v, history.a, c)


@lazy(int)
def solve_block(k, block, history, work):
    """Fill row k of q, v, a (T, 3 nb) for the bodies of one block; returns SOLVED, or why not."""
    n = block.head[EQUATIONS]
    rows = block.rows
    arms = block.arms
    unknown = work.unknown
    per_metre = 1.0 / arms[0, SIZE]
    motion = Motion(history.q[k], history.v[k], history.a[k], history.turn)
    drive = history.drives[k]
    h = history.times[k] - history.times[k - 1] if k > 0 else 0.0
    for r in range(n):
        law = rows[r, MOTION]
        if k > 0 and law > 0 and jumps(drive[law], history.drives[k - 1, law], h, arms[r, STRIDE]):
            return DOUBTED
    predict(k, block, history)
    read_unknowns(block, motion.q, motion.turn, unknown[0])
    for c in range(n):
        unknown[1, c] = 0.0
        unknown[2, c] = 0.0
    determinant, change, first, second = iterate(True, block, drive, motion, work)
    history.determinant[k, 0] = determinant
    if determinant == 0.0:
        return MEETING
    if not change <= ROUNDING:
        return DOUBTED
    for r in range(n):
        unknown[1, r] = drive[rows[r, MOTION], 1] - held(work.jac[r], rows[r], motion.v)
    solve(work.matrix, work.solution[1], n, unknown[1])
    move(block, unknown, False, motion, work.point)
    for r in range(n):
        bend = bend_of(rows[r], arms[r], motion.q, motion.v, motion.turn, work.out[r])
        unknown[2, r] = bend + drive[rows[r, MOTION], 2] - held(work.jac[r], rows[r], motion.a)
    solve(work.matrix, work.solution[1], n, unknown[2])
    move(block, unknown, True, motion, work.point)
    return in_doubt(k, block, history, h, per_metre, first, second) if k > 0 else SOLVED
