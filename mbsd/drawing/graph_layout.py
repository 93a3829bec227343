"""Positions of a graph's nodes in the plane: distances near those along edges, boxes apart.

Classical scaling of the distances along the edges gives the first places, stress majorisation (SMACOF, weights
1 / d^2) the final ones; then boxes that overlap are pushed apart. Small graphs are also begun from a few scattered
places, the same ones each time, and the drawing whose edges run through the fewest boxes and each other wins.

Source: Gansner, Koren, North, Graph drawing by stress majorization, 2004.
"""

from __future__ import annotations

import math

import numpy as np

ROUNDS = 120
TRIES, SMALL = 24, 80
"""Scattered starts of graphs of up to so many nodes."""
PUSHES = 400
UNEVEN = 0.02
"""Part by which distances of the first places differ from those along the edges."""


def layout(edges: list[tuple[int, int]], sizes: np.ndarray, length: float) -> np.ndarray:
    """Return (n, 2) centres of boxes of ``sizes`` (n, 2), with node 0 lower left.

    Connected ones are about ``length`` apart.
    """
    count = len(sizes)
    if count == 1:
        return np.zeros((1, 2))
    distance = length * _distances(edges, count)
    starts = [_scaled(distance)]
    if count <= SMALL:
        starts += [np.random.default_rng(k).normal(size=(count, 2)) * distance.max() / 2 for k in range(TRIES)]
    drawn = [_apart(_turned(_majorised(start, distance)), sizes) for start in starts]
    return min(drawn, key=lambda places: (_crossings(places, edges, sizes), _stress(places, distance)))


def _stress(places: np.ndarray, distance: np.ndarray) -> float:
    gap = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
    return round(float((np.where(distance > 0, gap / np.maximum(distance, 1e-9) - 1, 0.0) ** 2).sum()), 6)


def _crossings(places: np.ndarray, edges: list[tuple[int, int]], sizes: np.ndarray) -> int:
    """Count pairs of edges that cross, and boxes that an edge of others runs through."""
    count = 0
    ends = np.array(edges, int).reshape(-1, 2)
    a, b = places[ends[:, 0]], places[ends[:, 1]]
    for k in range(len(ends)):
        apart = (ends != ends[k, 0]).all(axis=1) & (ends != ends[k, 1]).all(axis=1)
        apart[: k + 1] = False
        sides = [_side(a[k], b[k], a), _side(a[k], b[k], b), _side(a, b, a[k]), _side(a, b, b[k])]
        count += int((apart & (sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)).sum())
        inner = a[k] + (b[k] - a[k]) * np.linspace(0.1, 0.9, 17)[:, None]
        covered = (np.abs(inner[:, None] - places) < sizes / 2).all(axis=2).any(axis=0)
        covered[ends[k]] = False
        count += int(covered.sum())
    return count


def _side(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Return the sign says on which side of the line from a to b the point p lies."""
    return (b[..., 0] - a[..., 0]) * (p[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (p[..., 0] - a[..., 0])


def _distances(edges: list[tuple[int, int]], count: int) -> np.ndarray:
    """Return (n, n) numbers of edges on the shortest path between nodes.

    Between parts that are not connected it is two more than any other.
    """
    from scipy.sparse.csgraph import shortest_path

    near = np.zeros((count, count))
    near[tuple(np.array(edges, int).reshape(-1, 2).T)] = 1
    out = shortest_path(near, directed=False, unweighted=True)
    known = np.isfinite(out)
    return np.where(known, out, out[known].max() + 2)


def _scaled(distance: np.ndarray) -> np.ndarray:
    """Return places by classical scaling: the two largest eigenvectors of the doubly centred squares.

    Eigenvalues of a symmetric graph may be equal, and rounding would choose among their vectors: distances are uneven.
    """
    count = len(distance)
    centre = np.eye(count) - 1 / count
    number = np.arange(count)
    uneven = 1.0 + UNEVEN * np.sin(1.0 + np.add.outer(number, number) + np.multiply.outer(number, number))
    values, vectors = np.linalg.eigh(-0.5 * centre @ (distance * uneven) ** 2 @ centre)
    vectors = vectors[:, -2:][:, ::-1]
    vectors = vectors * np.sign(vectors[np.abs(vectors).argmax(axis=0), [0, 1]])
    nudge = np.stack([np.zeros(count), np.sin(np.arange(count))], axis=1)  # leaves a line that is no optimum
    return vectors * np.sqrt(np.maximum(values[-2:][::-1], 0.0)) + 1e-3 * distance.max() * nudge


def _majorised(places: np.ndarray, distance: np.ndarray) -> np.ndarray:
    count = len(places)
    weight = np.where(distance > 0, 1.0 / np.maximum(distance, 1e-9) ** 2, 0.0)
    pull = np.diag(weight.sum(axis=1)) - weight
    inverse = np.linalg.pinv(pull)
    for _ in range(ROUNDS):
        gap = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        ratio = np.where(gap > 1e-9, weight * distance / np.maximum(gap, 1e-9), 0.0)
        places = inverse @ ((np.diag(ratio.sum(axis=1)) - ratio) @ places)
    return places - places.sum(axis=0) / count


def _turned(places: np.ndarray) -> np.ndarray:
    """Return the places turned: longest direction level, node 0 to the left and low (y up)."""
    _, vectors = np.linalg.eigh(places.T @ places)
    turned = places @ vectors[:, ::-1]
    return turned * np.where(turned[0] > 1e-9 * np.abs(turned).max(), -1.0, 1.0)


def _apart(places: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Move boxes that overlap apart along the shorter way out, half each; in large graphs all at once."""
    if len(places) > SMALL:
        return _apart_at_once(places, sizes)
    places = places.copy()
    for _ in range(PUSHES):
        moved = False
        for a in range(len(places)):
            gap = places - places[a]
            over = (sizes + sizes[a]) / 2 - np.abs(gap)
            for b in np.flatnonzero((over > 1e-6).all(axis=1)):
                if b <= a:
                    continue
                axis = int(np.argmin(over[b]))
                way = math.copysign(0.5 * float(over[b, axis]) + 0.5, float(gap[b, axis]))
                places[a, axis] -= way
                places[b, axis] += way
                moved = True
        if not moved:
            break
    return places


def _apart_at_once(places: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Enlarge the whole while very many boxes overlap, then push all that do in each round."""
    places, need = places.copy(), (sizes[:, None] + sizes[None]) / 2
    need[np.arange(len(places)), np.arange(len(places))] = -1.0
    for turn in range(PUSHES):
        gap = places[None] - places[:, None]
        over = need - np.abs(gap)
        a, b = np.nonzero((over[..., 0] > 1e-6) & (over[..., 1] > 1e-6))
        if not len(a):
            break
        if len(a) > 4 * len(places):
            places *= 1.1
            continue
        places *= 1.0 if turn < PUSHES // 2 else 1.01
        axis = over[a, b].argmin(axis=1)
        push = np.zeros_like(places)
        np.add.at(push, (b, axis), np.copysign(0.5 * over[a, b, axis] + 0.5, gap[a, b, axis]))
        places += push
    return places
