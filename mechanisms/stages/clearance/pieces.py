"""The pieces that are proved clear: their meshes, trees of boxes, and unions."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mechanisms.stages.parts_files import read_triangles
from shared.contract import Parts
from shared.stage.errors import UserError
from shared.stage.face import to_run

# Rows that are alike, found by a hash of each row: an order of magnitude quicker than sorting whole rows.

_FACTORS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x27D4EB2F165667C5], dtype=np.uint64)
"""Odd numbers without a pattern, one for each column."""


def distinct(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return distinct rows of (n, k) float64, k up to 4, and (n,) which of these each row is.

    Of each distinct row there is one number.

    k is at most 4. Their order follows from the rows alone. -0.0 and 0.0 are alike; no row is like another that is not.
    """
    bits = np.ascontiguousarray(rows + 0.0).view(np.uint64)
    mixed = np.zeros(len(bits), dtype=np.uint64)
    for column, factor in zip(bits.T, _FACTORS, strict=False):
        mixed = (mixed ^ column) * factor
        mixed ^= mixed >> np.uint64(29)
    _, first, which = np.unique(mixed, return_index=True, return_inverse=True)
    if not np.array_equal(bits[first][which], bits):  # two rows of one hash
        _, first, which = np.unique(bits, axis=0, return_index=True, return_inverse=True)
    return first, which.ravel()


# The facets of a piece as a tree of upright cylinders: a circle in the plane and a range of heights hold each group.
#
# A turn in the plane leaves such a cylinder as it is, so it bounds its facets at every pose. Node 1 is the root, node k
# has the children 2 k and 2 k + 1, and the leaves are single facets. Upright boxes along the piece's own axes, those of
# most of its walls, bound the same groups more closely: a slider's cheeks lie flat in them.

SIDES = 4
"""Facets longer than the piece's diameter over this are halved: long ones would be near to everything."""
SHORTEST = 1.0
"""No facet is halved below this length in the plane (mm)."""


class Tree:
    """See the file. Facets may be triangles, or segments of an outline; places are in mm."""

    def __init__(self, facets: np.ndarray, walls: np.ndarray) -> None:
        """``facets`` (n, corners, 3).

        ``walls`` (n,): their normals in the plane, x + i y, as long as they matter.
        """
        self.leaves = 1 << max(len(facets) - 1, 0).bit_length()
        """Number of leaves; the first of them is the node of this number."""
        padded = np.full((self.leaves, *facets.shape[1:]), np.nan)
        padded[: len(facets)] = facets
        self.facets = padded[leaf_order(padded.mean(axis=1))]
        """(leaves, corners, 3): by leaf; those beyond the last are not a number, and so near to nothing."""
        self.centre = np.full((2 * self.leaves, 2), np.nan)
        self.radius = np.full(2 * self.leaves, np.nan)
        self.low = np.full(2 * self.leaves, np.nan)
        self.high = np.full(2 * self.leaves, np.nan)
        for level in range(self.leaves.bit_length()):
            nodes = slice(1 << level, 2 << level)
            corners = self.facets.reshape(1 << level, -1, 3)
            low, high = np.fmin.reduce(corners, axis=1), np.fmax.reduce(corners, axis=1)
            self.centre[nodes] = middle = (low[:, :2] + high[:, :2]) / 2
            away = np.hypot(*np.moveaxis(corners[:, :, :2] - middle[:, None], -1, 0))
            self.radius[nodes] = np.fmax.reduce(away, axis=1)
            self.low[nodes], self.high[nodes] = low[:, 2], high[:, 2]
        self.reach = np.hypot(*self.centre.T) + self.radius
        """Reach of the facets of each node from the origin (mm)."""
        self.axis = _axis_of_walls(walls)
        """The unit direction of the boxes' first side, x + i y; the second one is across it."""
        c, s = self.axis.real, self.axis.imag
        axes = np.array([[c, s], [-s, c]])
        along = self.facets[:, :, :2] @ axes.T
        least, most = np.full((2 * self.leaves, 2), np.nan), np.full((2 * self.leaves, 2), np.nan)
        for level in range(self.leaves.bit_length()):
            nodes, corners = slice(1 << level, 2 << level), along.reshape(1 << level, -1, 2)
            least[nodes], most[nodes] = np.fmin.reduce(corners, axis=1), np.fmax.reduce(corners, axis=1)
        self.box_centre, self.box_half = (least + most) / 2 @ axes, (most - least) / 2
        """(nodes, 2): the centre of each box (mm), and half its widths along the axes."""


class FacetTree(Tree):
    """The triangles of a mesh, in its frame less ``centre``."""

    def __init__(self, triangles: np.ndarray, centre: np.ndarray, radius: float) -> None:
        """``triangles`` (n, 3, 3); ``centre`` (2,) and ``radius``: the circle that holds them in the plane."""
        facets = halved(triangles - np.append(centre, 0.0), longest_in(radius))
        walls = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])[:, :2] @ np.array([1.0, 1j])
        super().__init__(facets, walls)


def longest_in(radius: float) -> float:
    """Return how long (mm) facets of a piece may be that a circle of this radius holds."""
    return max(2 * radius / SIDES, SHORTEST)


def _axis_of_walls(walls: np.ndarray) -> complex:
    """Return the direction, up to quarter turns, of the longest normals together."""
    turned = np.sum(np.abs(walls) * np.exp(4j * np.angle(walls)))
    return complex(np.exp(1j * float(np.angle(turned)) / 4))


def leaf_order(centres: np.ndarray) -> np.ndarray:
    """Leaves halved at the middle of each group's longest side, level by level.

    What is not a number comes last.
    """
    order = np.arange(len(centres))[None]
    while order.shape[1] > 1:
        group = centres[order]
        spread = np.nan_to_num(np.fmax.reduce(group, axis=1) - np.fmin.reduce(group, axis=1), nan=0.0)
        longest = spread.argmax(axis=1)
        along = np.take_along_axis(group, longest[:, None, None], axis=2)[:, :, 0]
        order = np.take_along_axis(order, along.argsort(axis=1, kind="stable"), axis=1)
        order = order.reshape(2 * len(order), -1)
    return order[:, 0]


def halved(t: np.ndarray, longest: float, axes: int = 2) -> np.ndarray:
    """Return triangles halved across their longest edge until none is longer than ``longest``.

    Lengths are those along so many axes: in the plane, or in space.
    """
    done = []
    while len(t):
        length = np.linalg.norm((np.roll(t, -1, axis=1) - t)[:, :, :axes], axis=2)
        long = length.max(axis=1) > longest
        done.append(t[~long])
        t, length = t[long], length[long]
        turn = (length.argmax(axis=1)[:, None] + np.arange(3)) % 3
        p = np.take_along_axis(t, turn[:, :, None], axis=1)
        middle = (p[:, 0] + p[:, 1]) / 2
        t = np.concatenate([np.stack([p[:, 0], middle, p[:, 2]], axis=1), np.stack([middle, p[:, 1], p[:, 2]], axis=1)])
    return np.concatenate(done)


# A piece as the check uses it: its mesh, its range of heights, and a circle in the plane that holds it.

LEVEL = 1e-6
"""A facet whose corners differ less in height is horizontal (mm)."""
UPRIGHT = 1e-4
"""A wall that leans by less (rad) faces neither up nor down: rounded corners of an STL lean it so much."""


@dataclass(frozen=True)
class MeshPiece:
    """One piece of a body, in the body's frame (mm)."""

    body: str
    name: str
    triangles: np.ndarray
    """(n, 3, 3): corners of each facet."""

    @cached_property
    def z_range(self) -> tuple[float, float]:
        """Lowest and highest z (mm)."""
        heights = self.triangles[:, :, 2]
        return float(heights.min()), float(heights.max())

    @cached_property
    def centre(self) -> np.ndarray:
        """(2,): the middle of the piece's extent in the plane."""
        flat = self.triangles[:, :, :2].reshape(-1, 2)
        return (flat.min(axis=0) + flat.max(axis=0)) / 2

    @cached_property
    def radius(self) -> float:
        """Radius of the circle round ``centre`` that holds the piece."""
        return float(np.linalg.norm(self.triangles[:, :, :2].reshape(-1, 2) - self.centre, axis=1).max())

    def is_around(self, place: np.ndarray) -> bool:
        """Return True if the circle round it holds a place (2,) of its body's frame."""
        return float(np.hypot(*(place - self.centre))) <= self.radius

    @cached_property
    def reach(self) -> float:
        """How far the piece reaches from the origin of its body's frame in the plane."""
        return float(np.linalg.norm(self.centre)) + self.radius

    @cached_property
    def level(self) -> np.ndarray:
        """(n,): which facets are horizontal."""
        return np.ptp(self.triangles[:, :, 2], axis=1) <= LEVEL

    @cached_property
    def sides(self) -> FacetTree:
        """The facets that are not horizontal, by place, relative to ``centre``."""
        return FacetTree(self.triangles[~self.level], self.centre, self.radius)

    @cached_property
    def tree(self) -> FacetTree:
        """All facets by place, relative to ``centre``."""
        return FacetTree(self.triangles, self.centre, self.radius)

    @cached_property
    def upward(self) -> np.ndarray:
        """(n,): the z component of each facet's normal, times twice its area (mm^2).

        Corners run counter-clockwise.
        """
        p, q = (self.triangles[:, k, :2] - self.triangles[:, 0, :2] for k in (1, 2))
        return p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]

    @cached_property
    def size(self) -> np.ndarray:
        """(n,): twice the area of each facet (mm^2)."""
        p, q = (self.triangles[:, k] - self.triangles[:, 0] for k in (1, 2))
        return np.linalg.norm(np.cross(p, q), axis=1)

    @cached_property
    def outlines(self) -> dict[tuple[float, float], Any]:
        """The ``search.outline.Outline`` or None of those heights (mm) that were asked for."""
        return {}

    @cached_property
    def manifold(self) -> Any:
        """The ``manifold3d.Manifold`` of the mesh."""
        import manifold3d

        corners = self.triangles.reshape(-1, 3)
        first, index = distinct(corners)
        solid = manifold3d.Manifold(manifold3d.Mesh64(corners[first], index.reshape(-1, 3).astype(np.uint64)))
        if solid.status() != manifold3d.Error.NoError:
            raise UserError(f"{self.body}: {self.name}: its STL is not a closed surface ({solid.status()})")
        return solid


def facing(lying: MeshPiece, other: MeshPiece, sign: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the horizontal facets of ``lying`` and the facets of ``other`` that look the other way.

    The first look up (``sign`` 1) or down (-1); upright ones are left out: (n, 3, 3) each.
    """
    faces = lying.triangles[lying.level & (sign * lying.upward > 0)]
    return faces, other.triangles[sign * other.upward < -UPRIGHT * other.size]


def height_between(first: MeshPiece, second: MeshPiece) -> float:
    """Return the least height (mm) between a horizontal face of a piece and what faces it in the other.

    The pieces may be anywhere.

    They may be anywhere in the motion. It is infinite if nothing does. From a horizontal facet the way to the nearest
    point of another solid is vertical, unless a facet beside it is on that way too; the other end is a corner of a
    facet that faces it.
    """
    least = np.inf
    for a, b in ((first, second), (second, first)):
        for sign in (1.0, -1.0):
            lying, facets = facing(a, b, sign)
            faces, above = np.unique(sign * lying[:, 0, 2]), np.unique(sign * facets[:, :, 2])
            at = np.searchsorted(above, faces - LEVEL)
            inside = at < len(above)
            least = min(least, float((above[at[inside]] - faces[inside]).min(initial=np.inf)))
    return max(least, 0.0)


def read_pieces(parts: Parts, folder: Path) -> list[MeshPiece]:
    """Load the STL files of parts.json.

    Raises UserError if one is not the file that parts.json was written with.
    """
    pieces = []
    for body, described in parts.bodies.items():
        for name, piece in described.pieces.items():
            content = (folder / piece.stl).read_bytes()
            if hashlib.sha256(content).hexdigest() != piece.stl_sha256:
                raise UserError(
                    f"{folder / piece.stl} is not the file that parts.json describes; "
                    f"run {to_run('parts', parts.mechanism)}"
                )
            pieces.append(MeshPiece(body, name, read_triangles(content)))
    return pieces


# Facets of a wheel joined with their copies turned by all its pitches; copies that coincide are one.

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
    """Return facets between two distances (mm) from ``centre``, with their copies turned by all pitches.

    A facet counts with a part of it there; copies are turned by 1 / count of a turn. None where that makes far more of
    them.
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
    """Return how near facets come to ``centre`` in the plane, and how far from it they reach (mm).

    The first is a lower bound.
    """
    low, high = _distances(triangles - np.append(centre, 0.0))
    return float(low.min(initial=np.inf)), float(high.max(initial=0.0))


def order(pieces: list[MeshPiece], body: str, centre: np.ndarray, radius: float) -> int:
    """Return how many equal turns about ``centre`` keep the upright facets next to a pitch radius (mm).

    The wall is the upright facets there. The body's piece with most of these facets counts; 1 where there is none.
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
    """Return distances of facets from the origin in the plane: lower bounds, and farthest corners."""
    away = np.hypot(facets[:, :, 0], facets[:, :, 1])
    sides = np.linalg.norm((np.roll(facets, -1, axis=1) - facets)[:, :, :2], axis=2).max(axis=1)
    return away.min(axis=1) - sides / 2, away.max(axis=1)


def _turned(facets: np.ndarray, angle: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    x, y = facets[:, :, 0], facets[:, :, 1]
    return np.stack([c * x - s * y, s * x + c * y, facets[:, :, 2]], axis=2)


def _distinct(facets: np.ndarray) -> tuple[np.ndarray, float]:
    """Return each facet once, with corners next to each other made one, and how far a corner moved."""
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
