"""The smallest part of their limits with which contacts that stick and joints at rest hold each other.

    minimise s   with   |T_k| <= s (mu_k N_k + L_k),   N >= 0,   G (N, T) = G (N, T)_raw

by the programmes of holding.py, each with the s and the limits that the one before gave: Dinkelbach's method. It ends
where d is zero. That s no longer changes is not enough: limits of contacts that did not push before weigh next to
nothing, and hold s where it is while d < 0 lets them push. Where that comes to no end, s is looked for between bounds.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import internal, kernel
from mbsd.dynamics.events.laws.holding import hold, holding_of

PASSES_TOGETHER, AGREED_TOGETHER = 30, 1e-11
"""Passes in which contacts and joints that hold together agree on their limits, at most; what may still change."""
PASSES_BETWEEN = 100
"""The same where they are looked for between bounds."""
MOST_PUSH = 10.0
"""Times all normal forces before, and what loads ask for, that they may be after they are divided: where bodies wedge
the least part of their limits belongs to infinite ones."""
WEAKEST = 1e-9
"""Part of the largest limit that each has at least, where limits are weights."""

PULLED = 1e300
"""Part where contacts would have to pull."""
NOTHING = 1e-14
"""Part of the largest force that is rounding."""
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
    """Return scratch for n normal forces and ways."""
    number, whole = np.zeros((WEIGHT + 1, n)), np.zeros((2, n), np.int64)
    compliance, pick, table, picked = np.zeros((4, n, n))
    return Together(compliance, number, whole[0], pick, whole[1], table, picked, holding_of(0, n))


@internal
def _hold(work, m, c, k, part, most):
    """Solve one programme with number[WEIGHT], of m rows; see hold."""
    number = work.number
    return hold(
        work.table[:m, : c + k],
        number[BALANCE, :m],
        work.picked[:k, :c],
        number[SCALED, :k],
        number[WEIGHT, :k],
        part,
        most,
        work.holding,
        number[FORCE, : c + k],
    )


@internal
def _allowed(work, c, w):
    """Return the largest friction of way w under number[FORCE]."""
    out = work.number[SCALED, w]
    for j in range(c):
        out += work.picked[w, j] * max(work.number[FORCE, j], 0.0)
    return out


@internal
def _part_of(work, c, k):
    """Return the part that number[FORCE] needs."""
    part = 0.0
    largest = 1.0
    for j in range(c + k):
        largest = max(largest, abs(work.number[FORCE, j]))
    for w in range(k):
        along = abs(work.number[FORCE, c + w])
        if along > NOTHING * largest:  # a contact that does not push has no friction but rounding
            part = max(part, along / max(_allowed(work, c, w), WEAKEST * WEAKEST))
    return min(part, LARGE)


@internal
def _repeated(work, m, c, k, part, most):
    """Return the least part by programmes that weigh limits as the one before left them; -1 without an end."""
    number = work.number
    for _ in range(PASSES_TOGETHER):
        largest = 0.0
        for w in range(k):
            number[WEIGHT, w] = _allowed(work, c, w)
            largest = max(largest, number[WEIGHT, w])
        if not largest > WEAKEST:
            return -1.0
        for w in range(k):
            number[WEIGHT, w] = max(number[WEIGHT, w], WEAKEST * largest + WEAKEST * WEAKEST)
        less = _hold(work, m, c, k, part, most)
        if less == math.inf:
            return -1.0
        last = part
        part = _part_of(work, c, k)
        if less >= -AGREED_TOGETHER and abs(part - last) <= AGREED_TOGETHER * max(part, 1.0):
            return part
    return -1.0


@internal
def _between(work, m, c, k, most):
    """Return the least part between one with d > 0 and one with d <= 0, all limits weighed alike; PULLED: none.

    By Newton's method, -dd/ds is the sum of what friction may be times the prices of these limits; else by halves.
    """
    number = work.number
    prices = work.holding.table[m + k + 1]
    low = 0.0
    high = LARGE
    part = 1.0
    for w in range(k):
        number[WEIGHT, w] = 1.0
    for _ in range(PASSES_BETWEEN):
        less = _hold(work, m, c, k, part, most)
        if less == math.inf:
            return PULLED
        if less > 0.0:
            low = part
        else:
            high = part
        high = min(high, _part_of(work, c, k))
        if abs(less) <= AGREED_TOGETHER or high - low <= AGREED_TOGETHER * max(high, 1.0) or high <= 1.0 / LARGE:
            break
        slope = 0.0
        for w in range(k):
            slope += max(prices[c + 2 * k + 2 + w], 0.0) * _allowed(work, c, w)
        part += less / max(slope, WEAKEST * WEAKEST)
        if not low < part < high:
            part = 0.5 * (low + high) if high < LARGE else 4.0 * max(low, 1.0)
        part = min(part, LARGE)
    _hold(work, m, c, k, high, most)
    return _part_of(work, c, k)


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
    most = 1.0
    for j in range(c):
        most += abs(number[FORCE, j])
    part = _repeated(work, m, c, k, min(max(part, 1.0 / LARGE), LARGE), MOST_PUSH * most)
    if part < 0.0:
        part = _between(work, m, c, k, MOST_PUSH * most)
    for j in range(n):
        number[FORCE, j] *= number[SCALED_UNIT, j]
    return part
