"""Comparison of two pieces of different bodies over the motion, in the plane: the first proof that suffices."""

from __future__ import annotations

from dataclasses import dataclass

from mechanisms.stages.clearance import path as bodies
from mechanisms.stages.clearance.meshing import bands, least_in_mesh, meshes
from mechanisms.stages.clearance.outlines import least_gap
from mechanisms.stages.clearance.path import axes_of, paths
from mechanisms.stages.clearance.pieces import MeshPiece
from mechanisms.stages.clearance.search import RESOLUTION, Least, Sweep
from mechanisms.stages.clearance.slide import BESIDE, ROUNDING, sliced, slide_gap, slides_of
from mechanisms.stages.clearance.turn import turn_gap
from shared.contract import Motion, Parts
from shared.contract.clearance import PairClearance, Proof
from shared.contract.geometry import with_rods
from shared.shapes.units import metres

LOOKS = 4
"""Moments at which is looked whether what slides stays near."""


@dataclass(frozen=True)
class Refused:
    """Two pieces that come too near, or of which too little is proven."""

    sweep: Sweep
    least: Least


type Compared = PairClearance | Refused | None
"""Outcome of a comparison; None for pieces that stay out of reach of each other."""


class Pairs:
    """All pieces, and how two of them are compared; ``limit`` and ``reach`` in mm."""

    resolution = RESOLUTION
    """Largest difference (mm) of measured and proven gaps, apart from errors between samples."""

    def __init__(self, pieces: list[MeshPiece], may_touch: list[tuple[str, str]], limit: float, reach: float) -> None:
        """``may_touch``: pairs of pieces, by name, that are not compared."""
        self.pieces, self.limit, self.reach = pieces, limit, reach
        self.error = 0.0
        """How far two pieces may be from where they are taken to be, at most (mm)."""
        home = {piece.name: piece.body for piece in pieces}
        self.exempt = {frozenset((home[name], name) for name in pair if name in home) for pair in may_touch}
        """Pairs of pieces that are not compared."""

    def compared(self, first: MeshPiece, second: MeshPiece) -> Compared:
        """Return how near two pieces come."""
        raise NotImplementedError

    def within_reach(self, pair: PairClearance) -> Compared:
        """Return the pair, None if it is out of reach."""
        return pair if min(pair.gap, pair.proven + metres(self.resolution)) < metres(self.reach) else None

    def is_refused(self, least: Least) -> bool:
        """Return True if a gap is too small, or too little of it is proven."""
        return least.gap < self.limit or least.proven < self.limit / 2


class PlanePairs(Pairs):
    """Pieces of bodies that move in the plane, and the bands of belts."""

    def __init__(self, parts: Parts, motion: Motion, pieces: list[MeshPiece], limit: float, reach: float) -> None:
        super().__init__(pieces, parts.pieces_may_touch, limit, reach)
        motion = with_rods(motion, parts)
        self.where = paths(motion)
        self.axes, self.in_mesh = axes_of(motion, parts, self.where), meshes(motion, pieces)
        self.slides = slides_of(motion, self.where)
        for belt in list(bands(parts, motion, self.where)):
            it = belt.piece
            self.pieces, self.where[it.body] = [*self.pieces, it], belt.path
            ends = belt.axes.items()
            self.axes |= {frozenset((it.body, body)): {it.body: at, body: there} for body, (at, there) in ends}
            self.exempt |= {frozenset(((it.body, it.name), pulley)) for pulley in belt.own}
        self.far = bodies.far_bodies(self.pieces, self.where, reach)

    def compared(self, first: MeshPiece, second: MeshPiece) -> Compared:
        """Return how near two pieces come."""
        height, where = height_gap(first, second), self.where
        if height >= self.reach:
            return None
        if frozenset((first.body, second.body)) in self.far:
            self.error = max(self.error, bodies.error_of(first, second, where))
            return None
        sweep = Sweep(first, second, *bodies.common(where[first.body], where[second.body]))
        self.error = max(self.error, float(sweep.error.max(initial=0.0)))
        if sweep.is_apart(self.reach):
            return None
        if height >= self.limit:
            return pair_of(first, second, height, height, None, "layers", 0)
        compared = self._turn(first, second, sweep) or self._slide(first, second) or self._sliced(first, second, sweep)
        if compared is None:
            least = least_in_mesh(sweep, self.in_mesh, where) or least_gap(sweep, self.reach)
            if self.is_refused(least):
                return Refused(sweep, least)
            compared = pair_of(first, second, least.gap, least.proven, least.time, "motion", least.poses)
        return self.within_reach(compared)

    def _turn(self, first: MeshPiece, second: MeshPiece, sweep: Sweep) -> PairClearance | None:
        """Return the gap at every angle of a pair round the joint between its bodies.

        None if that is not enough.
        """
        axis = self.axes.get(frozenset((first.body, second.body)))
        if axis is None or not all(piece.is_around(axis[piece.body]) for piece in (first, second)):
            return None  # for a post beside the axis the motion shows more than all angles do
        about = [piece.triangles - [axis[piece.body][0], axis[piece.body][1], 0.0] for piece in (first, second)]
        if sweep.gap_at(float(sweep.times[0]), self.reach) < self.limit:
            return None
        gap, proven = turn_gap(about[0], about[1], self.reach, self.limit)
        if proven < self.limit:
            return None
        return pair_of(first, second, gap, proven, None, "turn", 1)

    def _slide(self, first: MeshPiece, second: MeshPiece) -> PairClearance | None:
        """Return the gap at every place along the line of a prismatic joint between two bodies.

        None if that is not enough.
        """
        slid = slide_gap(first, second, self.slides, self.reach)
        if slid is None or slid[1] < self.limit:
            return None
        return pair_of(first, second, *slid, None, "slide", 1)

    def _sliced(self, first: MeshPiece, second: MeshPiece, sweep: Sweep) -> PairClearance | None:
        """Return the gap of a pair of which most is proven along a line and the rest by the motion.

        None if that is not enough. Only for a pair that stays near: else the motion alone proves it sooner.
        """
        near, where = BESIDE[1] * self.reach, self.where
        if frozenset((first.body, second.body)) not in self.slides:
            return None
        if any(sweep.gap_at(float(time), near) >= near for time in sweep.times[:: max(1, len(sweep.times) // LOOKS)]):
            return None
        cut = sliced(first, second, self.slides, self.reach)
        if cut is None or cut.gap < self.limit:
            return None
        gap, proven, time, poses = cut.gap, min(cut.gap, cut.away) - ROUNDING, None, 1
        for mover, other in cut.rest:
            least = least_gap(Sweep(mover, other, where[mover.body], where[other.body]), self.reach)
            if self.is_refused(least):
                return None
            poses += least.poses
            proven = min(proven, least.proven)
            if least.gap < gap:
                gap, time = least.gap, least.time
        if gap > cut.away:
            return None
        return pair_of(first, second, gap, proven, time, "slide" if time is None else "motion", poses)


def height_gap(first: MeshPiece, second: MeshPiece) -> float:
    """Return the height between two pieces (mm), negative where they share some."""
    return max(first.z_range[0] - second.z_range[1], second.z_range[0] - first.z_range[1])


def pair_of(
    first: MeshPiece, second: MeshPiece, gap: float, proven: float, time: float | None, proof: Proof, poses: int
) -> PairClearance:
    """Return the entry of a pair in clearance.json; ``gap`` and ``proven`` in mm."""
    return PairClearance(
        bodies=(first.body, second.body),
        pieces=(first.name, second.name),
        gap=metres(gap),
        proven=metres(proven),
        time=time,
        proof=proof,
        poses=poses,
    )
