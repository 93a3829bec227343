"""Finds bodies that stay far apart, such as links of a chain that are no neighbours: their pieces need no comparison.

Between two outputs a body's origin lies within the box round the control points of its quintic, and its pieces lie
within a circle about the origin. Boxes that are apart by the radii and more settle all pieces of two bodies at once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechanisms.stages.clearance.path import BodyPath
    from mechanisms.stages.clearance.pieces import MeshPiece


def far_bodies(pieces: Sequence[MeshPiece], where: Mapping[str, BodyPath], reach: float) -> set[frozenset[str]]:
    """Pairs of bodies whose pieces are ``reach`` (mm) apart or more over the whole motion."""
    radius: dict[str, float] = {}
    for piece in pieces:
        radius[piece.body] = max(radius.get(piece.body, 0.0), piece.reach)
    places = {body: where[body].control[:, :, :2] for body in radius}
    boxes = {body: (place.min(axis=1), place.max(axis=1)) for body, place in places.items()}
    room = {body: r + where[body].interpolation_error(r) for body, r in radius.items()}
    pairs = set()
    for a, b in combinations(radius, 2):
        (low_a, high_a), (low_b, high_b) = boxes[a], boxes[b]
        gap = np.maximum(np.maximum(low_b - high_a, low_a - high_b), 0.0)
        if (np.hypot(gap[:, 0], gap[:, 1]) - room[a] - room[b] >= reach).all():
            pairs.add(frozenset((a, b)))
    return pairs


def error_of(first: MeshPiece, second: MeshPiece, where: Mapping[str, BodyPath]) -> float:
    """How far two pieces may at most be from where they are taken to be (mm)."""
    ends = [where[piece.body].interpolation_error(piece.reach) for piece in (first, second)]
    return float((ends[0] + ends[1]).max(initial=0.0))
