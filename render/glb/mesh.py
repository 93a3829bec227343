"""Triangles of an STL as vertices with normals: round walls are smooth, edges that turn by more than SHARP are not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SHARP = np.radians(32.0)
"""As in the film."""
FINE = 1e-3
"""Normals that differ by less are one."""
PAIRS = 4_000_000
"""Pairs of corners looked at together."""

Floats = NDArray[np.float32]


def smooth(triangles: NDArray[np.floating]) -> tuple[Floats, Floats, NDArray[np.unsignedinteger]]:
    """Positions (n, 3), unit normals (n, 3) and corners (3 m,) of triangles (m, 3, 3); flat ones are left out.

    The normal at a corner is the mean of those of the triangles that meet there and turn by less than SHARP against
    its own, weighted by their angles at the corner.
    """
    triangles = np.asarray(triangles, float)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    area = np.linalg.norm(normals, axis=1)
    seen = area > 1e-12 * area.max(initial=0.0)
    triangles, normals = triangles[seen], normals[seen] / area[seen, None]
    places, vertex = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    vertex = vertex.reshape(-1)
    weights = _angles(triangles).reshape(-1)
    at_corner = _means(vertex, np.repeat(normals, 3, axis=0), weights)
    keys = np.column_stack([vertex, np.round(at_corner / FINE).astype(np.int64)])
    _, first, corner = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    corner = corner.reshape(-1).astype(np.uint16 if len(first) < 65535 else np.uint32)
    return places[vertex[first]].astype(np.float32), _unit(at_corner[first]).astype(np.float32), corner


def _angles(triangles: NDArray[np.floating]) -> NDArray[np.floating]:
    """(m, 3) of the triangles at their corners (rad)."""
    ahead = _unit(np.roll(triangles, -1, axis=1) - triangles)
    back = _unit(np.roll(triangles, 1, axis=1) - triangles)
    return np.arccos(np.clip((ahead * back).sum(axis=-1), -1.0, 1.0))


def _means(vertex: np.ndarray, normals: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """(k, 3) for each corner, from all corners at the same vertex."""
    order = np.argsort(vertex, kind="stable")
    counts = np.bincount(vertex)
    starts = np.concatenate([[0], np.cumsum(counts)[:-1]])
    mates = counts[vertex[order]]  # of each corner, itself included
    out = np.zeros_like(normals)
    ends = np.cumsum(mates)
    first = 0
    while first < len(order):
        done = ends[first - 1] if first else 0
        last = max(first + 1, int(np.searchsorted(ends, done + PAIRS)))
        here = np.arange(first, min(last, len(order)))
        left = np.repeat(here, mates[here])
        offset = np.arange(len(left)) - np.repeat(np.cumsum(mates[here]) - mates[here], mates[here])
        other = starts[vertex[order[left]]] + offset
        a, b = order[left], order[other]
        near = (normals[a] * normals[b]).sum(axis=1) >= np.cos(SHARP)
        np.add.at(out, a[near], normals[b[near]] * weights[b[near], None])
        first = last
    return _unit(out)


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1.0)
