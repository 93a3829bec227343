"""Multipliers by the Schur complement of the masses, S = J W^-1 J^T = L D L^T, within its envelope.

Rows are ordered so that those which share a body stand near one another (reverse Cuthill and McKee); entries of L
before the first of a row of S stay zero, so a chain costs as much as it has bodies.

    L_rc D_c = S_rc - sum_k L_rk D_k L_ck,    D_r = S_rr - sum_k L_rk^2 D_k

Source: George, Liu 1981, Computer Solution of Large Sparse Positive Definite Systems, ch. 4.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import internal

OWN = 0.0025
"""Square of the part of a row that must be its own among those in use."""


class Envelope(NamedTuple):
    """The order of the rows in use, and where S has entries, as constant arrays."""

    rows: Any
    """(n,) row of J at each position."""
    first: Any
    """(n,) first position at which each row of S has an entry."""
    pair: Any
    """(p, 5) position, position not after it, column of each in the compact J, body: entries of S add up from these."""
    arm: Any
    """(a, 3) position, column in the compact J, body: parts of rows of J on moving bodies."""


class Factors(NamedTuple):
    """Factors of one pose, overwritten by the next."""

    low: Any
    """(n, n) S, then L."""
    pivot: Any
    """(n,) D."""
    side: Any
    """(2, n) right-hand sides, then solutions."""


def envelope_of(row_body: np.ndarray, kept: np.ndarray) -> tuple[Envelope, Factors]:
    """Return order and room for rows ``kept`` (n,) of J, whose bodies are row_body (m, k)."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    sides = [{int(b): 6 * s for s, b in enumerate(row_body[r]) if b > 0} for r in kept]
    meets = np.array([[bool(a.keys() & b.keys()) for b in sides] for a in sides], bool).reshape(len(kept), len(kept))
    order = reverse_cuthill_mckee(csr_array(meets), symmetric_mode=True) if len(kept) else np.zeros(0, np.int64)
    sides = [sides[k] for k in order]
    pairs, first = [], []
    for r, own in enumerate(sides):
        meeting = [c for c in range(r + 1) if own.keys() & sides[c].keys()]
        first.append(meeting[0])
        pairs += [(r, c, own[b], sides[c][b], b) for c in meeting for b in own.keys() & sides[c].keys()]
    arms = [(r, column, b) for r, own in enumerate(sides) for b, column in own.items()]
    envelope = Envelope(
        np.asarray(kept, np.int64)[order],
        np.array(first, np.int64),
        np.array(pairs, np.int64).reshape(-1, 5),
        np.array(arms, np.int64).reshape(-1, 3),
    )
    n = len(kept)
    return envelope, Factors(np.zeros((n, n)), np.zeros(n), np.zeros((2, n)))


@internal
def factor(env, fac, jac, inverse):
    """Factor S of J (m, 6 k) in body axes; returns the least part of a row that is its own."""
    low = fac.low
    for r in range(env.rows.shape[0]):
        for c in range(env.first[r], r + 1):
            low[r, c] = 0.0
    for e in range(env.pair.shape[0]):
        r = env.pair[e, 0]
        c = env.pair[e, 1]
        i = env.pair[e, 2]
        j = env.pair[e, 3]
        d = 6 * env.pair[e, 4] - 3
        row = env.rows[r]
        other = env.rows[c]
        total = 0.0
        for k in range(6):
            total += jac[row, i + k] * inverse[d + k] * jac[other, j + k]
        low[r, c] += total
    return decompose(env, fac)


@internal
def decompose(env, fac):
    """Factor S, which stands in fac.low; returns the least part of a row that is its own."""
    low = fac.low
    pivot = fac.pivot
    margin = 1.0
    for r in range(env.rows.shape[0]):
        begin = env.first[r]
        for c in range(begin, r):
            total = low[r, c]
            for k in range(max(begin, env.first[c]), c):
                total -= low[r, k] * low[c, k]  # L_rk D_k of this row, L_ck of the other, which is complete
            low[r, c] = total
        whole = low[r, r]
        left = whole
        for c in range(begin, r):
            scaled = low[r, c] / pivot[c]
            left -= scaled * low[r, c]
            low[r, c] = scaled
        pivot[r] = left
        part = left / whole
        if not part >= margin:
            margin = part
    return margin


@internal
def solve(env, fac, sides):
    """Solve S x = fac.side for the first ``sides`` right-hand sides."""
    n = env.rows.shape[0]
    for s in range(sides):
        x = fac.side[s]
        for r in range(n):
            total = x[r]
            for c in range(env.first[r], r):
                total -= fac.low[r, c] * x[c]
            x[r] = total
        for r in range(n):
            x[r] /= fac.pivot[r]
        for r in range(n - 1, -1, -1):
            for c in range(env.first[r], r):
                x[c] -= fac.low[r, c] * x[r]
