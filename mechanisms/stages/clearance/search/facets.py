"""Pairs of triangles in space, many at once: their distance, and how far a direction separates them."""

from __future__ import annotations

import numpy as np

NEXT = (1, 2, 0)
TINY = 1e-12
FLAT = 1e-6
"""Height (mm) below which a triangle is taken for its longest edge."""


def nearest(p: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance (n,) of triangles p and q (n, 3, 3) that do not pierce each other, and the way (n, 3) from p to q.

    The nearest points of two triangles lie on two edges, or on a corner and a face. For triangles that pierce each
    other the distance of their edges and corners comes out, and no direction separates them by it (:func:`separation`).
    """
    edges = _edge_ways(p, q)
    onto_q = _corner_ways(p, q)
    onto_p = -_corner_ways(q, p)
    ways = np.concatenate([edges, onto_q, onto_p], axis=1)
    squares = np.einsum("nki,nki->nk", ways, ways)
    best = squares.argmin(axis=1)
    rows = np.arange(len(p))
    return np.sqrt(squares[rows, best]), ways[rows, best]


def separation(direction: np.ndarray, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(n,): how far q (n, 3, 3) is beyond p along unit directions (n, 3); below zero where they overlap along it."""
    along_p = np.einsum("nki,ni->nk", p, direction)
    along_q = np.einsum("nki,ni->nk", q, direction)
    return along_q.min(axis=1) - along_p.max(axis=1)


def normals(t: np.ndarray) -> np.ndarray:
    """(n, 3): unit normals, zero for triangles that are lower than :data:`FLAT`; their edges say where they are."""
    normal = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
    size = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(t[:, NEXT] - t, axis=2).max(axis=1)
    return normal / np.where(size > FLAT * longest, size, np.inf)[:, None]


def _edge_ways(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(n, 9, 3): from the nearest point of each edge of p to the nearest point of each edge of q."""
    n = len(p)
    a, d = np.repeat(p, 3, axis=1), np.repeat(p[:, NEXT] - p, 3, axis=1)
    b, e = np.tile(q, (1, 3, 1)), np.tile(q[:, NEXT] - q, (1, 3, 1))
    r = a - b
    dd, ee, de = _dot(d, d), _dot(e, e), _dot(d, e)
    dr, er = _dot(d, r), _dot(e, r)
    dd, ee = np.maximum(dd, TINY), np.maximum(ee, TINY)
    across = dd * ee - de * de
    s = np.where(across > TINY * dd * ee, (de * er - dr * ee) / np.where(across > 0, across, 1.0), 0.0)
    s = np.clip(s, 0.0, 1.0)
    t = (de * s + er) / ee
    outside = (t < 0.0) | (t > 1.0)
    t = np.clip(t, 0.0, 1.0)
    s = np.where(outside, np.clip((de * t - dr) / dd, 0.0, 1.0), s)
    return ((b + t[..., None] * e) - (a + s[..., None] * d)).reshape(n, 9, 3)


def _corner_ways(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(n, 3, 3): from each corner of p straight to the plane of q where it meets q's inside; infinite elsewhere."""
    normal = normals(q)
    height = _dot(p - q[:, :1], normal[:, None])
    foot = p - height[..., None] * normal[:, None]
    inside = np.broadcast_to((normal != 0).any(axis=1)[:, None], height.shape).copy()
    for i, j in enumerate(NEXT):
        outward = np.cross(q[:, j] - q[:, i], normal)
        inside &= _dot(foot - q[:, i : i + 1], outward[:, None]) <= 0.0
    return np.where(inside[..., None], foot - p, 1e9)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)
