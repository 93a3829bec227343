"""One block at one time by Newton-Raphson in its few unknowns, with the branch guard of newton.py.

    predict   poses from the quintic through the last two
    correct   G du = -F,  G = J B;  B the rates of the bodies for unit rates of the unknowns
    then      G u' = f' - J v,   G u'' = gamma + f'' - J a      v, a of the block with its unknowns held

It is compiled when a plan with blocks is first solved. Tables are those of mbsd/kinematics/groups/blocks.py. The loop
is not that of newton.py, since its unknowns are those of hanging bodies and its matrix is small and dense; the test of
its corrections and the guard are. Simulations in independent coordinates close their blocks by :func:`iterate`, too.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import lazy, merged
from mbsd.kinematics.groups import blocks
from mbsd.kinematics.groups.carried import DOUBTED, MEETING, SOLVED
from mbsd.kinematics.groups.newton.matrix import extent, factor, held, solve, turns_too_far
from mbsd.kinematics.groups.newton.rows import bend_of, evaluate_row, fill_columns, move, read_unknowns
from mbsd.kinematics.newton import (
    MAX_ITERATIONS,
    ROUNDING,
    has_settled,
    heads_for_zero,
    is_suspicious,
    jumps,
    quintic_factors,
    quintic_value,
)

COLUMNS = blocks.LARGEST * blocks.LARGEST
"""Start of the columns of unknowns in the scratch, after the matrix."""


@merged
def linearise(block, q, turn, work, values):
    """Fill values (n,) of the equations, their rows and derivatives in ``work``, and G in its matrix."""
    count = block.head[blocks.BODIES]
    n = block.head[blocks.EQUATIONS]
    rows = block.rows
    jac = work.jac
    scratch = work.matrix
    fill_columns(block, q, turn, scratch[COLUMNS:])
    relative = scratch[COLUMNS + 3 * n * count :]
    for r in range(n):
        values[r] = evaluate_row(rows[r], block.arms[r], q, turn, block.numbers, relative, work.out[r], jac[r])
        first = rows[r, blocks.PLACE_I]
        second = rows[r, blocks.PLACE_J]
        for j in range(n):
            rate = 0.0
            for c in range(3):
                if first >= 0:
                    rate += jac[r, c] * scratch[COLUMNS + 3 * (n * first + j) + c]
                if second >= 0:
                    rate += jac[r, 3 + c] * scratch[COLUMNS + 3 * (n * second + j) + c]
            scratch[n * r + j] = rate


@merged
def correction(block, du, per_metre):
    """Return largest of a change of the unknowns, in sizes and rad; NaN counts as infinite."""
    tree = block.tree
    largest = 0.0
    for e in range(block.head[blocks.BODIES]):
        c = tree[e, blocks.UNKNOWN]
        hangs = tree[e, blocks.HANGS]
        for i in range(blocks.UNKNOWNS[hangs]):
            part = abs(du[c + i])
            if hangs == blocks.SLIDE or (hangs == blocks.FREE and i < 2):
                part *= per_metre
            if not part <= largest:
                largest = part if part == part else math.inf
    return largest


@merged
def iterate(turned, block, drive, motion, work):
    """Correct the unknowns (3, n); ``turned``: pins' angles are in ``motion.turn`` at first.

    ``work`` takes the factors of G and the equations; bodies stand where the last of them were evaluated. Returns the
    determinant of G, 0 where it is singular, and the last, first and second correction.
    """
    n = block.head[blocks.EQUATIONS]
    unknown = work.unknown
    du = work.solution
    scratch = work.matrix
    per_metre = 1.0 / block.arms[0, blocks.SIZE]
    determinant = 0.0
    first = 0.0
    second = 0.0
    last = math.inf
    change = math.inf
    for iteration in range(MAX_ITERATIONS):
        move(block, unknown, turned and iteration == 0, motion, work.point)
        linearise(block, motion.q, motion.turn, work, du[0])
        determinant = factor(scratch, du[1], n)
        if determinant == 0.0:
            break
        for r in range(n):
            du[0, r] = drive[block.rows[r, blocks.MOTION], 0] - du[0, r]
        solve(scratch, du[1], n, du[0])
        for c in range(n):
            unknown[0, c] += du[0, c]
        change = correction(block, du[0], per_metre)
        if iteration == 0:
            first = change
        elif iteration == 1:
            second = change
        if has_settled(iteration, change, last):
            break
        last = change
    return determinant, change, first, second


@merged
def in_doubt(k, block, history, h, per_metre, first, second):
    """Return SOLVED if row k is on its branch, else in which step a pose is needed."""
    q = history.q
    step = 0.0
    for e in range(block.head[blocks.BODIES]):
        step = max(step, extent(q[k], q[k - 1], block.tree[e, blocks.BODY], per_metre))
    for e in range(block.head[blocks.NEAR]):
        step = max(step, extent(q[k], q[k - 1], block.near[e], per_metre))
    if is_suspicious(first, second, step):
        return DOUBTED
    refused = heads_for_zero(history.determinant, history.times, k, 0)
    if refused > 0:
        return DOUBTED if refused == k else blocks.DOUBTED_BEFORE
    return DOUBTED if turns_too_far(block.head, block.tree, q, history.v, history.a, k, h, per_metre) else SOLVED


@merged
def predict(k, block, history):
    """Fill row k of q for the block's bodies."""
    tree = block.tree
    q = history.q
    factors = quintic_factors(history.times, k, history.times[k]) if k > 0 else (0.0, 0.0, 0.0, 0.0, 0.0)
    for e in range(block.head[blocks.BODIES]):
        for c in range(3 * tree[e, blocks.BODY], 3 * tree[e, blocks.BODY] + 3):
            q[k, c] = history.start[c] if k == 0 else quintic_value(factors, k, q, history.v, history.a, c)


@lazy(int)
def solve_block(k, block, history, work):
    """Fill row k of q, v, a (T, 3 nb) for the bodies of one block; returns SOLVED, or why not."""
    n = block.head[blocks.EQUATIONS]
    rows = block.rows
    arms = block.arms
    unknown = work.unknown
    per_metre = 1.0 / arms[0, blocks.SIZE]
    motion = blocks.Motion(history.q[k], history.v[k], history.a[k], history.turn)
    drive = history.drives[k]
    h = history.times[k] - history.times[k - 1] if k > 0 else 0.0
    for r in range(n):
        law = rows[r, blocks.MOTION]
        if k > 0 and law > 0 and jumps(drive[law], history.drives[k - 1, law], h, arms[r, blocks.STRIDE]):
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
        unknown[1, r] = drive[rows[r, blocks.MOTION], 1] - held(work.jac[r], rows[r], motion.v)
    solve(work.matrix, work.solution[1], n, unknown[1])
    move(block, unknown, False, motion, work.point)
    for r in range(n):
        bend = bend_of(rows[r], arms[r], motion.q, motion.v, motion.turn, work.out[r])
        unknown[2, r] = bend + drive[rows[r, blocks.MOTION], 2] - held(work.jac[r], rows[r], motion.a)
    solve(work.matrix, work.solution[1], n, unknown[2])
    move(block, unknown, True, motion, work.point)
    return in_doubt(k, block, history, h, per_metre, first, second) if k > 0 else SOLVED
