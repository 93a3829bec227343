"""Linear solves with the constraint Jacobian by a fixed elimination sequence found once per mechanism.

Most entries of J in reference coordinates are constants (+-1 on the coordinates of a body). Pivots on them never
vanish, so they are taken first, in Markowitz order; what is left is a small dense block in which rows are pivoted
at run time. For a four-bar 9 x 9 becomes 2 x 2. Exact LU, nothing is approximated.

J falls apart into irreducible diagonal blocks: a driven body, an Assur group. Pivots are taken within them, so the
dense block is upper triangular by blocks too, and each of them has a determinant of its own. The sign of each is
followed from pose to pose: two groups that change sides at once leave the sign of det J as it was.

Rows and columns are renumbered so that pivot k stands at (k, k), and pivot rows are scaled to a pivot of 1. The
numeric work is then flat loops over index triples:

    factor    w[target] -= w[lower] * w[upper]
    solve     y[i] -= L y[k] forward;  dense block;  y[k] -= U y[j] backward

Multipliers of a large mechanism follow from the same factors, whose steps are taken backwards, each with its two
positions exchanged. A dense solve takes n^3, this one as many operations as J has nonzeros and fill.

    J = P^T S^-1 L B U Q   =>   J^T lam = f,   lam = P^T S L^-T B^-T U^-T Q f

Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 6 (block triangular form), 7 (Markowitz) and 9 (a
fixed pivot sequence).
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.running import Kept
from mbsd.compiling.jit import inlined, kernel

MOST_SAMPLED = 20_000
"""Numbers of sampled Jacobians by which a sequence is kept; more take longer to hash than to compare."""
INDEX = np.uint32
"""Unsigned, so that compiled indexing need not look for negative numbers."""


class Elimination(NamedTuple):
    """The sequence, as constant arrays; n unknowns, p constant pivots, k = n - p in the dense block."""

    rows: Any
    """(n,) row of J at each position; rows of J that are not here repeat the others."""
    columns: Any
    """(n,) coordinate at each position, ground's three counted."""
    scale: Any
    """(n,) factor of each row: one over its constant pivot, 1 in the block."""
    read: Any
    """(r, 3): value, row and column of the compact J: entries copied before each factorisation."""
    read_scale: Any
    """(r,)"""
    cleared: Any
    """(f,) values that start at zero: fill."""
    update: Any
    """(u, 3) value target -= value lower * value upper."""
    lower: Any
    """(l, 3) value, position it changes, pivot."""
    upper: Any
    """(u, 3) value, pivot, position it multiplies."""
    block: Any
    """(k, k) values; 0 is the value that is always zero."""
    ends: Any
    """(d,) where each diagonal block of the dense block ends."""


class Factors(NamedTuple):
    """The factors of one Jacobian, overwritten by the next."""

    values: Any
    """(e,) nonzeros; the first is always zero."""
    block: Any
    """(k, k)"""
    order: Any
    """(k,) row order of the block."""
    mixed: Any
    """(k, 2) scratch."""
    side: Any
    """(n, 2) right-hand sides, then the solutions, by position."""
    determinant: Any
    """(d,) of each diagonal block of the dense block, up to a constant factor."""


def plan(
    samples: np.ndarray, kept_rows: np.ndarray, row_body: np.ndarray, width: int = 3
) -> tuple[Elimination, Factors]:
    """Find the sequence from Jacobians (s, m, n) at s unrelated poses; equal entries are constant.

    ``row_body`` (m, k): the bodies of each row, to find an entry in the compact J (m, k width), where a body has
    ``width`` velocities: 3 in the plane, 6 in space.
    """
    rows, bodies = np.asarray(kept_rows, np.int64), np.asarray(row_body, np.int64)

    def found() -> tuple[Elimination, np.ndarray]:
        matrices = samples[:, rows, :]
        own = np.any(matrices != 0.0, axis=0)
        constant = own & np.all(matrices == matrices[0], axis=0)
        value = np.where(constant, matrices[0], 0.0)
        return _planned(
            own.tobytes(), constant.tobytes(), value.tobytes(), rows.tobytes(), bodies.tobytes(), bodies.shape, width
        )

    if samples.size > MOST_SAMPLED:
        kept, values = found()
    else:
        kept, values = _PLANS.get((samples.tobytes(), rows.tobytes(), bodies.tobytes(), bodies.shape, width), found)
    sequence = Elimination(*(array.copy() for array in kept))
    n, size = len(sequence.rows), len(sequence.block)
    return sequence, Factors(
        values.copy(),
        np.zeros((size, size)),
        np.zeros(size, np.int64),
        np.zeros((size, 2)),
        np.zeros((n, 2)),
        np.zeros(len(sequence.ends)),
    )


_PLANS: Kept[tuple[Elimination, np.ndarray]] = Kept()
"""Eliminations by the samples themselves, which is quicker than to find what is constant in them."""


@lru_cache(maxsize=64)
def _planned(
    own_bytes: bytes, constant_bytes: bytes, value_bytes: bytes, rows_bytes: bytes, bodies_bytes: bytes,
    bodies_shape: tuple[int, ...], width: int,
) -> tuple[Elimination, np.ndarray]:  # fmt: skip
    """Return the sequence and values of its constants, from J's pattern and constant entries alone.

    They are kept for the next call, so nobody writes into them.
    """
    kept_rows = np.frombuffer(rows_bytes, np.int64)
    row_body = np.frombuffer(bodies_bytes, np.int64).reshape(bodies_shape)
    n = len(kept_rows)
    own, constant = (np.frombuffer(part, bool).reshape(n, n) for part in (own_bytes, constant_bytes))
    value, constant = np.frombuffer(value_bytes).reshape(n, n).copy(), constant.copy()
    fixed_value, changed = value.copy(), np.zeros((n, n), bool)
    own_constant = constant.copy()
    pattern = own.copy()
    row_part, column_part = irreducible_parts(own)
    same_part = row_part[:, None] == column_part
    open_rows, open_columns = np.ones(n, bool), np.ones(n, bool)
    pivots: list[tuple[int, int, float]] = []
    steps: list[tuple[np.ndarray, np.ndarray]] = []
    while True:
        usable = constant & same_part & (np.abs(value) > 1e-9)
        cheapest = _cheapest_pivot(pattern, usable, open_rows, open_columns)
        if cheapest is None:
            break
        r, c = cheapest
        open_rows[r], open_columns[c] = False, False
        targets = np.flatnonzero(pattern[:, c] & open_rows)
        others = np.flatnonzero(pattern[r] & open_columns)
        for i in targets:
            value[i, others] -= value[i, c] / value[r, c] * value[r, others]
            constant[i, others] = (constant[i, others] | ~pattern[i, others]) & constant[i, c] & constant[r, others]
            pattern[i, others] = True
            changed[i, others] = True
        pivots.append((r, c, value[r, c]))
        steps.append((targets, others))

    left_rows, left_columns = _by_part(open_rows, row_part), _by_part(open_columns, column_part)
    row_order = [r for r, _, _ in pivots] + list(left_rows)
    column_order = [c for _, c, _ in pivots] + list(left_columns)
    scale = np.array([1.0 / pivot for _, _, pivot in pivots] + [1.0] * int(open_rows.sum()))
    scale_of = dict(zip(row_order, scale, strict=True))
    at_row = {int(r): k for k, r in enumerate(row_order)}
    at_column = {int(c): k for k, c in enumerate(column_order)}
    slot = {(int(r), int(c)): k + 1 for k, (r, c) in enumerate(zip(*np.nonzero(pattern), strict=True))}

    values = np.zeros(len(slot) + 1)
    read, read_scale, cleared = [], [], []
    for (r, c), k in slot.items():
        if own_constant[r, c] and not changed[r, c]:
            values[k] = fixed_value[r, c] * scale_of[r]
        elif own[r, c]:
            row = int(kept_rows[r])
            side = int(np.flatnonzero(row_body[row] == c // width + 1)[0])
            read.append((k, row, c % width + width * side))
            read_scale.append(scale_of[r])
        else:
            cleared.append(k)
    update, lower, upper = [], [], []
    for (r, c, _), (targets, others) in zip(pivots, steps, strict=True):
        lower += [(slot[int(i), c], at_row[int(i)], at_row[r]) for i in targets]
        upper += [(slot[r, int(j)], at_row[r], at_column[int(j)]) for j in others]
        update += [(slot[int(i), int(j)], slot[int(i), c], slot[r, int(j)]) for i in targets for j in others]
    sequence = Elimination(
        rows=np.array(kept_rows, INDEX)[np.array(row_order, INDEX)],
        columns=np.array(column_order, INDEX) + 3,
        scale=scale,
        read=_triples(read),
        read_scale=np.array(read_scale, float),
        cleared=np.array(cleared, INDEX),
        update=_triples(update),
        lower=_triples(lower),
        upper=_triples(upper),
        block=_block(slot, left_rows, left_columns),
        ends=np.flatnonzero(np.diff(row_part[left_rows], append=-1)) + 1,
    )
    return sequence, values


def irreducible_parts(pattern: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the irreducible diagonal block, (n,) numbers, of rows and columns of a pattern (n, n).

    Ordered by these numbers the matrix is upper triangular by blocks. A structurally singular one counts as one block.
    """
    from graphlib import TopologicalSorter

    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components, maximum_bipartite_matching

    n = len(pattern)
    column_of = maximum_bipartite_matching(csr_array(pattern), perm_type="column")
    if n == 0 or (column_of < 0).any():
        return np.zeros(n, np.int64), np.zeros(n, np.int64)
    count, label = connected_components(csr_array(pattern[:, column_of]), directed=True, connection="strong")
    needed_by: dict[int, set[int]] = {k: set() for k in range(count)}
    for r, c in zip(*np.nonzero(pattern[:, column_of]), strict=True):
        if label[r] != label[c]:
            needed_by[int(label[c])].add(int(label[r]))
    order = np.empty(count, np.int64)
    order[list(TopologicalSorter(needed_by).static_order())] = np.arange(count)
    rows = order[label]
    columns = np.empty(n, np.int64)
    columns[column_of] = rows
    return rows, columns


def _by_part(chosen: np.ndarray, part: np.ndarray) -> np.ndarray:
    indices = np.flatnonzero(chosen)
    return indices[np.argsort(part[indices], kind="stable")]


def _block(slot: dict[tuple[int, int], int], rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Return the slots of the square that is left, 0 where it is zero."""
    block = np.zeros((len(rows), len(columns)), INDEX)
    for a, r in enumerate(rows):
        for b, c in enumerate(columns):
            block[a, b] = slot.get((int(r), int(c)), 0)
    return block


def _triples(rows: list) -> np.ndarray:
    return np.array(rows, INDEX).reshape(-1, 3)


def _cheapest_pivot(
    pattern: np.ndarray, usable: np.ndarray, open_rows: np.ndarray, open_columns: np.ndarray
) -> tuple[int, int] | None:
    """Return the usable entry with the fewest other entries in row and column (Markowitz)."""
    active = pattern & open_rows[:, None] & open_columns[None, :]
    candidates = usable & active
    if not candidates.any():
        return None
    fill = (active.sum(1) - 1)[:, None] * (active.sum(0) - 1)[None, :]
    best = int(np.argmin(np.where(candidates, fill, np.iinfo(np.int64).max)))
    return best // pattern.shape[1], best % pattern.shape[1]


@inlined
def factorise(seq, jac, fac):
    """Factor J, compact (m, 6), and fill ``fac.determinant``.

    Returns the smallest over the largest pivot of the dense block; 0 if singular.
    """
    w = fac.values
    for e in range(seq.read.shape[0]):
        w[seq.read[e, 0]] = seq.read_scale[e] * jac[seq.read[e, 1], seq.read[e, 2]]
    for e in range(seq.cleared.shape[0]):
        w[seq.cleared[e]] = 0.0
    for e in range(seq.update.shape[0]):
        w[seq.update[e, 0]] -= w[seq.update[e, 1]] * w[seq.update[e, 2]]
    return _factorise_block(seq, fac)


@inlined
def _factorise_block(seq, fac):
    """Factorise the dense block with partial pivoting in each diagonal block (LU).

    Its diagonal keeps the inverse pivots.
    """
    block, order = fac.block, fac.order
    k = block.shape[0]
    smallest, largest = np.inf, 0.0
    for a in range(k):
        order[a] = a
        for b in range(k):
            block[a, b] = fac.values[seq.block[a, b]]
    first = 0
    for d in range(seq.ends.shape[0]):
        end = seq.ends[d]
        determinant = 1.0
        for c in range(first, end):
            best, size = c, abs(block[c, c])
            for r in range(c + 1, end):
                if abs(block[r, c]) > size:
                    best, size = r, abs(block[r, c])
            if best != c:
                determinant = -determinant
                order[c], order[best] = order[best], order[c]
                for b in range(k):
                    block[c, b], block[best, b] = block[best, b], block[c, b]
            smallest, largest = min(smallest, size), max(largest, size)
            determinant *= block[c, c]
            inverse = 1.0 / block[c, c]
            block[c, c] = inverse
            for r in range(c + 1, end):
                factor = block[r, c] * inverse
                block[r, c] = factor
                for b in range(c + 1, k):
                    block[r, b] -= factor * block[c, b]
        fac.determinant[d] = determinant
        first = end
    margin = smallest / largest if k > 0 else 1.0
    return margin if margin > 0.0 else 0.0


@inlined
def solve(seq, fac, sides, rhs, x):
    """Solve J x = rhs for the first ``sides`` (1 or 2) right-hand sides at once.

    rhs (2, m) by row of J; x (2, 3 nb) by coordinate, ground's entries untouched.
    """
    w, block, mixed, y = fac.values, fac.block, fac.mixed, fac.side
    n, k = seq.rows.shape[0], block.shape[0]
    p = n - k
    for e in range(n):
        for s in range(sides):
            y[e, s] = seq.scale[e] * rhs[s, seq.rows[e]]
    for e in range(seq.lower.shape[0]):
        for s in range(sides):
            y[seq.lower[e, 1], s] -= w[seq.lower[e, 0]] * y[seq.lower[e, 2], s]
    for a in range(k):
        for s in range(sides):
            mixed[a, s] = y[p + fac.order[a], s]
            for c in range(a):
                mixed[a, s] -= block[a, c] * mixed[c, s]
    for a in range(k - 1, -1, -1):
        for s in range(sides):
            for c in range(a + 1, k):
                mixed[a, s] -= block[a, c] * mixed[c, s]
            mixed[a, s] *= block[a, a]
            y[p + a, s] = mixed[a, s]
    for e in range(seq.upper.shape[0] - 1, -1, -1):
        for s in range(sides):
            y[seq.upper[e, 1], s] -= w[seq.upper[e, 0]] * y[seq.upper[e, 2], s]
    for e in range(n):
        for s in range(sides):
            x[s, seq.columns[e]] = y[e, s]


ALL_SOLVED = -1


@kernel
def multipliers_along(seq, fac, compact, loads, lam):
    """Fill lam (T, m) from compact J (T, m, 6) and loads (T, 3 nb), ground's three unread.

    Returns the first index at which J is singular, ``ALL_SOLVED`` if there is none.
    """
    for k in range(loads.shape[0]):
        if factorise(seq, compact[k], fac) == 0.0:
            return k
        solve_transposed(seq, fac, loads[k], lam[k])
    return ALL_SOLVED


@inlined
def solve_transposed(seq, fac, load, lam):
    """Solve J^T lam = load; load (3 nb,) by coordinate, lam (m,) by row of J."""
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
