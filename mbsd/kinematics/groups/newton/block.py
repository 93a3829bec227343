"""One block of a plan at one time by Newton-Raphson in its few unknowns, with the branch guard of newton.py.

    predict   poses from the quintic through the last two
    correct   G du = -F,  G = J B;  B the rates of the bodies for unit rates of the unknowns
    then      G u' = f' - J v,   G u'' = gamma + f'' - J a      v, a of the block with its unknowns held

It is reached by its machine address, and compiled when a plan with blocks is first solved.
"""

from __future__ import annotations

from numba import carray

from mbsd.compiling.jit import COMPILED, at_address
from mbsd.kinematics.groups.blocks import (
    BODIES,
    BODY,
    EQUATIONS,
    LARGEST,
    LAWS,
    MOTION,
    MOVING,
    NEAR,
    SIZE,
    STRIDE,
)
from mbsd.kinematics.groups.carrying.rates import DOUBTED, MEETING, SOLVED
from mbsd.kinematics.groups.newton.call import PYTHON, SIGNATURE
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.guard import in_doubt
from mbsd.kinematics.groups.newton.iteration import iterate
from mbsd.kinematics.groups.newton.matrix import held, solve
from mbsd.kinematics.groups.newton.records import Block, History, Motion, Work
from mbsd.kinematics.groups.newton.rows import bend_of, move, read_unknowns
from mbsd.kinematics.law_step import jumps
from mbsd.kinematics.newton import ROUNDING
from mbsd.kinematics.predictor import quintic_factors, quintic_value

LONG = 1 << 40
"""For arrays whose length does not matter."""


@fused
def predict(k, block, history):
    """Fill row k of q for the block's bodies."""
    tree = block.tree
    q = history.q
    factors = quintic_factors(history.times, k, history.times[k]) if k > 0 else (0.0, 0.0, 0.0, 0.0, 0.0)
    for e in range(block.head[BODIES]):
        for c in range(3 * tree[e, BODY], 3 * tree[e, BODY] + 3):
            q[k, c] = history.start[c] if k == 0 else quintic_value(factors, k, q, history.v, history.a, c)


@fused
def solve_arrays(k, block, history, work):
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


def _at_address(
    k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
    unknown, jac, out, du, scratch,
):  # fmt: skip
    """The same with pointers."""
    sizes = carray(head, (MOVING + 1,))
    count = sizes[BODIES]
    n = sizes[EQUATIONS]
    bodies = sizes[MOVING]
    known = k + 1
    block = Block(
        sizes,
        carray(tree, (count, 5)),
        carray(rows, (n, 9)),
        carray(near, (sizes[NEAR],)),
        carray(frame, (count, 7)),
        carray(arms, (n, 9)),
        carray(numbers, (LONG,)),
    )
    history = History(
        carray(times, (known,)),
        carray(drives, (known, sizes[LAWS], 3)),
        carray(q, (known, 3 * bodies)),
        carray(v, (known, 3 * bodies)),
        carray(a, (known, 3 * bodies)),
        carray(turn, (bodies, 2)),
        carray(start, (3 * bodies,)),
        carray(determinant, (known, 1)),
    )
    work = Work(
        carray(unknown, (3, LARGEST)),
        carray(jac, (LARGEST, 6)),
        carray(out, (LARGEST, 10)),
        carray(du, (2, LARGEST)),
        carray(scratch, (LONG,)),
        carray(point, (4, 8)),
    )
    return solve_arrays(k, block, history, work)


def _from_arrays(
    k, head, tree, rows, near, frame, arms, times, drives, q, v, a, turn, start, numbers, determinant, point,
    unknown, jac, out, du, scratch,
):  # fmt: skip
    """The same with arrays, where nothing is compiled."""
    block = Block(head, tree, rows, near, frame, arms, numbers)
    history = History(times, drives, q, v, a, turn, start, determinant)
    return solve_arrays(k, block, history, Work(unknown, jac, out, du, scratch, point))


if COMPILED:
    ADDRESS = at_address(SIGNATURE)(_at_address).address
else:
    PYTHON[:] = [_from_arrays]
    ADDRESS = 0
