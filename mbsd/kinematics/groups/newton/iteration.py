"""Newton-Raphson of one block:  G du = f - F,  G = J B;  B: the bodies' rates per unit unknowns.

Tables are those of mbsd/kinematics/groups/blocks.py.
"""

from __future__ import annotations

import math

from mbsd.kinematics.groups.blocks import (
    BODIES,
    EQUATIONS,
    FREE,
    HANGS,
    LARGEST,
    MOTION,
    PLACE_I,
    PLACE_J,
    SIZE,
    SLIDE,
    UNKNOWN,
    UNKNOWNS,
)
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.matrix import factor, solve
from mbsd.kinematics.groups.newton.rows import evaluate_row, fill_columns, move
from mbsd.kinematics.newton import MAX_ITERATIONS, TOLERANCE

COLUMNS = LARGEST * LARGEST
"""Where the columns of unknowns begin in the scratch, after the matrix."""


@fused
def linearise(block, q, turn, work, values):
    """values (n,) of the equations, their rows and derivatives in ``work``, and G in its matrix."""
    count = block.head[BODIES]
    n = block.head[EQUATIONS]
    rows = block.rows
    jac = work.jac
    scratch = work.matrix
    fill_columns(block, q, turn, scratch[COLUMNS:])
    relative = scratch[COLUMNS + 3 * n * count :]
    for r in range(n):
        values[r] = evaluate_row(rows[r], block.arms[r], q, turn, block.numbers, relative, work.out[r], jac[r])
        first = rows[r, PLACE_I]
        second = rows[r, PLACE_J]
        for j in range(n):
            rate = 0.0
            for c in range(3):
                if first >= 0:
                    rate += jac[r, c] * scratch[COLUMNS + 3 * (n * first + j) + c]
                if second >= 0:
                    rate += jac[r, 3 + c] * scratch[COLUMNS + 3 * (n * second + j) + c]
            scratch[n * r + j] = rate


@fused
def correction(block, du, per_metre):
    """Largest of a change of the unknowns, in sizes and rad; NaN counts as infinite."""
    tree = block.tree
    largest = 0.0
    for e in range(block.head[BODIES]):
        c = tree[e, UNKNOWN]
        hangs = tree[e, HANGS]
        for i in range(UNKNOWNS[hangs]):
            part = abs(du[c + i])
            if hangs == SLIDE or (hangs == FREE and i < 2):
                part *= per_metre
            if not part <= largest:
                largest = part if part == part else math.inf
    return largest


@fused
def iterate(turned, block, drive, motion, work):
    """Correct the unknowns (3, n); ``turned``: pins' angles are in ``motion.turn`` at first.

    ``work`` takes the factors of G and the equations; bodies stand where the last of them were evaluated. Returns the
    determinant of G, 0 where it is singular, and the last, first and second correction.
    """
    n = block.head[EQUATIONS]
    unknown = work.unknown
    du = work.solution
    scratch = work.matrix
    per_metre = 1.0 / block.arms[0, SIZE]
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
            du[0, r] = drive[block.rows[r, MOTION], 0] - du[0, r]
        solve(scratch, du[1], n, du[0])
        for c in range(n):
            unknown[0, c] += du[0, c]
        change = correction(block, du[0], per_metre)
        if iteration == 0:
            first = change
        elif iteration == 1:
            second = change
        if change <= TOLERANCE:
            break
        if iteration > 0 and not change < 0.5 * last:
            break
        last = change
    return determinant, change, first, second
