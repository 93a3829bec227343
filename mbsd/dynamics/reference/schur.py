"""Multipliers by the Schur complement of the masses, factored along a fixed sequence found once per mechanism.

    S = J W^-1 J^T,   S lam = right,   S = L D L^T

W is the diagonal of the inertias. Rows of J are taken in blocks of two (both rows of a pin; a single row is padded
with an identity row), so that every number of the sequence is a 2 x 2 block. Two blocks meet in S where they share a
moving body: S has the pattern of the mechanism's graph, and eliminating blocks of few neighbours first (minimum
degree) keeps the fill, and the cost, proportional to the number of bodies of chains, trees and ladders of loops.

    factor   D_k^-1,  L_ik = S_ik D_k^-1,  S_ij -= L_ik S_jk^T
    solve    y_i -= L_ik y_k forward;  y_k = D_k^-1 y_k;  y_k -= L_ik^T y_i backward

Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 7 (minimum degree); Haug 1989, ch. 6 (the system).
"""

from __future__ import annotations

import heapq
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.running import Kept
from mbsd.compiling.jit import inlined

INDEX = np.uint32
"""Unsigned, so that compiled indexing need not look for negative numbers."""


class Schur(NamedTuple):
    """The sequence, as constant arrays; B blocks in the order of elimination, two arms each (first and second body)."""

    rows: Any
    """(B, 2) int rows of J; -1 where a block is padded, or a row is released."""
    bodies: Any
    """(B, 2) first and second body."""
    product: Any
    """(p, 3) slot += arm (2 x 3) times weighted arm (3 x 2)."""
    lower: Any
    """(l, 2) slot of L, block it changes; sorted by pivot."""
    first_lower: Any
    """(B + 1,)"""
    update: Any
    """(u, 3) slot target -= L of slot times (S of slot) transposed; sorted by pivot."""
    first_update: Any
    """(B + 1,)"""
    pins: Any
    """(B, 2) markers, if all blocks are pins and there are many (pins.py); else (0, 2)."""


class SchurFactors(NamedTuple):
    """Factors of one pose, overwritten by the next."""

    arm: Any
    """(2 B, 6) rows of J of a block on one body."""
    weighted: Any
    """(2 B, 6) the same times W^-1."""
    value: Any
    """(s, 4) S, then with D^-1 in the first B slots."""
    low: Any
    """(s, 4) L; the first B hold the diagonal of S before (0, 3) and what elimination leaves of it (1, 2)."""
    side: Any
    """(B, 2, 2) right-hand sides, then solutions: block, row, side."""


def schur_factors(sequence: Schur) -> SchurFactors:
    """Scratch for one thread."""
    count = len(sequence.rows)
    slots = count + len(sequence.lower)
    return SchurFactors(
        np.zeros((2 * count, 6)),
        np.zeros((2 * count, 6)),
        np.zeros((slots, 4)),
        np.zeros((slots, 4)),
        np.zeros((count, 2, 2)),
    )


@inlined
def padded(schur, k):
    """Return True if a block has no row, like that of an open contact: nothing of S meets it."""
    return schur.rows[k, 0] < 0 and schur.rows[k, 1] < 0


@inlined
def eliminate(schur, fac):
    """Factor S, which stands in fac.value and its diagonal in fac.low; returns as factor_schur."""
    value = fac.value
    low = fac.low
    count = schur.rows.shape[0]
    margin = 1.0
    for k in range(count):
        if padded(schur, k):
            low[k, 1] = 1.0
            low[k, 2] = 1.0
            continue
        cross = 0.5 * (value[k, 1] + value[k, 2])
        det = value[k, 0] * value[k, 3] - cross * cross
        low[k, 1] = value[k, 0] / low[k, 0]
        low[k, 2] = det / value[k, 0] / low[k, 3]
        left = low[k, 1] * low[k, 2]
        if not left >= margin:
            margin = left
        inverse_det = 1.0 / det
        d0 = value[k, 3] * inverse_det
        d1 = -cross * inverse_det
        d3 = value[k, 0] * inverse_det
        value[k, 0] = d0
        value[k, 1] = d1
        value[k, 2] = d1
        value[k, 3] = d3
        for e in range(schur.first_lower[k], schur.first_lower[k + 1]):
            s = schur.lower[e, 0]
            low[s, 0] = value[s, 0] * d0 + value[s, 1] * d1
            low[s, 1] = value[s, 0] * d1 + value[s, 1] * d3
            low[s, 2] = value[s, 2] * d0 + value[s, 3] * d1
            low[s, 3] = value[s, 2] * d1 + value[s, 3] * d3
        for e in range(schur.first_update[k], schur.first_update[k + 1]):
            t = schur.update[e, 0]
            i = schur.update[e, 1]
            j = schur.update[e, 2]
            value[t, 0] -= low[i, 0] * value[j, 0] + low[i, 1] * value[j, 1]
            value[t, 1] -= low[i, 0] * value[j, 2] + low[i, 1] * value[j, 3]
            value[t, 2] -= low[i, 2] * value[j, 0] + low[i, 3] * value[j, 1]
            value[t, 3] -= low[i, 2] * value[j, 2] + low[i, 3] * value[j, 3]
    return margin


@inlined
def factor_schur(schur, inverse, jac, fac, lift):
    """Factor S at the compact J (m, 6); ``inverse`` (3 nb,) is the diagonal of W^-1, zero for ground.
    ``lift`` is added to the diagonal of S, relative to it.

    Returns the smallest part of a block's determinant that elimination leaves of it: 0 where rows depend.
    """
    arm = fac.arm
    weighted = fac.weighted
    value = fac.value
    low = fac.low
    count = schur.rows.shape[0]
    for e in range(value.shape[0]):
        value[e, 0] = 0.0
        value[e, 1] = 0.0
        value[e, 2] = 0.0
        value[e, 3] = 0.0
    for k in range(count):
        for s in range(2):
            r = schur.rows[k, s]
            if r < 0:
                value[k, 3 * s] = 1.0
            for side in range(2):
                at = 3 * schur.bodies[k, side]
                for c in range(3):
                    entry = jac[r, 3 * side + c] if r >= 0 else 0.0
                    arm[2 * k + side, 3 * s + c] = entry
                    weighted[2 * k + side, 3 * s + c] = entry * inverse[at + c]
    for e in range(schur.product.shape[0]):
        t = schur.product[e, 0]
        i = schur.product[e, 1]
        j = schur.product[e, 2]
        value[t, 0] += arm[i, 0] * weighted[j, 0] + arm[i, 1] * weighted[j, 1] + arm[i, 2] * weighted[j, 2]
        value[t, 1] += arm[i, 0] * weighted[j, 3] + arm[i, 1] * weighted[j, 4] + arm[i, 2] * weighted[j, 5]
        value[t, 2] += arm[i, 3] * weighted[j, 0] + arm[i, 4] * weighted[j, 1] + arm[i, 5] * weighted[j, 2]
        value[t, 3] += arm[i, 3] * weighted[j, 3] + arm[i, 4] * weighted[j, 4] + arm[i, 5] * weighted[j, 5]
    for k in range(count):
        value[k, 0] += lift * value[k, 0]
        value[k, 3] += lift * value[k, 3]
        low[k, 0] = value[k, 0]
        low[k, 3] = value[k, 3]
    return eliminate(schur, fac)


@inlined
def solve_schur(schur, fac, sides):
    """S y = y for the first ``sides`` (1 or 2) right-hand sides in fac.side, in place; padded rows hold 0."""
    value = fac.value
    low = fac.low
    y = fac.side
    count = schur.rows.shape[0]
    for k in range(count):
        if padded(schur, k):
            continue
        for e in range(schur.first_lower[k], schur.first_lower[k + 1]):
            s = schur.lower[e, 0]
            i = schur.lower[e, 1]
            for n in range(sides):
                y[i, 0, n] -= low[s, 0] * y[k, 0, n] + low[s, 1] * y[k, 1, n]
                y[i, 1, n] -= low[s, 2] * y[k, 0, n] + low[s, 3] * y[k, 1, n]
    for k in range(count - 1, -1, -1):
        if padded(schur, k):
            continue
        for n in range(sides):
            first = y[k, 0, n]
            second = y[k, 1, n]
            y[k, 0, n] = value[k, 0] * first + value[k, 1] * second
            y[k, 1, n] = value[k, 2] * first + value[k, 3] * second
        for e in range(schur.first_lower[k], schur.first_lower[k + 1]):
            s = schur.lower[e, 0]
            i = schur.lower[e, 1]
            for n in range(sides):
                y[k, 0, n] -= low[s, 0] * y[i, 0, n] + low[s, 2] * y[i, 1, n]
                y[k, 1, n] -= low[s, 1] * y[i, 0, n] + low[s, 3] * y[i, 1, n]


@inlined
def times_jacobian(fac, schur, k, s, x):
    """Row s of block k of J times x (3 nb,); after factor_schur. Zero for padded rows."""
    arm = fac.arm
    i = 3 * schur.bodies[k, 0]
    j = 3 * schur.bodies[k, 1]
    return (
        arm[2 * k, 3 * s] * x[i]
        + arm[2 * k, 3 * s + 1] * x[i + 1]
        + arm[2 * k, 3 * s + 2] * x[i + 2]
        + arm[2 * k + 1, 3 * s] * x[j]
        + arm[2 * k + 1, 3 * s + 1] * x[j + 1]
        + arm[2 * k + 1, 3 * s + 2] * x[j + 2]
    )


@inlined
def subtract_forces(fac, schur, n, x):
    """x (3 nb,) -= J^T y for right-hand side n of fac.side."""
    arm = fac.arm
    y = fac.side
    for k in range(schur.rows.shape[0]):
        first = y[k, 0, n]
        second = y[k, 1, n]
        for side in range(2):
            at = 3 * schur.bodies[k, side]
            a = 2 * k + side
            x[at] -= arm[a, 0] * first + arm[a, 3] * second
            x[at + 1] -= arm[a, 1] * first + arm[a, 4] * second
            x[at + 2] -= arm[a, 2] * first + arm[a, 5] * second


MOST_BLOCKS = 200
"""Up to so many pairs of rows their sequence is kept for the next simulation."""


def plan_schur(row_body: np.ndarray, blocks: np.ndarray) -> tuple[Schur, SchurFactors]:
    """Find the sequence for blocks (B, 2) of rows of J (-1: padded); row_body (m, 2) gives the bodies of a row."""
    count = len(blocks)
    bodies = row_body[blocks[:, 0]] if count else np.zeros((0, 2), np.int64)
    neighbours = _graph(bodies)
    order, columns = _minimum_degree(neighbours)
    position = np.empty(count, np.int64)
    position[order] = np.arange(count)
    slot: dict[tuple[int, int], int] = {(k, k): k for k in range(count)}
    lower: list[tuple[int, int]] = []
    first_lower = [0]
    for k, later in enumerate(columns):
        for i in sorted(int(position[b]) for b in later):
            slot[i, k] = len(slot)
            lower.append((slot[i, k], i))
        first_lower.append(len(lower))
    update: list[tuple[int, int, int]] = []
    first_update = [0]
    for k in range(count):
        column = lower[first_lower[k] : first_lower[k + 1]]
        for a, (slot_i, i) in enumerate(column):
            for slot_j, j in column[: a + 1]:
                update.append((slot[i, j], slot_i, slot_j))
        first_update.append(len(update))
    ordered = bodies[order]
    touching: dict[int, list[tuple[int, int]]] = {}
    for k, pair in enumerate(ordered):
        for side, body in enumerate(pair):
            if body:
                touching.setdefault(int(body), []).append((k, side))
    product = []
    for arms in touching.values():
        for a, (i, side_i) in enumerate(arms):
            for j, side_j in arms[: a + 1]:
                product.append((slot[i, j], 2 * i + side_i, 2 * j + side_j))
    sequence = Schur(
        rows=np.ascontiguousarray(blocks[order], np.int64),
        bodies=np.ascontiguousarray(ordered, INDEX),
        product=np.array(sorted(product), INDEX).reshape(-1, 3),
        lower=np.array(lower, INDEX).reshape(-1, 2),
        first_lower=np.array(first_lower, np.int64),
        update=np.array(update, INDEX).reshape(-1, 3),
        first_update=np.array(first_update, np.int64),
        pins=np.zeros((0, 2), INDEX),
    )
    return sequence, schur_factors(sequence)


def _graph(bodies: np.ndarray) -> list[set[int]]:
    """Blocks that share a moving body."""
    at_body: dict[int, list[int]] = {}
    for block, pair in enumerate(bodies):
        for body in pair:
            if body:
                at_body.setdefault(int(body), []).append(block)
    neighbours: list[set[int]] = [set() for _ in bodies]
    for blocks in at_body.values():
        for block in blocks:
            neighbours[block].update(blocks)
    for block, around in enumerate(neighbours):
        around.discard(block)
    return neighbours


def _minimum_degree(neighbours: list[set[int]]) -> tuple[np.ndarray, list[set[int]]]:
    """Elimination order and, for each in it, the later blocks it touches; ties go to the lower number."""
    graph = [set(around) for around in neighbours]
    queue = [(len(around), block) for block, around in enumerate(graph)]
    heapq.heapify(queue)
    done = np.zeros(len(graph), bool)
    order, columns = [], []
    while queue:
        degree, block = heapq.heappop(queue)
        if done[block] or degree != len(graph[block]):
            continue
        done[block] = True
        around = graph[block]
        order.append(block)
        columns.append(around)
        for other in around:
            graph[other] |= around
            graph[other] -= {other, block}
            heapq.heappush(queue, (len(graph[other]), other))
    return np.array(order, np.int64), columns


_SEQUENCES: Kept[Schur] = Kept()


def elimination_sequence(row_body: np.ndarray, blocks: np.ndarray) -> Schur:
    """Return the sequence of plan_schur, with rows of its own, as events change them."""
    if len(blocks) >= MOST_BLOCKS:
        return plan_schur(row_body, blocks)[0]
    key = row_body.tobytes(), blocks.tobytes()
    sequence = _SEQUENCES.get(key, lambda: plan_schur(row_body, blocks)[0])
    return sequence._replace(rows=sequence.rows.copy())
