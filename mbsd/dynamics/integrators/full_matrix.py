"""Full matrices of implicit methods: how accelerations change with the state, and elimination with row pivoting.

    A = da/dq,   B = da/dv,      a(t, q, v) with the multipliers eliminated, by forward differences
    P K = L U,   K x = b         in place

Loads of every kind, functions of the user too, and the turning of joints are in A and B. They cost two evaluations for
each coordinate; Newton's method needs no more than a few digits of them.

Source: Golub, Van Loan, Matrix Computations, 3.4.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart, internal
from mbsd.dynamics.formulation import derivative, shift
from mbsd.dynamics.reference.arrays import Dynamics

ROOT = 1.5e-8
"""Square root of the rounding of doubles: the step of a difference, in sizes, rad, or parts of a velocity."""
MANY = 600
"""Coordinates beyond which full matrices are refused: one factorisation takes a tenth of a second there."""


def too_large(dynamics: Dynamics) -> str | None:
    """Return why an implicit method with full matrices cannot simulate this mechanism, or None."""
    count = len(dynamics.inertia) - 3
    if count <= MANY:
        return None
    return (
        f"{count // 3} bodies are too many for a method with full matrices (up to {MANY // 3}); "
        "take method='dop853', or 'scipy-lsoda' for stiff forces"
    )


@apart
def differentiate(dyn, scratch, t, y, a, trial, out):
    """Fill scratch.full.value[0] with A and [1] with B (n, n) at y (2, 3 nb), where the acceleration is a (3 nb,).

    ``trial`` and ``out`` (2, 3 nb) are scratch. Returns the number of evaluations.
    """
    n3 = y.shape[1]
    for part in range(2):
        for c in range(3, n3):
            trial[part, c] = y[part, c]
    for part in range(2):
        matrix = scratch.full.value[part]
        for c in range(3, n3):
            size = 1.0 / dyn.per_size[c]
            if part == 1 or c % 3 != 2:
                size = max(size, abs(y[part, c]))
            if part == 0:
                step = shift(dyn, y[0], c, ROOT * size, trial[0])
            else:
                trial[1, c] = y[1, c] + ROOT * size
                step = trial[1, c] - y[1, c]
            derivative(dyn, scratch, t, trial, out, scratch.ws.right[1])
            for i in range(3, n3):
                trial[part, i] = y[part, i]
            for r in range(3, n3):
                matrix[r - 3, c - 3] = (out[1, r] - a[r]) / step
    return 2 * (n3 - 3)


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
