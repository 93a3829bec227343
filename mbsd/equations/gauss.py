"""Compiled: small dense systems of linear equations by Gaussian elimination with row pivoting."""

from __future__ import annotations

from mbsd.compiling.jit import internal


@internal
def eliminate(matrix, side):
    """Replace side (n, c) by the solution of matrix (n, n), which is overwritten."""
    size = matrix.shape[0]
    count = side.shape[1]
    for k in range(size):
        best = k
        for i in range(k + 1, size):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            for c in range(k, size):
                matrix[k, c], matrix[best, c] = matrix[best, c], matrix[k, c]
            for c in range(count):
                side[k, c], side[best, c] = side[best, c], side[k, c]
        for i in range(k + 1, size):
            part = matrix[i, k] / matrix[k, k]
            if part != 0.0:
                for c in range(k + 1, size):
                    matrix[i, c] -= part * matrix[k, c]
                for c in range(count):
                    side[i, c] -= part * side[k, c]
    for k in range(size - 1, -1, -1):
        for i in range(k + 1, size):
            part = matrix[k, i]
            for c in range(count):
                side[k, c] -= part * side[i, c]
        for c in range(count):
            side[k, c] /= matrix[k, k]
