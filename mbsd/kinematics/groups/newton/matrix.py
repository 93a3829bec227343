"""Small dense system of a block, and the travel of its bodies; tables as in groups/blocks.py."""

from __future__ import annotations

import math

from mbsd.compiling.jit import merged
from mbsd.kinematics.groups.blocks import BODIES, BODY, BODY_I, BODY_J, CARRIES
from mbsd.kinematics.groups.carried import WOUND
from mbsd.kinematics.newton import UNEXPLAINED

SINGULAR = 1e-12
"""Smallest pivot beside the largest."""


@merged
def factor(matrix, order, n):
    """Factorise matrix (n n,) by LU with row pivoting; return its determinant, 0 where it is singular."""
    determinant = 1.0
    smallest = math.inf
    largest = 0.0
    for c in range(n):
        best = c
        for r in range(c + 1, n):
            if abs(matrix[n * r + c]) > abs(matrix[n * best + c]):
                best = r
        order[c] = best
        if best != c:
            determinant = -determinant
            for b in range(n):
                matrix[n * c + b], matrix[n * best + b] = matrix[n * best + b], matrix[n * c + b]
        pivot = matrix[n * c + c]
        smallest = min(smallest, abs(pivot))
        largest = max(largest, abs(pivot))
        determinant *= pivot
        for r in range(c + 1, n):
            part = matrix[n * r + c] / pivot
            matrix[n * r + c] = part
            for b in range(c + 1, n):
                matrix[n * r + b] -= part * matrix[n * c + b]
    return determinant if smallest > SINGULAR * largest else 0.0


@merged
def solve(matrix, order, n, x):
    """Solve in place with the factors."""
    for c in range(n):
        best = int(order[c])
        x[c], x[best] = x[best], x[c]
    for c in range(n):
        for b in range(c):
            x[c] -= matrix[n * c + b] * x[b]
    for c in range(n - 1, -1, -1):
        for b in range(c + 1, n):
            x[c] -= matrix[n * c + b] * x[b]
        x[c] /= matrix[n * c + c]


@merged
def held(jac, row, rates):
    """Return rate of an equation at rates (3 nb,) of the bodies."""
    i = 3 * row[BODY_I]
    j = 3 * row[BODY_J]
    rate = 0.0
    for c in range(3):
        rate += jac[c] * rates[i + c] + jac[3 + c] * rates[j + c]
    return rate


@merged
def extent(q, last, body, per_metre):
    """Return how far a body goes, in sizes and rad; NaN counts as infinite."""
    b = 3 * body
    way = max(abs(q[b] - last[b]) * per_metre, abs(q[b + 1] - last[b + 1]) * per_metre, abs(q[b + 2] - last[b + 2]))
    return way if way == way else math.inf


@merged
def turns_too_far(head, tree, q, v, a, k, h, per_metre):
    """Return True if rates do not explain the step of a body, or a carrying one winds on.

    Rates are those at both ends.
    """
    for e in range(head[BODIES]):
        b = 3 * tree[e, BODY]
        for c in range(b, b + 3):
            way = q[k, c] - q[k - 1, c]
            gap = abs(way - 0.5 * h * (v[k, c] + v[k - 1, c]) + h * h / 12.0 * (a[k, c] - a[k - 1, c]))
            if not gap * (per_metre if c < b + 2 else 1.0) <= UNEXPLAINED:
                return True
        if head[CARRIES] and abs(q[k, b + 2] - q[k - 1, b + 2]) > WOUND:
            return True
    return False
