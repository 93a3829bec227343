"""The gap between two pieces of which one slides along a line of the other, at every place on that line at once.

Seen along the line, both stand still. So the distance of the two outlines in that view is a lower bound of their gap
wherever they are, and it is reached where the pieces are abreast of each other. That proves a piston in its liner,
which outlines in the plane of the motion do not.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, relative

if TYPE_CHECKING:
    from mechanisms.stages.clearance.pieces import MeshPiece
    from shared.contract import Motion

ROUNDING = 1e-3
"""How far (mm) outlines may be off, since their corners are rounded."""
STRAIGHT = 1e-4
"""A slide may leave its line by so much (mm), or turn by so much per mm of reach."""

type Slides = dict[frozenset[str], dict[str, tuple[float, np.ndarray]]]
"""By pair of bodies: in the frame of either the direction of the line (rad), and the place (2,) of a point of the pair
that is on one line along it (mm).
"""


def slides_of(motion: Motion, where: Mapping[str, BodyPath]) -> Slides:
    """Of bodies that a prismatic joint connects."""
    found: Slides = {}
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
        found[frozenset(joint.bodies)] = {
            mover: (angle - float(middle[2]), np.zeros(2)),
            still: (angle, middle[:2]),
        }
    return found


def slide_gap(first: MeshPiece, second: MeshPiece, slides: Slides) -> tuple[float, float] | None:
    """The gap (mm) of the two outlines along the line of their bodies, and what of it is proven; None where there is no
    such line, or where the outlines overlap.
    """
    line = slides.get(frozenset((first.body, second.body)))
    if line is None:
        return None
    outlines = [_outline(piece, *line[piece.body]) for piece in (first, second)]
    if (outlines[0] ^ outlines[1]).area() > 0.0:
        return None
    a, b = ([np.asarray(loop) for loop in one.to_polygons()] for one in outlines)
    gap = min(_distance(p, q) for p in a for q in b)
    return gap, max(gap - ROUNDING, 0.0)


def _outline(piece: MeshPiece, angle: float, through: np.ndarray):
    """A ``manifold3d.CrossSection``: the piece seen along a direction, across it and in height (mm)."""
    c, s = np.cos(angle), np.sin(angle)
    x, y = through
    turned = np.array([[-s, c, 0.0, s * x - c * y], [0.0, 0.0, 1.0, 0.0], [c, s, 0.0, 0.0]])
    return piece.manifold.transform(turned).project()


def _distance(p: np.ndarray, q: np.ndarray) -> float:
    """Of two closed polygons (n, 2) that do not cross."""
    return min(_to_sides(p, q), _to_sides(q, p))


def _to_sides(corners: np.ndarray, polygon: np.ndarray) -> float:
    along = np.roll(polygon, -1, axis=0) - polygon
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    to = corners[:, None] - polygon[None]
    part = np.clip((to * along[None]).sum(axis=2) / square, 0.0, 1.0)
    away = to - part[..., None] * along[None]
    return float(np.sqrt((away**2).sum(axis=2)).min())
