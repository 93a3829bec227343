"""Flat faces split into stripes, and the faces around them at the same places, so that a solid stays closed."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from render.film.hatches import Hatch
from render.film.scene import Plane

Array = NDArray[np.float64]
NEAR = 1e-9
"""Corners this near to a line (m) are on it."""


def striped(triangles: Array, hatch: Hatch, light: float) -> tuple[Array, Array]:
    """Triangles (n, 3, 3) (m) split along the edges of stripes: those in the ``light`` part of each, and the dark ones.

    The hatch's period is in m.
    """
    way = np.array(hatch.way)
    for line in _lines(triangles, hatch, light):
        triangles = _split(triangles, triangles @ way - line)
    where = triangles.mean(axis=1) @ way / hatch.period % 1.0 < light
    return triangles[where], triangles[~where]


def along_rim(triangles: Array, plane: Plane, hatch: Hatch, light: float, level: float) -> Array:
    """Triangles (n, 3, 3) (m) whose edges that lie in a plane, within ``level``, are split where stripes end."""
    way, normal = np.array(hatch.way), np.array(plane[:3])
    on_it = np.abs(triangles @ normal - plane[3]) < level
    at_rim = on_it.sum(axis=1) == 2
    rim, others = triangles[at_rim], triangles[~at_rim]
    away = np.argmin(on_it[at_rim], axis=1)  # the corner that is off the plane comes last
    rim = np.take_along_axis(rim, ((away[:, None] + np.arange(1, 4)) % 3)[..., None], axis=1)
    for line in _lines(rim[:, :2], hatch, light):
        sides = rim[:, :2] @ way - line
        cut = _crosses(sides[:, 0], sides[:, 1])
        a, b, apex = (rim[cut, k] for k in range(3))
        middle = _between(a, b, sides[cut, 0], sides[cut, 1])
        rim = np.concatenate([rim[~cut], np.stack([a, middle, apex], 1), np.stack([middle, b, apex], 1)])
    return np.concatenate([others, rim])


def _lines(points: Array, hatch: Hatch, light: float) -> list[float]:
    """Where stripes of points (..., 3) begin and end along the hatch's way."""
    if not len(points):
        return []
    along = points @ np.array(hatch.way)
    first, last = (int(np.floor(edge / hatch.period)) for edge in (along.min(), along.max()))
    return [hatch.period * (k + part) for k in range(first, last + 2) for part in (0.0, light)]


def _split(triangles: Array, sides: Array) -> Array:
    """Triangles (n, 3, 3) split where ``sides`` (n, 3), how far corners are beyond a line (m), change their sign."""
    sign = np.where(sides > NEAR, 1, np.where(sides < -NEAR, -1, 0))
    both = (sign.max(axis=1) > 0) & (sign.min(axis=1) < 0)
    touched = both & (sign == 0).any(axis=1)
    parts = [triangles[~both]]
    if touched.any():
        (on_it, a, b), (_, u, v) = _turned(triangles, sides, touched, np.argmax(sign == 0, axis=1))
        middle = _between(a, b, u, v)
        parts += [np.stack([on_it, a, middle], 1), np.stack([on_it, middle, b], 1)]
    crossed = both & ~touched
    if crossed.any():
        alone = np.argmax(sign == -np.sign(sign.sum(axis=1))[:, None], axis=1)
        (top, a, b), (w, u, v) = _turned(triangles, sides, crossed, alone)
        p, q = _between(top, a, w, u), _between(top, b, w, v)
        parts += [np.stack([top, p, q], 1), np.stack([p, a, b], 1), np.stack([p, b, q], 1)]
    return np.concatenate(parts)


def _turned(triangles: Array, sides: Array, which: NDArray[np.bool_], first: NDArray[np.intp]) -> tuple[Array, Array]:
    """Corners (3, m, 3) and sides (3, m) of some triangles, each from its corner ``first`` on."""
    order = (first[which, None] + np.arange(3)) % 3
    corners = np.take_along_axis(triangles[which], order[..., None], axis=1)
    return corners.transpose(1, 0, 2), np.take_along_axis(sides[which], order, axis=1).T


def _crosses(u: Array, v: Array) -> NDArray[np.bool_]:
    return ((u > NEAR) & (v < -NEAR)) | ((u < -NEAR) & (v > NEAR))


def _between(a: Array, b: Array, u: Array, v: Array) -> Array:
    """Where edges (m, 3) from ``a`` to ``b`` meet the line; the same bits from either end."""
    ahead = (u > v)[:, None]
    a, b = np.where(ahead, a, b), np.where(ahead, b, a)
    u, v = np.maximum(u, v), np.minimum(u, v)
    return a + (u / (u - v))[:, None] * (b - a)
