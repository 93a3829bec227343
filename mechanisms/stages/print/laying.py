"""Lays a piece on the bed: on its largest flat face, with as little overhang as possible."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

type Bed = tuple[float, float, float]
"""Length, width and height that a printer can use (mm); the height is infinite if it is not given."""

FLAT = 2e-3
"""What counts as in a plane (mm)."""
PLANES = 60
"""Faces of the convex hull that are tried, from the largest down; those of a round surface are many."""
STEEP = math.cos(math.radians(45.0))
"""A face that looks down steeper than this needs support."""
SUPPORT = 0.5
"""What an area in the air counts against one on the bed."""


@dataclass(frozen=True, eq=False)
class Laid:
    """A closed mesh that stands on z = 0, its corner of least x and y at the origin."""

    vertices: np.ndarray
    """(n, 3), mm."""
    faces: np.ndarray
    """(m, 3)."""
    turn: np.ndarray
    """(3, 3): from the frame of the piece."""
    shift: np.ndarray
    """(3,): added after the turn."""

    @property
    def size(self) -> tuple[float, float, float]:
        """Along x, y and z (mm)."""
        x, y, z = np.ptp(self.vertices, axis=0)
        return float(x), float(y), float(z)

    @property
    def triangles(self) -> np.ndarray:
        """(m, 3, 3): corners of each facet."""
        return self.vertices[self.faces]

    def turned(self, angle: float) -> Laid:
        """The same, turned on the bed by ``angle`` (rad)."""
        c, s = math.cos(angle), math.sin(angle)
        return _standing(self.vertices, self.faces, np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), self)


def laid(triangles: np.ndarray) -> Laid:
    """A piece, (n, 3, 3) in mm, on the face that it prints best on, turned to need the smallest rectangle."""
    corners, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    down = _standing(corners, faces, _to_bed(best_face(corners, faces)))
    return down.turned(_least_rectangle(down.vertices))


def fitting(piece: Laid, bed: tuple[float, float]) -> Laid | None:
    """The piece as it is, or turned so that it fits the bed; None if it does not in any direction."""
    for degrees in range(180):
        turned = piece.turned(math.radians(degrees)) if degrees else piece
        x, y, _ = turned.size
        if _within(x, y, bed) or _within(y, x, bed):
            return turned
    return None


def _within(x: float, y: float, bed: tuple[float, float]) -> bool:
    return x <= bed[0] + 1e-6 and y <= bed[1] + 1e-6


def best_face(corners: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(3,): the normal of the face to lie on; straight down where there is no flat face to stand on."""
    across = np.cross(
        corners[faces[:, 1]] - corners[faces[:, 0]],
        corners[faces[:, 2]] - corners[faces[:, 0]],
    )
    twice = np.linalg.norm(across, axis=1)
    normals = across / np.where(twice > 0, twice, 1.0)[:, None]
    candidates: list[tuple[float, bool, tuple[float, ...]]] = []
    for normal in _resting(corners):
        heights = corners @ normal
        level = float(heights.max())
        towards = normals @ normal
        inside = (heights[faces] > level - FLAT).all(axis=1) & (towards > 0.9)
        if not inside.any():
            continue
        hanging = (towards > STEEP) & ~inside
        score = float(twice[inside].sum() - SUPPORT * (twice * towards)[hanging].sum())
        candidates.append((-round(score / float(twice.sum()), 4), normal[2] != -1.0, tuple(float(n) for n in normal)))
    return np.array(min(candidates)[2]) if candidates else np.array([0.0, 0.0, -1.0])


def _resting(corners: np.ndarray) -> list[np.ndarray]:
    """Normals of the largest faces of the convex hull: what has a flat face there can stand on it."""
    hull = ConvexHull(corners)
    p, q, r = (corners[hull.simplices[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(q - p, r - p), axis=1) / 2
    _, plane = np.unique(np.round(hull.equations, 4) + 0.0, axis=0, return_inverse=True)
    whole = np.round(np.bincount(plane, areas), 4)
    largest = np.lexsort((-areas, plane))[np.searchsorted(np.sort(plane), np.arange(len(whole)))]
    return [_exact(hull.equations[largest[k], :3]) for k in np.argsort(-whole, kind="stable")[:PLANES]]


def _exact(normal: np.ndarray) -> np.ndarray:
    """Without what single precision leaves on a normal along an axis."""
    whole = np.round(normal)
    return whole + 0.0 if np.abs(normal - whole).max() < 1e-5 else normal


def _to_bed(normal: np.ndarray) -> np.ndarray:
    """The turn that brings ``normal`` to -z by the shortest way."""
    if normal[2] > 1 - 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    x, y, z = normal
    cross = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])  # of normal x (-z)
    return np.eye(3) + cross + cross @ cross / (1 - z)


def _least_rectangle(vertices: np.ndarray) -> float:
    """The angle (rad) by which a piece is turned so that its rectangle is least, a long side along x."""
    hull = vertices[ConvexHull(vertices[:, :2]).vertices, :2]
    edges = np.roll(hull, -1, axis=0) - hull
    best, least = 0.0, np.inf
    for angle in [0.0, *(-np.arctan2(edges[:, 1], edges[:, 0])).tolist()]:
        c, s = math.cos(angle), math.sin(angle)
        x, y = np.ptp(hull @ np.array([[c, s], [-s, c]]), axis=0)
        if x * y < least * (1 - 1e-6):
            least, best = x * y, angle if x >= y else angle + math.pi / 2
    return best


def _standing(vertices: np.ndarray, faces: np.ndarray, turn: np.ndarray, before: Laid | None = None) -> Laid:
    placed = vertices @ turn.T
    shift = -placed.min(axis=0)
    whole, moved = (turn, shift) if before is None else (turn @ before.turn, turn @ before.shift + shift)
    return Laid(placed + shift, faces, whole, moved)
