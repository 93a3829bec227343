"""Convex shapes with round corners in the plane, and the least gap of two while their bodies move."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

ON_A_LINE = 1e-9
"""A place that is this near to a line, as a part of their sizes, is on it: no crossing."""
COARSE = 7
"""Every so many poses are looked at first: most pairs that overlap do so in one of these."""
FLAT = 1.0
"""Corners of a hull that stand out less may be dropped (rmm)."""


@dataclass(frozen=True, eq=False)
class Rounded:
    """All points within ``radius`` (rmm) of a convex ``core`` (n, 2), counter-clockwise.

    A core of one point is a disc, of two a capsule.

    The core of what changes its shape is (T, n, 2), one for each pose.
    """

    core: np.ndarray
    radius: float

    def core_at(self, chosen: np.ndarray) -> np.ndarray:
        """Return the core at these poses: (n, 2), or (k, n, 2) where it changes."""
        return self.core if self.core.ndim == 2 else self.core[chosen]

    @cached_property
    def content(self) -> tuple[tuple[int, ...], bytes, float]:
        """Key that is equal for two equal shapes."""
        return self.core.shape, self.core.tobytes(), self.radius

    @property
    def reach(self) -> tuple[np.ndarray, float]:
        """A circle round it: centre, (1, 2) or (T, 1, 2), and radius."""
        centre = (self.core.min(axis=-2, keepdims=True) + self.core.max(axis=-2, keepdims=True)) / 2
        return centre, float(np.linalg.norm(self.core - centre, axis=-1).max()) + self.radius


def disc(x: float, y: float, radius: float) -> Rounded:
    """Return a disc."""
    return Rounded(np.array([[x, y]]), radius)


def around(points: Sequence[tuple[float, float]], radius: float) -> Rounded:
    """Return all within ``radius`` of the convex hull of points."""
    return Rounded(convex_hull(np.array(points, dtype=float)), radius)


def box(at: tuple[float, float], along: tuple[float, float], low: float, high: float, half: float) -> Rounded:
    """Return a rectangle about a line through ``at``, ``low`` to ``high`` along it, ``half`` aside."""
    u, place = np.array(along), np.array(at)
    left = np.array([-u[1], u[0]])
    corners = [place + s * u + q * left for s in (low, high) for q in (-half, half)]
    return around([(float(p[0]), float(p[1])) for p in corners], 1e-6)


def convex_hull(points: np.ndarray, tolerance: float = 1e-9) -> np.ndarray:
    """Return (m, 2) corners of the convex hull, counter-clockwise, by a monotone chain.

    No corner is on a line between two others.

    ``tolerance``: corners are dropped that with others make triangles of this part of the hull's squared size, as far
    as what is dropped lies within ``FLAT`` of the hull that stays.
    """
    size = max(float(np.ptp(points, axis=0).max()), 1e-300)
    ordered = sorted({(round(float(x), 12), round(float(y), 12)) for x, y in points})
    if len(ordered) < 3:
        return np.array(ordered)

    def half(sequence: list[tuple[float, float]]) -> list[tuple[float, float]]:
        chain: list[tuple[float, float]] = []
        for point in sequence:
            while len(chain) > 1 and _cross(chain[-2], chain[-1], point) <= 1e-9 * size * size:
                chain.pop()
            chain.append(point)
        return (_plainer(chain, tolerance * size * size) if tolerance > 1e-9 else chain)[:-1]

    return np.array(half(ordered) + half(ordered[::-1]))


def _plainer(chain: list[tuple[float, float]], area: float) -> list[tuple[float, float]]:
    """Return the convex chain without corners that hardly stand out; its ends stay."""
    kept, dropped = [chain[0]], list[tuple[float, float]]()
    for corner, after in pairwise(chain[1:]):
        least = min(math.dist(kept[-1], after) * FLAT, area)
        dropped.append(corner)
        if any(_cross(kept[-1], skipped, after) > least for skipped in dropped):
            kept.append(corner)
            dropped = []
    return [*kept, chain[-1]]


def least_gap(
    first: Rounded, second: Rounded, poses: tuple[np.ndarray, np.ndarray], enough: float
) -> tuple[float, int]:
    """Return the least gap (rmm, negative where they overlap) and the pose it is at.

    (T, 3) poses x, y, theta of both bodies.

    A gap above ``enough`` need not be the least one, and for one below it the first that is found will do.
    """
    centre, radius = first.reach
    other, beside = second.reach
    apart = np.linalg.norm(placed(centre, poses[0]) - placed(other, poses[1]), axis=2)[:, 0]
    gaps = apart - radius - beside
    near = np.flatnonzero(gaps <= enough)
    if not len(near):
        at = int(np.argmin(gaps))
        return float(gaps[at]), at
    for chosen in (near[::COARSE], near):
        a = placed(first.core_at(chosen), poses[0][chosen])
        b = placed(second.core_at(chosen), poses[1][chosen])
        exact = core_gaps(a, b) - first.radius - second.radius
        at = int(np.argmin(exact))
        if exact[at] <= enough:
            break
    return float(exact[at]), int(chosen[at])


def core_gaps(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return (T,): distances of two convex polygons of points (T, n, 2) and (T, m, 2).

    0 where they overlap.
    """
    gaps = np.minimum(_corners_to_edges(a, b), _corners_to_edges(b, a))
    meet = _inside(a[:, 0], b) | _inside(b[:, 0], a) | _cross_each_other(a, b)
    return np.where(meet, 0.0, gaps)


def _edges(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    if points.shape[1] < 3:
        return points[:, :1], points[:, -1:]
    return points, np.roll(points, -1, axis=1)


def _corners_to_edges(corners: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    start, end = _edges(polygon)
    along = end - start
    square = np.maximum((along**2).sum(axis=2), 1e-300)
    to = corners[:, :, None] - start[:, None]
    part = np.clip((to * along[:, None]).sum(axis=3) / square[:, None], 0.0, 1.0)
    away = to - part[..., None] * along[:, None]
    return np.sqrt((away**2).sum(axis=3)).min(axis=(1, 2))


def _inside(point: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    if polygon.shape[1] < 3:
        return np.zeros(len(point), dtype=bool)
    start, end = _edges(polygon)
    return (_turn(end - start, point[:, None] - start) >= 0).all(axis=1)


def _cross_each_other(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    if min(a.shape[1], b.shape[1]) < 2:
        return np.zeros(len(a), dtype=bool)
    (p, q), (r, s) = _edges(a), _edges(b)
    p, q, r, s = p[:, :, None], q[:, :, None], r[:, None], s[:, None]
    return (_parts(p, q, r, s) & _parts(r, s, p, q)).any(axis=(1, 2))


def _parts(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return True if r and s are clearly on either side of the line through p and q."""
    to_r, to_s = _turn(q - p, r - p), _turn(q - p, s - p)
    reach = np.abs(r - p).sum(axis=-1) + np.abs(s - p).sum(axis=-1)
    noise = ON_A_LINE * np.abs(q - p).sum(axis=-1) * reach
    return (to_r * to_s < 0) & (np.minimum(np.abs(to_r), np.abs(to_s)) > noise)


def _turn(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _cross(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def placed(points: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """Return (T, n, 2): points (n, 2) or (T, n, 2) of a body in the world at poses (T, 3)."""
    c, s = np.cos(pose[:, 2:]), np.sin(pose[:, 2:])
    x = pose[:, :1] + c * points[..., 0] - s * points[..., 1]
    return np.stack([x, pose[:, 1:2] + s * points[..., 0] + c * points[..., 1]], axis=2)
