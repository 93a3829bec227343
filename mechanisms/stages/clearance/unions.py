"""Facets of a wheel joined with their copies turned by all its pitches; copies that coincide are one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.pieces import MeshPiece

SAME = 2e-4
"""Corners of copies nearer than this (mm) are one; what that moves them is reported."""
MOST = 3.0
"""A union with more facets than this times those of the wheel is of no use: its teeth are not alike."""


@dataclass(frozen=True)
class Union:
    """Facets (n, 3, 3), and how far corners were moved at most to make copies one (mm)."""

    triangles: np.ndarray
    spread: float


def turned_union(triangles: np.ndarray, centre: np.ndarray, count: int, band: tuple[float, float]) -> Union | None:
    """The facets with a part between two distances (mm) from ``centre``, and their copies turned by 1 / count of a
    turn; None where that makes far more of them.
    """
    facets = triangles - np.append(centre, 0.0)
    low, high = _distances(facets)
    facets = facets[(high >= band[0]) & (low <= band[1])]
    if not len(facets):
        return None
    pitch = 2 * math.pi / count
    middle = facets.mean(axis=1)
    folded = _turned(facets, -pitch * np.floor(np.arctan2(middle[:, 1], middle[:, 0]) / pitch))
    sector, spread = _distinct(folded)
    if len(sector) * count > MOST * len(facets):
        return None
    copies = [_turned(sector, np.full(len(sector), pitch * k)) for k in range(count)]
    return Union(np.concatenate(copies) + np.append(centre, 0.0), spread)


def extent(triangles: np.ndarray, centre: np.ndarray) -> tuple[float, float]:
    """How near to ``centre`` facets come in the plane at least (a lower bound), and how far from it they reach (mm)."""
    low, high = _distances(triangles - np.append(centre, 0.0))
    return float(low.min(initial=np.inf)), float(high.max(initial=0.0))


def order(pieces: list[MeshPiece], body: str, centre: np.ndarray, radius: float) -> int:
    """How many equal turns about ``centre`` leave the upright facets next to a pitch radius (mm) as they are.

    The body's piece with most of these facets counts; 1 where there is none.
    """
    best: list[np.ndarray] = []
    for piece in pieces:
        if piece.body == body:
            facets = piece.triangles[~piece.level] - np.append(centre, 0.0)
            low, high = _distances(facets)
            best.append(facets[(low < radius) & (high > radius) & (high - low < 0.5 * radius)])
    facets = max(best, key=len, default=np.empty((0, 3, 3)))
    if not len(facets):
        return 1
    middle = facets.mean(axis=1)
    angles = np.sort(np.arctan2(middle[:, 1], middle[:, 0]))
    return max((n for n in range(2, len(angles) // 4 + 1) if len(angles) % n == 0 and _repeats(angles, n)), default=1)


def _repeats(angles: np.ndarray, count: int) -> bool:
    step = len(angles) // count
    on = np.concatenate([angles[step:], angles[:step] + 2 * math.pi])
    return bool(np.abs(on - angles - 2 * math.pi / count).max() < 1e-4)


def _distances(facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """From the origin in the plane: a lower bound of the nearest point of each facet, and the farthest corner."""
    away = np.hypot(facets[:, :, 0], facets[:, :, 1])
    sides = np.linalg.norm((np.roll(facets, -1, axis=1) - facets)[:, :, :2], axis=2).max(axis=1)
    return away.min(axis=1) - sides / 2, away.max(axis=1)


def _turned(facets: np.ndarray, angle: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    x, y = facets[:, :, 0], facets[:, :, 1]
    return np.stack([c * x - s * y, s * x + c * y, facets[:, :, 2]], axis=2)


def _distinct(facets: np.ndarray) -> tuple[np.ndarray, float]:
    """Facets with corners next to each other made one, each facet once; and how far a corner was moved at most."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    corners = facets.reshape(-1, 3)
    pairs = cKDTree(corners).query_pairs(SAME, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(corners), len(corners)))
    label = connected_components(links, directed=False)[1]
    _, chosen = np.unique(label, return_index=True)
    spread = float(np.linalg.norm(corners - corners[chosen[label]], axis=1).max())
    index = label.reshape(-1, 3)
    _, kept = np.unique(np.sort(index, axis=1), axis=0, return_index=True)
    return corners[chosen[index[np.sort(kept)]]], spread
