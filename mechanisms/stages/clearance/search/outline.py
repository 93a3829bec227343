"""The outline of a piece between two heights: the edge of its shadow in the plane, as segments.

Each upright line through a solid leaves it by a facet that looks up. So the shadow is that of these facets, and its
edge is among those of their edges that no two of them share. Where two facets lie on the same line in the plane, one on
either side of it, the line is inside the shadow and is left out.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.clearance.tree import Tree, longest_in

if TYPE_CHECKING:
    from mechanisms.stages.clearance.pieces import MeshPiece

ROUNDING = 1e-8
"""Corners that are nearer to each other than this (in radii of the piece) are one."""


class Outline(Tree):
    """Segments of the shadow's edge, relative to ``centre``; the shadow is on the left of each."""

    def __init__(self, edges: np.ndarray, times: np.ndarray, centre: np.ndarray, radius: float) -> None:
        """``edges`` (n, 2, 2): their ends (mm); ``times`` (n,): of how many facets more each is a side, on its left."""
        self.edges, self.times = edges, times
        segments = _divided(edges - centre, longest_in(radius))
        along = (segments[:, 1] - segments[:, 0]) @ np.array([1.0, 1j])
        super().__init__(np.concatenate([segments, np.zeros((len(segments), 2, 1))], axis=2), 1j * along)
        self.ends = self.facets[:, :, 0] + 1j * self.facets[:, :, 1]
        """(leaves, 2): by leaf, x + i y."""


def outline(piece: MeshPiece, low: float, high: float) -> Outline | None:
    """Outline of what ``piece`` has between two heights (mm); None if that is nothing. It is kept with the piece: many
    others have the same heights in common with it.
    """
    span = max(low, piece.z_range[0]), min(high, piece.z_range[1])
    if span not in piece.outlines:
        piece.outlines[span] = _outline(piece, *span)
    return piece.outlines[span]


def _outline(piece: MeshPiece, low: float, high: float) -> Outline | None:
    mesh = _between(piece, low, high)
    if mesh is None:
        return None
    corners, index = mesh
    p, q, r = (corners[index[:, k], :2] for k in range(3))
    way, side = q - p, r - p
    return _edge(piece, corners, index[way[:, 0] * side[:, 1] - way[:, 1] * side[:, 0] > 0.0])


def edge_of(facets: np.ndarray, piece: MeshPiece) -> Outline | None:
    """Edge of the shadow of ``facets`` (n, 3, 3) of a piece, which all look up or all look down; None without any."""
    index = np.arange(3 * len(facets)).reshape(-1, 3)
    (x, y), (u, v) = (facets[0, k, :2] - facets[0, 0, :2] for k in (1, 2))
    return _edge(piece, facets.reshape(-1, 3), index if x * v > y * u else index[:, ::-1])


def _edge(piece: MeshPiece, corners: np.ndarray, up: np.ndarray) -> Outline | None:
    """The edge of the shadow of facets ``up`` (m, 3) whose numbers run counter-clockwise seen from above."""
    edges = np.concatenate([up[:, (0, 1)], up[:, (1, 2)], up[:, (2, 0)]])
    grid = np.round(corners[:, :2] / (ROUNDING * piece.radius))
    _, first, place = np.unique(grid, axis=0, return_index=True, return_inverse=True)
    edges, times = _unmatched(place.ravel()[edges], len(first))
    if not len(edges):
        return None
    return Outline(corners[first, :2][edges], times, piece.centre, piece.radius)


def covers(outline: Outline, points: np.ndarray) -> bool:
    """Whether one of ``points`` (m, 2) is inside the shadow: its edges wind round it."""
    a, b = outline.edges[:, 0], outline.edges[:, 1]
    low, high = outline.edges.min(axis=(0, 1)), outline.edges.max(axis=(0, 1))
    points = points[((points >= low) & (points <= high)).all(axis=1)]
    for some in np.array_split(points, 1 + len(points) * len(a) // 2_000_000):
        x, y = some[:, :1], some[:, 1:]
        left = (b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (x - a[:, 0]) * (b[:, 1] - a[:, 1])
        rises = (a[:, 1] <= y) & (b[:, 1] > y) & (left > 0)
        falls = (a[:, 1] > y) & (b[:, 1] <= y) & (left < 0)
        if (rises @ outline.times > falls @ outline.times).any():
            return True
    return False


def _between(piece: MeshPiece, low: float, high: float) -> tuple[np.ndarray, np.ndarray] | None:
    """Corners (n, 3) and facets (m, 3) of what is between two heights."""
    solid = piece.manifold
    if low > piece.z_range[0]:
        solid = solid.trim_by_plane((0.0, 0.0, 1.0), low)
    if high < piece.z_range[1]:
        solid = solid.trim_by_plane((0.0, 0.0, -1.0), -high)
    if solid.is_empty():
        return None
    mesh = solid.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)


def _unmatched(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of numbers below ``count`` (n, 2) that are there more often than turned round, and how much more."""
    edges = edges[edges[:, 0] != edges[:, 1]]
    keys, number = np.unique(edges[:, 0] * count + edges[:, 1], return_counts=True)
    forth = np.stack([keys // count, keys % count], axis=1)
    back = forth[:, 1] * count + forth[:, 0]
    at = np.minimum(np.searchsorted(keys, back), max(len(keys) - 1, 0))
    more = number - np.where(keys[at] == back, number[at], 0)
    return forth[more > 0], more[more > 0]


def _divided(segments: np.ndarray, longest: float) -> np.ndarray:
    """Segments (n, 2, 2) in equal pieces that are not longer."""
    way = segments[:, 1] - segments[:, 0]
    number = np.maximum(np.ceil(np.hypot(*way.T) / longest), 1).astype(int)
    which = np.repeat(np.arange(len(segments)), number)
    part = (np.arange(len(which)) - np.repeat(np.cumsum(number) - number, number)) / number[which]
    start = segments[which, 0] + part[:, None] * way[which]
    return np.stack([start, start + way[which] / number[which, None]], axis=1)
