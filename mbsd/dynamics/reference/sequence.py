"""The sequence of the Schur complement's elimination, found once: blocks of few neighbours first (minimum degree).

Source: Duff, Erisman, Reid, Direct Methods for Sparse Matrices, ch. 7.
"""

from __future__ import annotations

import heapq

import numpy as np

from mbsd.base.kept import Kept
from mbsd.dynamics.reference.schur import INDEX, Schur, SchurFactors, schur_factors

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
