"""Full matrices of implicit methods, solved by Gaussian elimination with row pivoting (LU), in place.

    P K = L U,   K x = b

Source: Golub, Van Loan, Matrix Computations, 3.4.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import internal


class FullMatrices(NamedTuple):
    """Room for k matrices of size N with their right-hand sides."""

    value: Any
    """(k, N, N)"""
    pivot: Any
    """(k, N) row exchanged with each row."""
    side: Any
    """(k, N) right-hand sides, then solutions."""


def full_matrices(count: int, size: int) -> FullMatrices:
    """Room for ``count`` matrices of ``size`` rows."""
    return FullMatrices(np.zeros((count, size, size)), np.zeros((count, size), np.int64), np.zeros((count, size)))


@internal
def factor_full(full, k, size):
    """Factor the first ``size`` rows and columns of matrix k; a singular one leaves numbers that are not finite."""
    value = full.value[k]
    pivot = full.pivot[k]
    for j in range(size):
        best = j
        for i in range(j + 1, size):
            if abs(value[i, j]) > abs(value[best, j]):
                best = i
        pivot[j] = best
        if best != j:
            for c in range(size):
                kept = value[j, c]
                value[j, c] = value[best, c]
                value[best, c] = kept
        inverse = 1.0 / value[j, j]
        for i in range(j + 1, size):
            part = value[i, j]
            if part != 0.0:
                part *= inverse
                value[i, j] = part
                for c in range(j + 1, size):
                    value[i, c] -= part * value[j, c]


@internal
def solve_full(full, k, size):
    """side[k] becomes the solution with factored matrix k."""
    value = full.value[k]
    x = full.side[k]
    for j in range(size):
        i = full.pivot[k, j]
        if i != j:
            kept = x[j]
            x[j] = x[i]
            x[i] = kept
    for i in range(1, size):
        total = x[i]
        for c in range(i):
            total -= value[i, c] * x[c]
        x[i] = total
    for i in range(size - 1, -1, -1):
        total = x[i]
        for c in range(i + 1, size):
            total -= value[i, c] * x[c]
        x[i] = total / value[i, i]
