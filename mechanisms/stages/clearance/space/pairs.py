"""Comparison of two pieces of different bodies over their motion in space.

Facets that a joint keeps apart, however it moves, are proven first: a ball and its cup by their distances from the
joint's centre, what turns or slides about an axis by distances from that axis, and by heights along it. The rest is
searched over the motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.outlines import FIRST
from mechanisms.stages.clearance.pairs import Compared, Pairs, Refused, pair_of
from mechanisms.stages.clearance.path import error_of, far_bodies
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import Least, nearest
from mechanisms.stages.clearance.space.path import SpacePath, paths_in_space, seen
from mechanisms.stages.clearance.space.search import SpacePiece, SpaceSearch, SpaceSweep, resolution_of
from mechanisms.stages.clearance.turn import nearest_boxes, ring_boxes, turn_gap
from mechanisms.stages.parts_files import TOLERANCE
from shared.contract import Motion3, Parts
from shared.contract.links import with_links
from shared.contract.space import Marker3
from shared.shapes.units import mm

KEPT = 1e-4
"""A joint keeps a place that moves by less (mm), and a direction that moves by less per metre."""
SAG = 2 * TOLERANCE
"""Facets of two round faces lie so far (mm) inside them, so that coordinates of a joint see the gap less wide."""
type Frame = tuple[np.ndarray, np.ndarray]
"""Origin (3,; mm) and axes (3, 3; by column) of a joint in the frame of a body; the last axis is that of the joint."""


@dataclass(frozen=True)
class Kept:
    """Centre, axis, or lines along it that the motion of two bodies keeps."""

    frames: dict[str, Frame]
    turns: bool
    """True if they turn about the axis without a slide."""
    is_centred: bool
    """True if the centre alone is kept."""
    slides: bool
    """True if they slide without a turn."""

    def boxes(self, piece: SpacePiece) -> Iterator[np.ndarray]:
        """Yield boxes (n, 4) of the facets of a piece, by coordinates in which they are as far apart or nearer."""
        facets = self.seen(piece.body, piece.facets)
        if self.is_centred:
            points = np.zeros_like(facets)
            low, high = nearest(points, facets)[0], np.linalg.norm(facets, axis=2).max(axis=1)
            yield np.stack([low, high, 0 * low, 0 * low], axis=1)
            return
        rings = ring_boxes(facets)
        if not self.turns:
            rings[:, 2:] = 0.0
        yield rings
        if self.slides:
            low, high = facets.min(axis=1), facets.max(axis=1)
            yield np.stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]], axis=1)

    def holds(self, piece: SpacePiece) -> bool:
        """Return True if the axis goes into the sphere round a piece."""
        return float(np.linalg.norm(self.seen(piece.body, piece.centre)[:2])) <= piece.radius

    def seen(self, body: str, points: np.ndarray) -> np.ndarray:
        """Return points (..., 3) of a body in the axes of the joint."""
        origin, axes = self.frames[body]
        return (points - origin) @ axes


class SpacePairs(Pairs):
    """Pieces of bodies that move in space."""

    def __init__(self, parts: Parts, motion: Motion3, pieces: list[MeshPiece], limit: float, reach: float) -> None:
        self.resolution = resolution_of(reach)
        whole = [SpacePiece(piece.body, piece.name, piece.triangles) for piece in pieces]
        super().__init__(list[MeshPiece](whole), parts.pieces_may_touch, limit, reach)
        self.where = paths_in_space(with_links(motion, parts))
        self.kept = kept_by_joints(motion, parts, self.where)
        self.far = far_bodies(whole, self.where, reach)

    def compared(self, first: MeshPiece, second: MeshPiece) -> Compared:
        """Return how near two pieces come."""
        assert isinstance(first, SpacePiece)
        assert isinstance(second, SpacePiece)
        if frozenset((first.body, second.body)) in self.far:
            self.error = max(self.error, error_of(first, second, self.where))
            return None
        sweep = SpaceSweep(first, second, self.where[first.body], self.where[second.body])
        self.error = max(self.error, float(sweep.error.max(initial=0.0)))
        if sweep.is_apart(self.reach):
            return None
        kept = self.kept.get(frozenset((first.body, second.body)))
        if kept is not None and kept.turns and kept.holds(first) and kept.holds(second):
            about = [kept.seen(piece.body, piece.triangles) for piece in (first, second)]
            if sweep.gap_at(float(sweep.times[0]), self.reach) >= self.limit:
                gap, proven = turn_gap(about[0], about[1], self.reach, self.limit)
                if proven >= self.limit:
                    return self.within_reach(pair_of(first, second, gap, proven, None, "turn", 1))
        least, known = self._least(sweep, kept)
        if self.is_refused(least):
            return Refused(sweep, least)
        time = least.time if least.proven <= known else None
        pair = pair_of(
            first, second, least.gap, min(least.proven, known), time, "turn" if time is None else "motion", least.poses
        )
        return self.within_reach(pair)

    def _least(self, sweep: SpaceSweep, kept: Kept | None) -> tuple[Least, float]:
        """Return the least gap over the motion, and how far facets are apart that a joint keeps (mm)."""
        starts = np.linspace(sweep.times[0], sweep.times[-1], FIRST)
        gaps = {float(time): sweep.gap_at(float(time), self.reach) for time in starts}
        best = min(gaps, key=gaps.__getitem__)
        if gaps[best] <= 0:
            return Least(0.0, best, 0.0, len(gaps)), np.inf
        still, mover, known = sweep.still.spheres, sweep.mover.spheres, np.inf
        if kept is not None:
            facets, known = self._left(sweep, kept, max(gaps[best] - SAG, self.limit))
            known -= float(sweep.error.max(initial=0.0))
            if not all(len(some) for some in facets):
                return Least(gaps[best], best, min(known, gaps[best]), len(gaps)), known
            still, mover = sweep.still.tree_of(facets[0]), sweep.mover.tree_of(facets[1])
        return SpaceSearch(still, mover, sweep.path, sweep.still.centre).run(gaps[best], best, len(gaps)), known

    def _left(self, sweep: SpaceSweep, kept: Kept, enough: float) -> tuple[list[np.ndarray], float]:
        """Return facets of both pieces that a joint alone does not keep ``enough`` (mm) apart.

        And how far it keeps all others (mm).
        """
        pieces, known = (sweep.still, sweep.mover), np.inf
        left = [np.arange(len(piece.facets)) for piece in pieces]
        for boxes in zip(*(kept.boxes(piece) for piece in pieces), strict=True):
            if all(len(some) for some in left):
                both = [box[some] for box, some in zip(boxes, left, strict=True)]
                low = nearest_boxes(both[0], both[1], self.reach)
                near = [each < enough for each in low]
                known = min(
                    [known, *(float(each[~off].min(initial=np.inf)) for each, off in zip(low, near, strict=True))]
                )
                left = [some[off] for some, off in zip(left, near, strict=True)]
        return [piece.facets[some] for piece, some in zip(pieces, left, strict=True)], known


def kept_by_joints(motion: Motion3, parts: Parts, where: Mapping[str, SpacePath]) -> dict[frozenset[str], Kept]:
    """Return what the motion keeps of joints, by pair of bodies; links of joints are bodies, too."""
    links = {body.link.joint: name for name, body in parts.bodies.items() if body.link}
    out: dict[frozenset[str], Kept] = {}
    for name, joint in motion.joints.items():
        first, second = joint.bodies
        pairs = [(first, joint.markers[0], second)]
        if name in links:
            pairs += [(body, marker, links[name]) for body, marker in zip(joint.bodies, joint.markers, strict=True)]
        for body, marker, other in pairs:
            kept = _kept(body, marker, other, where)
            if kept is not None:
                out[frozenset((body, other))] = kept
    return out


def _kept(body: str, marker: Marker3, other: str, where: Mapping[str, SpacePath]) -> Kept | None:
    """Return what the motion of ``other`` keeps of a marker of a body, None if that is nothing."""
    across = np.array(marker.across)
    origin, axes = (
        mm(1) * np.array(marker.place),
        np.stack([across, np.cross(marker.axis, across), marker.axis], axis=1),
    )
    place, turned = seen(where[other].pose, where[body].pose)
    its_origin, its_axes = turned[0].T @ (origin - place[0]), turned[0].T @ axes
    strays, axis = (place + turned @ its_origin - origin) @ axes, turned @ its_axes[:, 2]
    lean = np.abs(axis - axes[:, 2]).max() * mm(1)
    is_turned = np.abs(turned @ its_axes - axes).max() * mm(1) >= KEPT
    if np.abs(strays).max() < KEPT:
        centred = bool(lean >= KEPT)
    elif np.abs(strays[:, :2]).max() < KEPT and lean < KEPT:
        centred = False
    else:
        return None
    frames = {body: (origin, axes), other: (its_origin, its_axes)}
    still = np.abs(strays[:, 2]).max() < KEPT
    return Kept(frames, turns=bool(still and not centred), is_centred=centred, slides=bool(not is_turned))
