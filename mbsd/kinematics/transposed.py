"""Multipliers of a large mechanism: J^T lam = f solved with the elimination sequence of J.

    J = P^T S^-1 L B U Q   =>   lam = P^T S L^-T B^-T U^-T Q f

The factors are those with which Newton-Raphson solves J x = b (elimination.py); their steps are taken backwards, each
with its two positions exchanged. A dense solve takes n^3, this one as many operations as J has nonzeros and fill.
Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 9.
"""

from __future__ import annotations

from mbsd.compiling.jit import inlined, kernel
from mbsd.kinematics.elimination import factorise

ALL_SOLVED = -1


@kernel
def multipliers_along(seq, fac, compact, loads, lam):
    """Fill lam (T, m) from compact J (T, m, 6) and loads (T, 3 nb), ground's three unread.

    Returns the first index at which J is singular, ``ALL_SOLVED`` if there is none.
    """
    for k in range(loads.shape[0]):
        if factorise(seq, compact[k], fac) == 0.0:
            return k
        _solve_transposed(seq, fac, loads[k], lam[k])
    return ALL_SOLVED


@inlined
def _solve_transposed(seq, fac, load, lam):
    """J^T lam = load; load (3 nb,) by coordinate, lam (m,) by row of J."""
    w, block, mixed, y = fac.values, fac.block, fac.mixed, fac.side
    n, size = seq.rows.shape[0], block.shape[0]
    p = n - size
    for e in range(n):
        y[e, 0] = load[seq.columns[e]]
    for e in range(seq.upper.shape[0]):
        y[seq.upper[e, 2], 0] -= w[seq.upper[e, 0]] * y[seq.upper[e, 1], 0]
    for a in range(size):  # the diagonal keeps inverse pivots
        total = y[p + a, 0]
        for c in range(a):
            total -= block[c, a] * mixed[c, 0]
        mixed[a, 0] = total * block[a, a]
    for a in range(size - 1, -1, -1):
        for c in range(a + 1, size):
            mixed[a, 0] -= block[c, a] * mixed[c, 0]
        y[p + fac.order[a], 0] = mixed[a, 0]
    for e in range(seq.lower.shape[0] - 1, -1, -1):
        y[seq.lower[e, 2], 0] -= w[seq.lower[e, 0]] * y[seq.lower[e, 1], 0]
    for e in range(n):
        lam[seq.rows[e]] = seq.scale[e] * y[e, 0]
