"""Linear complementarity by Lemke's method: z >= 0, w = M z + q >= 0, z w = 0.

Ties of the ratio test are broken lexicographically, so that it cannot cycle.
Source: Cottle, Pang, Stone, The Linear Complementarity Problem, ch. 4.4 and 4.9.
"""

from __future__ import annotations

import numpy as np

GONE = 1e-13
"""Part of the largest number below which the artificial variable is zero; it may stay where forces share a load."""
SMALL = 1e-11
"""Pivots below this are none; M and q are of order 1."""


def lemke(matrix: np.ndarray, q: np.ndarray) -> np.ndarray | None:
    """z (n,) for M (n, n) and q (n,), both scaled to order 1; None where Lemke's method finds no solution."""
    n = len(q)
    if (q >= 0.0).all():
        return np.zeros(n)
    tableau = np.hstack([np.eye(n), -matrix, -np.ones((n, 1)), q[:, None]])
    basis = list(range(n))
    row, entering = int(np.argmin(q)), 2 * n
    for _ in range(50 * (n + 1)):
        tableau[row] /= tableau[row, entering]
        others = np.arange(n) != row
        tableau[others] -= np.outer(tableau[others, entering], tableau[row])
        leaving, basis[row] = basis[row], entering
        if leaving == 2 * n or tableau[basis.index(2 * n), -1] <= GONE * float(np.abs(tableau[:, -1]).max()):
            out = np.zeros(2 * n + 1)
            out[basis] = tableau[:, -1]
            return np.maximum(out[n : 2 * n], 0.0)
        entering = leaving + n if leaving < n else leaving - n
        chosen = _leaving_row(tableau, basis, entering)
        if chosen is None:
            return None
        row = chosen
    return None


def _leaving_row(tableau: np.ndarray, basis: list[int], entering: int) -> int | None:
    n = len(basis)
    rows = np.flatnonzero(tableau[:, entering] > SMALL)
    if not len(rows):
        return None
    for column in (2 * n + 1, *range(n)):
        ratio = tableau[rows, column] / tableau[rows, entering]
        rows = rows[ratio <= ratio.min() + 1e-14 * max(1.0, abs(ratio.min()))]
        artificial = [int(row) for row in rows if basis[row] == 2 * n]
        if column == 2 * n + 1 and artificial:
            return artificial[0]
        if len(rows) == 1:
            break
    return int(rows[0])
