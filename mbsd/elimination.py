"""Linear solves with the constraint Jacobian by a fixed elimination sequence found once per mechanism.

Most entries of J in reference coordinates are constants (+-1 on the coordinates of a body). Pivots on them never
vanish, so they are taken first, in Markowitz order, by a tape of index pairs; they cut J down to a small dense
block in which rows are pivoted at run time. For a four-bar 9 x 9 becomes 2 x 2. Exact LU, nothing is approximated.

    forward   L y = b,   block   B x_C = y_R,   backward   U x = y

Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 7 (Markowitz) and 9 (a generated pivot sequence).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.jit import kernel


class Elimination(NamedTuple):
    """The sequence, as constant arrays. p constant pivots, k = n - p rows and columns in the dense block."""

    kept_rows: Any
    """(n,) rows of J that are solved; the others repeat them."""
    pivot_row: Any
    pivot_column: Any
    """(p,)"""
    lower_start: Any
    """(p + 1,) into lower_row: rows that pivot k is subtracted from."""
    lower_row: Any
    upper_start: Any
    """(p + 1,) into upper_column: other columns of pivot row k."""
    upper_column: Any
    block_rows: Any
    block_columns: Any
    """(k,)"""


class Factors(NamedTuple):
    """Scratch that holds the factors of one Jacobian."""

    work: Any
    """(n, n)"""
    block: Any
    """(k, k)"""
    order: Any
    """(k,) row order of the block."""
    scratch: Any
    """(max(k, 1),)"""


def plan(samples: np.ndarray, kept_rows: np.ndarray) -> Elimination:
    """Find the sequence from Jacobians (s, m, n) at s unrelated poses: what is the same in all is constant."""
    matrices = samples[:, kept_rows, :]
    value = matrices[0].copy()
    pattern = np.any(matrices != 0.0, axis=0)
    constant = pattern & np.all(matrices == matrices[0], axis=0)
    n = len(kept_rows)
    open_rows, open_columns = np.ones(n, bool), np.ones(n, bool)
    rows: list[int] = []
    columns: list[int] = []
    lower: list[np.ndarray] = []
    upper: list[np.ndarray] = []
    while True:
        found = _cheapest_pivot(pattern, constant & (np.abs(value) > 1e-9), open_rows, open_columns)
        if found is None:
            break
        r, c = found
        open_rows[r], open_columns[c] = False, False
        targets = np.flatnonzero(pattern[:, c] & open_rows)
        others = np.flatnonzero(pattern[r] & open_columns)
        for i in targets:
            factor = value[i, c] / value[r, c]
            value[i, others] -= factor * value[r, others]
            constant[i, others] &= constant[i, c] & constant[r, others] | ~pattern[r, others]
            pattern[i, others] = True
        rows.append(r)
        columns.append(c)
        lower.append(targets)
        upper.append(others)
    return Elimination(
        kept_rows=np.ascontiguousarray(kept_rows, dtype=np.int64),
        pivot_row=np.array(rows, dtype=np.int64),
        pivot_column=np.array(columns, dtype=np.int64),
        lower_start=_starts(lower),
        lower_row=_joined(lower),
        upper_start=_starts(upper),
        upper_column=_joined(upper),
        block_rows=np.flatnonzero(open_rows),
        block_columns=np.flatnonzero(open_columns),
    )


def factors(sequence: Elimination) -> Factors:
    """Scratch for the factors."""
    n, k = len(sequence.kept_rows), len(sequence.block_rows)
    return Factors(np.zeros((n, n)), np.zeros((k, k)), np.zeros(k, np.int64), np.zeros(max(k, 1)))


def _cheapest_pivot(
    pattern: np.ndarray, usable: np.ndarray, open_rows: np.ndarray, open_columns: np.ndarray
) -> tuple[int, int] | None:
    active = pattern & open_rows[:, None] & open_columns[None, :]
    candidates = usable & active
    if not candidates.any():
        return None
    fill = (active.sum(1) - 1)[:, None] * (active.sum(0) - 1)[None, :]
    best = int(np.argmin(np.where(candidates, fill, np.iinfo(np.int64).max)))
    return best // pattern.shape[1], best % pattern.shape[1]


def _starts(lists: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([[0], np.cumsum([len(item) for item in lists])]).astype(np.int64)


def _joined(lists: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([*lists, np.zeros(0)]).astype(np.int64)


@kernel
def factorise(seq, jac, fac):
    """Factor the kept rows of J (m, 3 nb; ground's columns skipped).

    Returns (sign, margin): sign of the block's determinant, and its smallest over its largest pivot; 0 if singular.
    """
    work = fac.work
    n = seq.kept_rows.shape[0]
    for r in range(n):
        source = seq.kept_rows[r]
        for c in range(n):
            work[r, c] = jac[source, c + 3]
    for p in range(seq.pivot_row.shape[0]):
        r, c = seq.pivot_row[p], seq.pivot_column[p]
        inverse = 1.0 / work[r, c]
        for a in range(seq.lower_start[p], seq.lower_start[p + 1]):
            i = seq.lower_row[a]
            factor = work[i, c] * inverse
            work[i, c] = factor
            for b in range(seq.upper_start[p], seq.upper_start[p + 1]):
                j = seq.upper_column[b]
                work[i, j] -= factor * work[r, j]
    return _factorise_block(seq, fac)


@kernel
def _factorise_block(seq, fac):
    """LU with partial pivoting of the dense block, in place."""
    block, order = fac.block, fac.order
    k = seq.block_rows.shape[0]
    sign, smallest, largest = 1.0, np.inf, 0.0
    for a in range(k):
        order[a] = a
        for b in range(k):
            block[a, b] = fac.work[seq.block_rows[a], seq.block_columns[b]]
    for c in range(k):
        best, size = c, abs(block[c, c])
        for r in range(c + 1, k):
            if abs(block[r, c]) > size:
                best, size = r, abs(block[r, c])
        if best != c:
            sign = -sign
            order[c], order[best] = order[best], order[c]
            for b in range(k):
                block[c, b], block[best, b] = block[best, b], block[c, b]
        smallest, largest = min(smallest, size), max(largest, size)
        if not size > 0.0:
            return 0.0, 0.0
        if block[c, c] < 0.0:
            sign = -sign
        inverse = 1.0 / block[c, c]
        for r in range(c + 1, k):
            factor = block[r, c] * inverse
            block[r, c] = factor
            for b in range(c + 1, k):
                block[r, b] -= factor * block[c, b]
    return sign, (smallest / largest if k > 0 else 1.0)


@kernel
def solve(seq, fac, rhs, x):
    """J x = rhs: rhs (m,) by row of J; x (3 nb,) by coordinate, ground's entries untouched."""
    work, block, scratch = fac.work, fac.block, fac.scratch
    n = seq.kept_rows.shape[0]
    pivots, k = seq.pivot_row.shape[0], seq.block_rows.shape[0]
    b = np.empty(n)
    for r in range(n):
        b[r] = rhs[seq.kept_rows[r]]
    for p in range(pivots):
        r, c = seq.pivot_row[p], seq.pivot_column[p]
        if b[r] != 0.0:
            for a in range(seq.lower_start[p], seq.lower_start[p + 1]):
                i = seq.lower_row[a]
                b[i] -= work[i, c] * b[r]
    for a in range(k):
        total = b[seq.block_rows[fac.order[a]]]
        for c in range(a):
            total -= block[a, c] * scratch[c]
        scratch[a] = total
    for a in range(k - 1, -1, -1):
        total = scratch[a]
        for c in range(a + 1, k):
            total -= block[a, c] * scratch[c]
        scratch[a] = total / block[a, a]
        x[3 + seq.block_columns[a]] = scratch[a]
    for p in range(pivots - 1, -1, -1):
        r, c = seq.pivot_row[p], seq.pivot_column[p]
        total = b[r]
        for a in range(seq.upper_start[p], seq.upper_start[p + 1]):
            j = seq.upper_column[a]
            total -= work[r, j] * x[3 + j]
        x[3 + c] = total / work[r, c]


@kernel
def solve_transposed(seq, fac, rhs, y):
    """J^T y = rhs: rhs (3 nb,) by coordinate, overwritten; y (m,) by row of J, rows not kept get 0."""
    work, block, scratch = fac.work, fac.block, fac.scratch
    n = seq.kept_rows.shape[0]
    pivots, k = seq.pivot_row.shape[0], seq.block_rows.shape[0]
    z = np.empty(n)
    for p in range(pivots):
        r, c = seq.pivot_row[p], seq.pivot_column[p]
        z[r] = rhs[3 + c] / work[r, c]
        for a in range(seq.upper_start[p], seq.upper_start[p + 1]):
            j = seq.upper_column[a]
            rhs[3 + j] -= work[r, j] * z[r]
    for a in range(k):
        total = rhs[3 + seq.block_columns[a]]
        for c in range(a):
            total -= block[c, a] * scratch[c]
        scratch[a] = total / block[a, a]
    for a in range(k - 1, -1, -1):
        total = scratch[a]
        for c in range(a + 1, k):
            total -= block[c, a] * scratch[c]
        scratch[a] = total
        z[seq.block_rows[fac.order[a]]] = total
    for p in range(pivots - 1, -1, -1):
        r, c = seq.pivot_row[p], seq.pivot_column[p]
        for a in range(seq.lower_start[p], seq.lower_start[p + 1]):
            z[r] -= work[seq.lower_row[a], c] * z[seq.lower_row[a]]
    for r in range(y.shape[0]):
        y[r] = 0.0
    for r in range(n):
        y[seq.kept_rows[r]] = z[r]
