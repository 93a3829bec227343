"""The smallest part of their limits with which contacts that stick and joints at rest hold each other, compiled.

    minimise s   with   |T_k| <= s (mu_k N_k + L_k),   N >= 0,   G (N, T) = G (N, T)_raw

by the programmes of holding.py, each with the s and the limits that the one before gave: Dinkelbach's method.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import kernel
from mbsd.dynamics.events.bounds import AGREED_TOGETHER, PASSES_TOGETHER, WEAKEST
from mbsd.dynamics.events.laws.holding import hold, holding_of

PULLED = 1e300
"""Part where contacts would have to pull."""
LARGE = 1e6
"""Parts above this count as this one."""
RAW, UNIT, OWN, FORCE, SCALED_UNIT, SCALED, BALANCE, ALLOWED, WEIGHT = range(9)
"""Rows of Together.number: forces that hold in one way; what makes rates of rows dimensionless; limits L, from the
first on; forces that are found; then scratch."""


class Together(NamedTuple):
    """c normal forces, then friction of k ways; arrays for n of them at most."""

    compliance: Any
    """(n, n) accelerations of rows by forces."""
    number: Any
    """(9, n)"""
    held: Any
    """(n,) int: whether the acceleration of the row counts."""
    pick: Any
    """(n, n) friction coefficients mu of ways (rows) for normal forces (columns)."""
    row: Any
    """(n,) int, for the caller: which rows they are."""
    table: Any
    """(n, n) scratch."""
    picked: Any
    """(n, n) scratch."""
    holding: Any
    """Holding."""


def together_of(n: int) -> Together:
    """Scratch for n normal forces and ways."""
    number, whole = np.zeros((WEIGHT + 1, n)), np.zeros((2, n), np.int64)
    compliance, pick, table, picked = np.zeros((4, n, n))
    return Together(compliance, number, whole[0], pick, whole[1], table, picked, holding_of(0, n))


@kernel
def least_part(work, c, k, part):
    """Fill number[FORCE] with N and T; returns the smallest part s, PULLED where no N >= 0 holds.

    ``part``: a guess of s.
    """
    number = work.number
    g = work.table
    n = c + k
    m = 0
    largest = 0.0
    for i in range(n):
        if work.held[i] != 0:
            for j in range(n):
                g[m, j] = work.compliance[i, j] * number[UNIT, i] * number[UNIT, j]
                largest = max(largest, abs(g[m, j]))
            m += 1
    scale = 0.0
    for i in range(m):
        number[BALANCE, i] = 0.0
        for j in range(n):
            g[i, j] /= largest
            number[BALANCE, i] += g[i, j] * number[RAW, j] / number[UNIT, j]
        scale = max(scale, abs(number[BALANCE, i]))
    for j in range(n):
        number[FORCE, j] = 0.0
    if not scale > 0.0:
        return 0.0
    for i in range(m):
        number[BALANCE, i] /= scale
    for j in range(n):
        number[SCALED_UNIT, j] = number[UNIT, j] * scale
        number[FORCE, j] = number[RAW, j] / number[SCALED_UNIT, j]
    for w in range(k):
        unit = number[SCALED_UNIT, c + w]
        number[SCALED, w] = number[OWN, w] / unit
        for j in range(c):
            work.picked[w, j] = work.pick[w, j] * number[SCALED_UNIT, j] / unit
    part = min(max(part, 1.0 / LARGE), LARGE)
    holds = True
    for _ in range(PASSES_TOGETHER):
        most = 0.0
        for w in range(k):
            number[WEIGHT, w] = number[SCALED, w]
            for j in range(c):
                number[WEIGHT, w] += work.picked[w, j] * max(number[FORCE, j], 0.0)
            most = max(most, number[WEIGHT, w])
        for w in range(k):
            number[WEIGHT, w] = max(number[WEIGHT, w], WEAKEST * most + WEAKEST * WEAKEST)
        holds = hold(
            g[:m, :n],
            number[BALANCE, :m],
            work.picked[:k, :c],
            number[SCALED, :k],
            number[WEIGHT, :k],
            part,
            work.holding,
            number[FORCE, :n],
        )
        if not holds:
            break
        last = part
        part = 0.0
        for w in range(k):
            allowed = number[SCALED, w]
            for j in range(c):
                allowed += work.picked[w, j] * number[FORCE, j]
            part = max(part, abs(number[FORCE, c + w]) / max(allowed, WEAKEST * WEAKEST))
        part = min(part, LARGE)
        if abs(part - last) <= AGREED_TOGETHER * max(part, 1.0):
            break
    for j in range(n):
        number[FORCE, j] *= number[SCALED_UNIT, j]
    return part if holds else PULLED
