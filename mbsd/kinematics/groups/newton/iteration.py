"""Newton-Raphson of one block:  G du = f - F,  G = J B;  B the rates of the bodies for unit rates of the unknowns.

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
def linearise(head, tree, rows, frame, arms, q, turn, numbers, jac, out, values, scratch):
    """values (n,) of the equations, their rows jac (n, 6) with derivatives out (n, 10), and G in the scratch."""
    count = head[BODIES]
    n = head[EQUATIONS]
    fill_columns(tree, frame, count, n, q, turn, scratch[COLUMNS:])
    relative = scratch[COLUMNS + 3 * n * count :]
    for r in range(n):
        values[r] = evaluate_row(rows[r], arms[r], q, turn, numbers, relative, out[r], jac[r])
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
def correction(head, tree, du, per_metre):
    """Largest of a change of the unknowns, in sizes and rad; NaN counts as infinite."""
    largest = 0.0
    for e in range(head[BODIES]):
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
def iterate(
    turned, head, tree, rows, frame, arms, drive, q, v, a, turn, numbers, jac, out, scratch, unknown, du, point
):  # fmt: skip
    """Correct the unknowns (3, n) from where they stand; ``turned``: pins' angles are in ``turn`` at first.

    The scratch takes the factors of G, jac (n, 6) and out (n, 10) the equations; bodies stand where the last of them
    were evaluated. Returns the determinant of G, 0 where it is singular, and the last, first and second correction.
    """
    count = head[BODIES]
    n = head[EQUATIONS]
    per_metre = 1.0 / arms[0, SIZE]
    determinant = 0.0
    first = 0.0
    second = 0.0
    last = math.inf
    change = math.inf
    for iteration in range(MAX_ITERATIONS):
        move(tree, frame, count, unknown, turned and iteration == 0, q, v, a, turn, point)
        linearise(head, tree, rows, frame, arms, q, turn, numbers, jac, out, du[0], scratch)
        determinant = factor(scratch, du[1], n)
        if determinant == 0.0:
            break
        for r in range(n):
            du[0, r] = drive[rows[r, MOTION], 0] - du[0, r]
        solve(scratch, du[1], n, du[0])
        for c in range(n):
            unknown[0, c] += du[0, c]
        change = correction(head, tree, du[0], per_metre)
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
