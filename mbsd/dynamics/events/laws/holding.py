"""Forces with which contacts that stick and joints at rest hold each other: a linear programme.

Contacts push with N >= 0, ways at rest are held by T, and all together keep rows of J from moving, G (N, T) = b. Many
N and T do; of those the ones are chosen that ask for the smallest part s of what Coulomb's law allows,

    minimise s   with   |T_k| <= s (mu_k N_k + L_k),   N >= 0

L_k: limit of a joint. As s multiplies N, it is found by linear programmes, each with an s that is known and limits w_k
of the solution before:

    minimise d   with   |T_k| <= s (mu_k N_k + L_k) + d w_k,   N >= 0,   sum N <= most

by the simplex method; ``most`` is there where bodies wedge, as then the more contacts push the smaller d is. Bodies at
rest can stay so as long as s <= 1; without any such N the contacts would have to pull.

Source: Crouzeix, Ferland, Schaible 1985, J. Optim. Theory Appl. 47 (Dinkelbach's method for several ratios); Chvatal,
Linear Programming, ch. 8, with Bland's rule.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import internal, kernel
from mbsd.dynamics.events.laws.complementarity import pivot

PIVOT = 1e-10
"""Entries up to this are no pivots; the table is of order one."""
PULLS = 1e-9
"""Part of the forces that N >= 0 may leave without balance."""


class Holding(NamedTuple):
    """Scratch for c normal forces and k ways at rest."""

    table: Any
    """(c + 2 k + 3, 2 c + 4 k + 4) rows: those held, limits, most, the objective, what lacks of balance; last column:
    b."""
    basis: Any
    """(c + 2 k + 1,) int, columns that are not zero"""


def holding_of(c: int, k: int) -> Holding:
    """Return scratch for c normal forces and k ways at rest, or for fewer of the first and more of the others."""
    return Holding(np.zeros((c + 2 * k + 3, 2 * c + 4 * k + 4)), np.zeros(c + 2 * k + 1, np.int64))


@internal
def _pivot(table, basis, rows, last, row, column):
    """Let ``column`` be of the basis in ``row``; two rows behind ``rows`` are objectives."""
    pivot(table, rows + 2, last, row, column)
    basis[row] = column


@internal
def _lower(table, basis, rows, columns, last, objective):
    """Lower the objective in a row of the table by Bland's rule, with columns before ``columns``."""
    for _ in range(50 * (rows + columns)):
        column = -1
        for j in range(columns):
            if table[objective, j] < -PIVOT:
                column = j
                break
        if column < 0:
            return
        row = -1
        least = 0.0
        for i in range(rows):
            if table[i, column] > PIVOT:
                ratio = max(table[i, last], 0.0) / table[i, column]
                if row < 0 or ratio < least or (ratio == least and basis[i] < basis[row]):
                    row = i
                    least = ratio
        if row < 0:
            return
        _pivot(table, basis, rows, last, row, column)


@internal
def _fill(work, compliance, balance, pick, limit, weight, part, most):
    """Fill the table; returns numbers of rows, of columns that are no artificial ones, and of all columns."""
    table = work.table
    m, n = compliance.shape
    k, c = pick.shape
    columns = c + 3 * k + 3
    last = columns + m
    for i in range(m + k + 3):
        for j in range(last + 1):
            table[i, j] = 0.0
    for i in range(m):
        sign = 1.0 if balance[i] >= 0.0 else -1.0
        for j in range(n):
            table[i, j] = sign * compliance[i, j]
            if j >= c:
                table[i, j + k] = -table[i, j]
        table[i, columns + i] = 1.0
        table[i, last] = sign * balance[i]
        work.basis[i] = columns + i
        for j in range(columns):
            table[m + k + 2, j] -= table[i, j]
        table[m + k + 2, last] -= table[i, last]
    for w in range(k):
        i = m + w
        for j in range(c):
            table[i, j] = -part * pick[w, j]
        table[i, c + w] = 1.0
        table[i, c + k + w] = 1.0
        table[i, c + 2 * k] = -weight[w]
        table[i, c + 2 * k + 1] = weight[w]
        table[i, c + 2 * k + 2 + w] = 1.0
        table[i, last] = part * limit[w]
        work.basis[i] = c + 2 * k + 2 + w
    for j in range(c):
        table[m + k, j] = 1.0
    table[m + k, columns - 1] = 1.0
    table[m + k, last] = most
    work.basis[m + k] = columns - 1
    table[m + k + 1, c + 2 * k] = 1.0
    table[m + k + 1, c + 2 * k + 1] = -1.0
    return m + k + 1, columns, last


@kernel
def hold(compliance, balance, pick, limit, weight, part, most, work, force):
    """Fill force (c + k,) with N and T that hold; returns d, infinite where there are none, but what lacks least.

    ``compliance`` (m, c + k) of the m rows that hold, ``balance`` (m,) = b, both of order one; ``pick`` (k, c) and
    ``limit`` (k,): what friction may be is pick N + limit; ``weight`` (k,) is w, ``part`` is s.
    """
    k, c = pick.shape
    rows, columns, last = _fill(work, compliance, balance, pick, limit, weight, part, most)
    table = work.table
    basis = work.basis
    largest = 0.0
    for i in range(rows - k - 1):
        largest = max(largest, abs(balance[i]))
    _lower(table, basis, rows, columns, last, rows + 1)
    holds = -table[rows + 1, last] <= PULLS * largest
    for i in range(rows):  # artificial columns that are zero leave the basis
        if holds and basis[i] >= columns:
            best = -1
            for j in range(columns):
                if abs(table[i, j]) > PIVOT and (best < 0 or abs(table[i, j]) > abs(table[i, best])):
                    best = j
            if best >= 0:
                _pivot(table, basis, rows, last, i, best)
    if holds:
        _lower(table, basis, rows, columns, last, rows)
    for j in range(c + k):
        force[j] = 0.0
    for i in range(rows):
        j = basis[i]
        value = max(table[i, last], 0.0)
        if j < c + k:
            force[j] += value
        elif j < c + 2 * k:
            force[j - k] -= value
    return -table[rows, last] if holds else math.inf
