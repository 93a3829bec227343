"""Equations of one block and their matrix G = J B, and how far a correction goes; tables as in blocks.py."""

from __future__ import annotations

import math

from mbsd.kinematics.groups.blocks import (
    BODIES,
    EQUATIONS,
    FREE,
    HANGS,
    LARGEST,
    PLACE_I,
    PLACE_J,
    SLIDE,
    UNKNOWN,
    UNKNOWNS,
)
from mbsd.kinematics.groups.newton.fused import fused
from mbsd.kinematics.groups.newton.rows import evaluate_row, fill_columns

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
