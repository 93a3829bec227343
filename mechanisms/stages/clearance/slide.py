"""The gap between two pieces that slide along a line, at every place on that line at once.

Seen along the line, both stand still. So the distance of the two outlines in that view is a lower bound of their gap
wherever they are, and it is reached where the pieces are abreast of each other. That proves a piston in its liner,
which outlines in the plane of the motion do not.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, relative
from mechanisms.stages.clearance.pieces import MeshPiece
from shared.contract import Motion

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold

ROUNDING = 1e-3
"""Error (mm) of outlines, since their corners are rounded."""
STRAIGHT = 1e-4
"""A slide may leave its line by so much (mm), or turn by so much per mm of reach."""

SLICES = 24
"""Number of slices of the slider, where it is not proven as a whole."""
BESIDE = (1.0, 0.3, 0.1)
"""Parts of the reach: so far ahead and behind of what slides the other piece is looked at."""


@dataclass(frozen=True)
class Slide:
    """The line of a prismatic joint."""

    lines: dict[str, tuple[float, np.ndarray]]
    """In the frame of either body: its direction (rad), and a point (2,) of it (mm)."""
    mover: str
    way: tuple[float, float]
    """Least and largest way (mm) of the mover's point along the line from the point of the other body."""


type Slides = dict[frozenset[str], Slide]
"""Lines by pair of bodies."""


def slides_of(motion: Motion, where: Mapping[str, BodyPath]) -> Slides:
    """Return slides of bodies that a prismatic joint connects."""
    slides: Slides = {}
    for joint in motion.joints.values():
        if joint.kind != "prismatic":
            continue
        mover, still = joint.bodies
        seen = relative(where[mover].pose, where[still].pose)
        middle = seen.mean(axis=0)
        along = np.linalg.svd(seen[:, :2] - middle[:2], full_matrices=False)[2][0]
        aside = (seen[:, :2] - middle[:2]) @ np.array([-along[1], along[0]])
        if np.ptp(aside) > STRAIGHT or np.ptp(seen[:, 2]) > 1e-2 * STRAIGHT:
            continue
        angle = float(np.arctan2(along[1], along[0]))
        way = (seen[:, :2] - middle[:2]) @ along
        between = float(np.abs(np.diff(way)).max(initial=0.0))  # it may turn back between two samples
        slides[frozenset(joint.bodies)] = Slide(
            {mover: (angle - float(middle[2]), np.zeros(2)), still: (angle, middle[:2])},
            mover,
            (float(way.min()) - between, float(way.max()) + between),
        )
    return slides


def slide_gap(first: MeshPiece, second: MeshPiece, slides: Slides, reach: float = np.inf) -> tuple[float, float] | None:
    """Return the gap (mm) of two outlines along the line of their bodies, and what of it is proven.

    None where there is no such line, or where the outlines overlap.

    None where there is no such line, or where the outlines overlap. What the other never comes within ``reach`` (mm) of
    along the line, as the closed end of a cylinder, is left out; None as well where the gap is more than what is left
    out is away.
    """
    slide = slides.get(frozenset((first.body, second.body)))
    if slide is None:
        return None
    turned = [piece.manifold.transform(_along(*slide.lines[piece.body])) for piece in (first, second)]
    low, high = slide.way if first.body == slide.mover else (-slide.way[1], -slide.way[0])  # of the first
    (near, far), (start, end) = (piece.bounding_box()[2::3] for piece in turned)
    whole = np.inf, *(part * reach for part in BESIDE)
    for away in whole if np.isfinite(reach) else whole[:1]:
        a = _between(turned[0], start - high - away, end - low + away)
        b = _between(turned[1], near + low - away, far + high + away)
        if a.is_empty() or b.is_empty():
            return None
        outlines = a.project(), b.project()
        if (outlines[0] ^ outlines[1]).area() > 0.0:
            continue
        gap = _distance(*outlines)
        if gap <= away:
            return gap, max(gap - ROUNDING, 0.0)
    return None


@dataclass(frozen=True)
class Sliced:
    """Slices of a mover that are proven along the line, and its rest.

    A valve's stem is proven so, but not its disc at the seat.
    """

    gap: float
    """Gap of these slices, mm; infinite where they stay farther than ``away``."""
    away: float
    rest: list[tuple[MeshPiece, MeshPiece]]
    """The rest: parts of the mover, and the parts of the other piece that they come near to."""


def sliced(first: MeshPiece, second: MeshPiece, slides: Slides, reach: float) -> Sliced | None:
    """Return the mover cut across its line; None where there is no line or where that is of no use.

    All gaps below ``away`` are those of slices that are proven or of the rest.
    """
    slide = slides.get(frozenset((first.body, second.body)))
    if slide is None:
        return None
    mover, other = (first, second) if first.body == slide.mover else (second, first)
    ways = [_along(*slide.lines[piece.body]) for piece in (mover, other)]
    moving, still = (piece.manifold.transform(way) for piece, way in zip((mover, other), ways, strict=True))
    (low, high), away = slide.way, BESIDE[1] * reach
    bottom, top = moving.bounding_box()[2::3]
    edges = np.linspace(bottom, top, SLICES + 1)
    gap, left = np.inf, list[tuple[float, float]]()
    for start, end in pairwise(edges):
        a, b = _between(moving, start, end).project(), _between(still, start + low - away, end + high + away).project()
        if a.is_empty() or b.is_empty():
            continue
        if (a ^ b).area() > 0.0:
            touches = bool(left) and left[-1][1] == start
            left[-1:] = [(left[-1][0], end)] if touches else [*left[-1:], (start, end)]
            continue
        gap = min(gap, _distance(a, b))
    if left == [(edges[0], edges[-1])]:
        return None
    rest = []
    for start, end in left:
        near = _between(still, start + low - reach, end + high + reach)
        rest.append((_in_body(mover, _between(moving, start, end), ways[0]), _in_body(other, near, ways[1])))
    return Sliced(gap if gap <= away else np.inf, away, rest)


def _in_body(piece: MeshPiece, part: Manifold, way: np.ndarray) -> MeshPiece:
    """Return a part of a piece that is seen along a line, in the frame of its body."""
    mesh = part.to_mesh()
    corners = (np.asarray(mesh.vert_properties, float)[:, :3] - way[:, 3]) @ way[:, :3]
    return replace(piece, triangles=corners[np.asarray(mesh.tri_verts)])


def _along(angle: float, through: np.ndarray) -> np.ndarray:
    """Return (3, 4) that gives a point's place across the line, its height and its place along it (mm)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = through
    return np.array([[-s, c, 0.0, s * x - c * y], [0.0, 0.0, 1.0, 0.0], [c, s, 0.0, -c * x - s * y]])


def _between(piece: Manifold, low: float, high: float) -> Manifold:
    """Return the part of a piece between two places along the line."""
    if np.isfinite(low):
        piece = piece.trim_by_plane((0.0, 0.0, 1.0), low)
    return piece.trim_by_plane((0.0, 0.0, -1.0), -high) if np.isfinite(high) else piece


def _distance(first: CrossSection, second: CrossSection) -> float:
    """Return the distance between two outlines that do not overlap."""
    loops = [[np.asarray(loop) for loop in outline.to_polygons()] for outline in (first, second)]
    return min(min(_to_sides(p, q), _to_sides(q, p)) for p in loops[0] for q in loops[1])


def _to_sides(corners: np.ndarray, polygon: np.ndarray) -> float:
    along = np.roll(polygon, -1, axis=0) - polygon
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    to = corners[:, None] - polygon[None]
    part = np.clip((to * along[None]).sum(axis=2) / square, 0.0, 1.0)
    away = to - part[..., None] * along[None]
    return float(np.sqrt((away**2).sum(axis=2)).min())
