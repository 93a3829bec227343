"""Laying of pieces on plates: flat sides down, alike pieces together."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import ConvexHull, KDTree

from shared.stage.errors import UserError

# Lays a piece on the bed: on its largest flat face, with as little overhang as possible.

type Bed = tuple[float, float, float]
"""Length, width and height that a printer can use (mm); the height is infinite if it is not given."""

FLAT = 2e-3
"""Corners within this distance lie in one plane (mm)."""
PLANES = 60
"""Faces of the convex hull that are tried, from the largest down; those of a round surface are many."""
STEEP = math.cos(math.radians(45.0))
"""A face that looks down steeper than this needs support."""
SUPPORT = 0.5
"""Weight of an area in the air against one on the bed."""


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
        """Return the same, turned on the bed by ``angle`` (rad)."""
        c, s = math.cos(angle), math.sin(angle)
        return _standing(self.vertices, self.faces, np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]), self)


def laid(triangles: np.ndarray) -> Laid:
    """Return a piece (n, 3, 3) in mm, on the face to print on, turned to need the smallest rectangle."""
    corners, index = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    faces = index.reshape(-1, 3)
    down = _standing(corners, faces, _to_bed(best_face(corners, faces)))
    return down.turned(_least_rectangle(down.vertices))


def fitting(piece: Laid, bed: tuple[float, float]) -> Laid | None:
    """Return the piece as it is, or turned so that it fits the bed; None if it does not in any direction."""
    for degrees in range(180):
        turned = piece.turned(math.radians(degrees)) if degrees else piece
        x, y, _ = turned.size
        if _within(x, y, bed) or _within(y, x, bed):
            return turned
    return None


def _within(x: float, y: float, bed: tuple[float, float]) -> bool:
    return x <= bed[0] + 1e-6 and y <= bed[1] + 1e-6


def best_face(corners: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return (3,): the normal of the face to lie on.

    Straight down where there is no flat face to stand on.
    """
    across = np.cross(corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]])
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
    """Return normals of the largest faces of the convex hull: what has a flat face there can stand on it."""
    hull = ConvexHull(corners)
    p, q, r = (corners[hull.simplices[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(q - p, r - p), axis=1) / 2
    _, plane = np.unique(np.round(hull.equations, 4) + 0.0, axis=0, return_inverse=True)
    whole = np.round(np.bincount(plane, areas), 4)
    largest = np.lexsort((-areas, plane))[np.searchsorted(np.sort(plane), np.arange(len(whole)))]
    return [_exact(hull.equations[largest[k], :3]) for k in np.argsort(-whole, kind="stable")[:PLANES]]


def _exact(normal: np.ndarray) -> np.ndarray:
    """Return a normal without what single precision leaves on a normal along an axis."""
    whole = np.round(normal)
    return whole + 0.0 if np.abs(normal - whole).max() < 1e-5 else normal


def _to_bed(normal: np.ndarray) -> np.ndarray:
    """Return the turn that brings ``normal`` to -z by the shortest way."""
    if normal[2] > 1 - 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    x, y, z = normal
    cross = np.array([[0.0, 0.0, x], [0.0, 0.0, y], [-x, -y, 0.0]])  # of normal x (-z)
    below = (x * x + y * y) / (1 + z) if z > 0 else 1 - z  # 1 - z, with all digits where z is near 1
    return np.eye(3) + cross + cross @ cross / below


def _least_rectangle(vertices: np.ndarray) -> float:
    """Return the angle (rad) that makes the rectangle of a piece least, a long side along x."""
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


# Finds pieces that can be cut from a sheet: their outline is the same from the bed up to the sheet's thickness.
#
# Eased edges, pockets, counterbores and engraving do not change the outline and are left out of it, and so is what
# stands above the sheet, such as a boss; both are reported.

SAME = 0.9
"""The least area of an outline, of the largest, at every height of the sheet; an edge is eased by some of it."""
FULL = 0.7
"""Part of the cut sheet that the piece must be."""
THICK = 0.6
"""A piece thicker than this part of its width is none of a sheet."""
ABOVE = 0.25
"""Part of the piece that may stand above the sheet."""
SAMPLES = 24
LARGE = 0.02
"""The least area of a face that may be the sheet's upper one, of the outline's."""


@dataclass(frozen=True)
class Sheet:
    """A piece as something cut from a sheet (mm)."""

    thickness: float
    above: float
    """Height of what stands above the sheet and is not in the outline."""
    full: float
    """Volume of the piece within the sheet, as a part of the cut sheet's."""


def sheet_of(piece: Laid) -> Sheet | None:
    """Return the sheet that a laid piece can be cut from; None if its outline changes on the way up."""
    body = _manifold(piece)
    x, y, height = piece.size
    levels = _upper_faces(piece)
    heights = (np.arange(SAMPLES) + 0.5) / SAMPLES * height
    outlines = np.array([_filled(body.slice(float(z))) for z in heights])
    same = outlines >= SAME * outlines.max()
    if not same[0]:
        return None
    for level in levels:
        below = heights < level
        if not below.any() or not same[below].all():
            continue
        area = body.slice(level / 2).area()
        within = body.trim_by_plane((0.0, 0.0, -1.0), -level).volume()
        full = within / (area * level)
        if body.volume() - within > ABOVE * body.volume():
            return None
        if _filled(body.project()) > outlines.max() * 1.01 or not FULL < full < 1.03 or level > THICK * min(x, y):
            return None
        above = height - level
        return Sheet(level, above if above > FLAT else 0.0, min(full, 1.0))
    return None


def _upper_faces(piece: Laid) -> list[float]:
    """Return heights of large faces that look up, from the highest down."""
    corners = piece.triangles
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    up = across[:, 2] > 0.9999 * np.linalg.norm(across, axis=1)
    levels, areas = corners[up][:, :, 2].mean(axis=1), across[up, 2] / 2
    order = np.argsort(levels, kind="stable")
    levels, areas = levels[order], areas[order]
    faces = np.split(np.arange(len(levels)), np.flatnonzero(np.diff(levels) > FLAT) + 1)
    x, y, _ = piece.size
    large = [face for face in faces if areas[face].sum() > LARGE * x * y / 2]
    return [round(float(np.average(levels[face], weights=areas[face])), 3) for face in reversed(large)]


def _filled(section: Any) -> float:
    """Return the area of a section with its holes filled (mm^2)."""
    return sum(max(_signed(contour), 0.0) for contour in section.to_polygons())


def _signed(contour: Any) -> float:
    x, y = np.asarray(contour, dtype=float).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2


def _manifold(piece: Laid) -> Any:
    import manifold3d

    mesh = manifold3d.Mesh(piece.vertices.astype(np.float32), piece.faces.astype(np.uint32))
    solid = manifold3d.Manifold(mesh)
    if solid.status() != manifold3d.Error.NoError:
        raise UserError(f"a mesh is not a closed surface ({solid.status()}); make the parts again")
    return solid


# Finds pieces that are equal but for their place: they are made several times, but drawn and listed once.
#
# Two pieces are equal if a turn on the bed brings each corner of one mesh to a corner of the other, as it lies or
# turned over. Mirror images are not equal unless they are also turned images of each other.

NEAR = 5e-3
"""Corners that are nearer (mm) are the same; single precision leaves a thousandth of it."""
ALIKE = 1e-4
"""Relative difference of volumes that is looked at closer."""


def groups(pieces: Sequence[tuple[str, Laid]]) -> list[list[int]]:
    """Return indices of equal pieces, each given as (material, mesh), in the order of their first."""
    kinds: list[list[int]] = []
    marks: list[tuple[str, float]] = []
    for index, (material, piece) in enumerate(pieces):
        volume = volume_of(piece)
        for group, (other, theirs) in zip(kinds, marks, strict=True):
            near = abs(volume - theirs) <= ALIKE * theirs
            if material == other and near and is_equal(piece, pieces[group[0]][1]):
                group.append(index)
                break
        else:
            kinds.append([index])
            marks.append((material, volume))
    return kinds


def is_equal(piece: Laid, other: Laid) -> bool:
    """Return True if a turn, also turned over, and a shift bring one's corners onto the other's."""
    if abs(piece.size[2] - other.size[2]) > NEAR or len(piece.vertices) != len(other.vertices):
        return False
    first, second = _centred(piece), _centred(other)
    over = first * [1.0, -1.0, -1.0] + [0.0, 0.0, piece.size[2]]
    tree = KDTree(second)
    return any(_falls_on(corners, second, tree) for corners in (first, over))


def _falls_on(first: np.ndarray, second: np.ndarray, tree: KDTree) -> bool:
    """Return True if a turn about the vertical brings each corner onto one of the others."""
    reach = np.hypot(first[:, 0], first[:, 1])
    far = int(np.argmax(reach))
    same = np.abs(np.hypot(second[:, 0], second[:, 1]) - reach[far]) < NEAR
    same &= np.abs(second[:, 2] - first[far, 2]) < NEAR
    start = math.atan2(first[far, 1], first[far, 0])
    for x, y, _ in second[same]:
        c, s = math.cos(math.atan2(y, x) - start), math.sin(math.atan2(y, x) - start)
        turned = first @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        if tree.query(turned[::17], distance_upper_bound=NEAR)[0].max() < NEAR:
            away, at = tree.query(turned, distance_upper_bound=NEAR)
            if away.max() < NEAR and len(np.unique(at)) == len(second):
                return True
    return False


def volume_of(piece: Laid) -> float:
    """Return the volume of the closed mesh (mm^3)."""
    corners = piece.triangles
    return float(np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))) / 6


def _centred(piece: Laid) -> np.ndarray:
    """Return corners about the vertical through their middle."""
    return piece.vertices - [*piece.vertices[:, :2].mean(axis=0), 0.0]
