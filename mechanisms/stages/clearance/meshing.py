"""The least gap of two gears in mesh over any number of turns follows from one tooth pitch.

Wheels that roll on each other repeat: seen from the first wheel, turning the second wheel's centre on by one pitch of
the first turns the second by one pitch of its own as well. So with teeth that are all alike, one pitch shows all gaps.
Three things make that a proof for the meshes and the motion at hand:

- Each mesh is replaced by the union of its copies turned by all its pitches, which holds the mesh. It is the same after
  a turn by a pitch, so poses that differ by pitches have the same gap.
- The motion is compared with ideal rolling, centres ``d`` apart and angles in the ratio of the teeth. What it is off at
  most, between samples too, is taken off the gap that is proven.
- Over one pitch of ideal rolling the search of search.py proves the gap of the two unions.

Copies that coincide are one: those of equal teeth as good as vanish. Where wheels are no such wheels (a sector, teeth
left out), the unions are larger than the meshes, and the whole motion is searched instead.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.path import BodyPath, RelativePath
from mechanisms.stages.clearance.pieces import MeshPiece, height_between
from mechanisms.stages.clearance.rolling import Rolling, rolling
from mechanisms.stages.clearance.search.least import FIRST
from mechanisms.stages.clearance.search.search import RESOLUTION, Least, Search
from mechanisms.stages.clearance.search.sweep import Sweep
from mechanisms.stages.clearance.tree import FacetTree
from mechanisms.stages.clearance.unions import extent, order, turned_union
from shared.contract import Motion
from shared.shapes.units import mm

STEPS = 24
"""Intervals of a pitch at first."""
BEYOND = 0.05
"""Facets farther apart than the gap that was measured and this (mm) are of no interest."""
FEWEST_PITCHES = 2.0
"""A motion over fewer pitches is searched as it is."""


@dataclass(frozen=True)
class Gears:
    """Two wheels of a gear pair: their bodies, centres (mm, in the bodies' frames), teeth; a ring is the first."""

    bodies: tuple[str, str]
    centres: tuple[np.ndarray, np.ndarray]
    teeth: tuple[int, int]
    ring: bool

    @property
    def ratio(self) -> float:
        """The second wheel's angle per angle of its centre, both seen from the first wheel."""
        return 1.0 + (-1.0 if self.ring else 1.0) * self.teeth[0] / self.teeth[1]


type Meshes = dict[frozenset[str], list[Gears]]
"""By pair of bodies."""


def meshes(motion: Motion, pieces: list[MeshPiece]) -> Meshes:
    """The gear pairs of a motion, with the numbers of teeth that data.json has, else those of the meshes."""
    by_bodies: Meshes = {}
    for joint in motion.joints.values():
        shape = joint.shape
        if joint.kind != "gear_pair" or shape is None or not shape.radius_first or not shape.radius_second:
            continue
        centres = [np.array(marker[:2]) * mm(1) for marker in shape.markers]
        teeth = list(shape.teeth)
        if not teeth:
            wheels = zip(shape.bodies, centres, (shape.radius_first, shape.radius_second), strict=True)
            teeth = [order(pieces, body, centre, mm(radius)) for body, centre, radius in wheels]
        if min(teeth) > 1 and abs(teeth[0] * shape.radius_second / (teeth[1] * shape.radius_first) - 1) < 1e-9:
            gears = Gears(shape.bodies, (centres[0], centres[1]), (teeth[0], teeth[1]), shape.ring)
            by_bodies.setdefault(frozenset(shape.bodies), []).append(gears)
    return by_bodies


def least_in_mesh(sweep: Sweep, known: Meshes, where: dict[str, BodyPath]) -> Least | None:
    """The least gap of two pieces over the motion, if they are wheels in mesh and one pitch shows it; else None."""
    pieces = {sweep.mover.body: sweep.mover, sweep.still.body: sweep.still}
    for gears in known.get(frozenset(pieces), []):
        first, second = (pieces[body] for body in gears.bodies)
        least = _least(sweep, gears, first, second, where)
        if least is not None:
            return least
    return None


def _least(sweep: Sweep, gears: Gears, first: MeshPiece, second: MeshPiece, where: dict[str, BodyPath]) -> Least | None:
    pitch = 2 * math.pi / gears.teeth[0]
    path = RelativePath(where[second.body], where[first.body], gears.centres[1], sweep.error)
    sides = [piece.triangles[~piece.level] for piece in (first, second)]
    (nearest, farthest), (_, reach) = (
        extent(facets, centre) for facets, centre in zip(sides, gears.centres, strict=True)
    )
    ideal = rolling(path, gears.centres[0], gears.ratio, reach)
    if ideal is None or ideal.span < FEWEST_PITCHES * pitch or ideal.off > RESOLUTION:
        return None
    times = np.linspace(sweep.times[0], sweep.times[-1], FIRST)
    gaps = {float(time): sweep.gap_at(float(time), reach) for time in times}
    best = min(gaps.values())
    if best <= 0:
        return None
    near, apart = best + BEYOND, ideal.distance
    still = turned_union(sides[0], gears.centres[0], gears.teeth[0], (apart - reach - near, apart + reach + near))
    inner = max(apart - farthest, nearest - apart) - near
    mover = turned_union(sides[1], gears.centres[1], gears.teeth[1], (inner, math.inf))
    if still is None or mover is None:
        return None
    off = ideal.off + float(sweep.error.max()) + still.spread + mover.spread
    least = Search(
        FacetTree(still.triangles, gears.centres[0], first.radius),
        FacetTree(mover.triangles - np.append(gears.centres[1], 0.0), np.zeros(2), second.radius),
        _one_pitch(ideal, gears, pitch, off),
        gears.centres[0],
    ).run(best, 0.0, len(gaps))
    if height_between(first, second) < least.gap - RESOLUTION:
        return None
    time = (
        ideal.time_of(ideal.start + pitch * least.time, pitch) if least.gap < best else min(gaps, key=gaps.__getitem__)
    )
    gap = sweep.gap_at(time, reach)
    if gap > least.gap + RESOLUTION + off or least.proven <= 0:
        return None
    return Least(gap, time, min(least.proven, gap), least.poses, off)


def _one_pitch(ideal: Rolling, gears: Gears, pitch: float, off: float) -> RelativePath:
    """The second wheel's frame about its centre, while that goes on by a pitch in a second, seen from the first."""
    time = np.linspace(0.0, 1.0, STEPS + 1)
    angle = ideal.start + pitch * time
    ray = ideal.distance * np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)])
    across = ideal.distance * np.column_stack([-np.sin(angle), np.cos(angle), np.zeros_like(angle)])
    turn = np.array([0.0, 0.0, gears.ratio])
    pose = np.append(gears.centres[0], ideal.turn) + ray + angle[:, None] * turn
    mover = BodyPath(time, pose, pitch * (across + turn), -(pitch**2) * ray)
    nothing = np.zeros_like(pose)
    return RelativePath(mover, BodyPath(time, nothing, nothing, nothing), np.zeros(2), np.full(STEPS, off))
