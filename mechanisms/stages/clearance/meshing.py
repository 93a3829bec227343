"""Clearance of pieces that work on each other: teeth, rolling discs, and belts on pulleys."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.outlines import FIRST
from mechanisms.stages.clearance.path import BodyPath, RelativePath
from mechanisms.stages.clearance.pieces import FacetTree, MeshPiece, extent, height_between, order, turned_union
from mechanisms.stages.clearance.search import RESOLUTION, Least, Search, Sweep
from shared.contract import Held, JointMotion, Motion, Parts
from shared.contract.geometry import BeltPath, half_height, half_width
from shared.shapes.units import mm

# How near the relative motion of two bodies is to ideal rolling: a circle of centres, turning in a fixed ratio.

PARTS = 8
"""Each interval of data.json is looked at so many times."""


@dataclass(frozen=True)
class Rolling:
    """Ideal rolling of a second body on a first one, seen from the first.

    The second one's centre is at ``distance`` (mm) from a point of the first in the direction phi (rad), and it is
    turned by ``turn + ratio phi``. No point of it is farther from there than ``off`` (mm).
    """

    distance: float
    turn: float
    off: float
    times: np.ndarray
    angles: np.ndarray
    """(n,): phi at these times (s), not wrapped."""

    @property
    def start(self) -> float:
        """The first phi."""
        return float(self.angles[0])

    @property
    def span(self) -> float:
        """How far phi goes."""
        return float(np.ptp(self.angles))

    def time_of(self, angle: float, pitch: float) -> float:
        """Return the first time at which phi is ``angle`` or a number of pitches from it."""
        passed = np.floor((self.angles - angle) / pitch)
        k = int(np.flatnonzero(np.diff(passed) != 0)[0])
        low, high = self.angles[k], self.angles[k + 1]
        there = angle + pitch * max(passed[k], passed[k + 1])
        part = min(max((there - low) / (high - low), 0.0), 1.0)
        return float(self.times[k] + part * (self.times[k + 1] - self.times[k]))


def rolling(path: RelativePath, about: np.ndarray, ratio: float, reach: float) -> Rolling | None:
    """Return ideal rolling about ``about`` (mm, first body's frame) with that ratio, next to the motion.

    It rolls about the point ``about`` (mm, frame of the first body). ``off`` holds for points within ``reach`` (mm) of
    the second body's centre and for all time: at PARTS times in each interval it is looked at, and between them a
    function is within h^2 / 8 max |f''| of the larger of its ends. None where the centre passes through ``about``, or
    samples jump.
    """
    mover = path.mover
    if len(mover.first) + 1 != len(mover.time):
        return None
    count = len(mover.first)
    k = np.repeat(np.arange(count), PARTS)
    time = np.append((mover.start[:, None] + mover.width[:, None] * np.arange(PARTS) / PARTS).ravel(), mover.time[-1])
    pose = path.place(np.append(k, count - 1), time)
    seen = pose[:, :2] - about
    distance = np.hypot(*seen.T)
    if distance.min() < 0.01 * distance.max():
        return None
    angle = np.unwrap(np.arctan2(seen[:, 1], seen[:, 0]))
    left = pose[:, 2] - ratio * angle
    middle, turn = (float(x.min() + x.max()) / 2 for x in (distance, left))
    h, push, spin = np.diff(time), path.push[k], path.spin[k]
    speed = np.hypot(*np.diff(seen, axis=0).T) / h + h / 2 * push
    least = np.minimum(distance[1:], distance[:-1]) - speed * h
    if least.min() <= 0:
        return None
    bend_distance = push + speed**2 / least
    bend_angle = push / least + 2 * speed**2 / least**2
    off = np.maximum(np.abs(distance[1:] - middle), np.abs(distance[:-1] - middle)) + h**2 / 8 * bend_distance
    turned = np.maximum(np.abs(left[1:] - turn), np.abs(left[:-1] - turn)) + h**2 / 8 * (spin + abs(ratio) * bend_angle)
    return Rolling(middle, turn, float((off + reach * turned).max()), time, angle)


# The least gap of two gears in mesh over any number of turns follows from one tooth pitch.
#
# Wheels that roll on each other repeat: seen from the first wheel, turning the second wheel's centre on by one pitch of
# the first turns the second by one pitch of its own as well. So with teeth that are all alike, one pitch shows all
# gaps. Three things make that a proof for the meshes and the motion at hand:
#
# - Each mesh is replaced by the union of its copies turned by all its pitches, which holds the mesh. It is the same
#   after a turn by a pitch, so poses that differ by pitches have the same gap.
# - The motion is compared with ideal rolling, centres ``d`` apart and angles in the ratio of the teeth. What it is off
#   at most, between samples too, is taken off the gap that is proven.
# - Over one pitch of ideal rolling the search of search.py proves the gap of the two unions.
#
# Copies that coincide are one: those of equal teeth as good as vanish. Where wheels are no such wheels (a sector, teeth
# left out), the unions are larger than the meshes, and the whole motion is searched instead.

STEPS = 24
"""Intervals of a pitch at first."""
BEYOND = 0.05
"""Facets farther apart than the gap that was measured and this (mm) are of no interest."""
FEWEST_PITCHES = 2.0
"""A motion over fewer pitches is searched as it is."""


@dataclass(frozen=True)
class Gears:
    """Two wheels of a gear pair: their bodies, centres (mm, in the bodies' frames), teeth.

    A ring is the first.
    """

    bodies: tuple[str, str]
    centres: tuple[np.ndarray, np.ndarray]
    teeth: tuple[int, int]
    ring: bool

    @property
    def ratio(self) -> float:
        """The second wheel's angle per angle of its centre, both seen from the first wheel."""
        return 1.0 + (-1.0 if self.ring else 1.0) * self.teeth[0] / self.teeth[1]


type Meshes = dict[frozenset[str], list[Gears]]
"""Gear pairs by pair of bodies."""


def meshes(motion: Motion, pieces: list[MeshPiece]) -> Meshes:
    """Return the gear pairs of a motion, with numbers of teeth from data.json, else from the meshes."""
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
    """Return the least gap of two wheels in mesh over the motion, if one pitch shows it; else None."""
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
    """Return the second wheel's frame about its centre, seen from the first.

    The centre goes on by a pitch in a second.
    """
    time = np.linspace(0.0, 1.0, STEPS + 1)
    angle = ideal.start + pitch * time
    ray = ideal.distance * np.column_stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)])
    across = ideal.distance * np.column_stack([-np.sin(angle), np.cos(angle), np.zeros_like(angle)])
    turn = np.array([0.0, 0.0, gears.ratio])
    pose = np.append(gears.centres[0], ideal.turn) + ray + angle[:, None] * turn
    mover = BodyPath(time, pose, pitch * (across + turn), -(pitch**2) * ray)
    nothing = np.zeros_like(pose)
    return RelativePath(mover, BodyPath(time, nothing, nothing, nothing), np.zeros(2), np.full(STEPS, off))


# Belts and chains as the check sees them: the band that they run in, as a solid beside the bodies.
#
# A belt lies still against the line of its pulleys' centres, whatever runs round in it. So its band (mm) is a piece of
# a body of its own: the origin is the first pulley's centre, the x axis goes to the second's. It is as wide and high as
# all that the film draws of the belt (shared/contract/geometry.py), strands that cross included.

SAG = 0.02
"""At most so far (mm) the straight sides of the band's outline leave the arcs; it is wider by as much."""


@dataclass(frozen=True)
class Band:
    """One belt."""

    piece: MeshPiece
    path: BodyPath
    axes: dict[str, tuple[np.ndarray, np.ndarray]]
    """Centres by body of a pulley: in the band's frame and in the body's (mm)."""
    own: frozenset[tuple[str, str]]
    """Body and name of the pieces that hold the belt: its pulleys, which it touches."""


def bands(parts: Parts, motion: Motion, where: Mapping[str, BodyPath]) -> Iterator[Band]:
    """Yield bands of all belts that pieces hold, as far as their pulleys leave room for a path.

    The path of a belt that an event releases ends there: with the interval of data.json in which that happens.
    """
    for name, joint in motion.joints.items():
        own, held = _holding(parts, name)
        if joint.look != "band" or held is None or joint.shape is None:
            continue
        shape = joint.shape
        if not shape.radius_first or not shape.radius_second:
            continue
        path, distance = _path(joint, where)
        rows = joint.rows_held(motion.time)
        if joint.released is not None and rows:
            rows += motion.time[rows - 1] < joint.released
        if rows < 2 or motion.time[rows - 1] == motion.time[0]:
            continue
        way = BeltPath(mm(shape.radius_first), mm(shape.radius_second), distance, shape.crossed)
        if not way.has_room:
            continue
        chain = bool(shape.teeth)
        wide, high = (
            mm(held.radius) * size for size in (half_width(1.0, chain), half_height(1.0, chain, shape.crossed))
        )
        triangles = band(way, wide, high) + np.array([0.0, 0.0, mm(held.z)])
        ends = [np.zeros(2), np.array([distance, 0.0])]
        axes = {
            body: (end, np.array([mm(marker[0]), mm(marker[1])]))
            for body, marker, end in zip(shape.bodies, shape.markers, ends, strict=True)
        }
        yield Band(MeshPiece(f"belt {name}", name, triangles), path.until(rows), axes, own)


def band(way: BeltPath, wide: float, high: float) -> np.ndarray:
    """Return (n, 3, 3) facets round all places within ``wide`` of the belt and ``high`` over and under it."""
    import manifold3d

    starts = np.concatenate([[0.0], np.cumsum(way.parts)])
    along = [starts[1], starts[3]]  # where strands begin
    for begins, ends, radius in ((0, 1, way.first), (2, 3, way.second)):
        steps = math.ceil((starts[ends] - starts[begins]) / (2 * math.sqrt(2 * SAG * radius)))
        along.extend(np.linspace(starts[begins], starts[ends], max(steps, 8), endpoint=False))
    points, _ = way.places(np.unique(along))
    loop = manifold3d.CrossSection([points], manifold3d.FillRule.NonZero)
    outer, inner = (loop.offset(side * (wide + SAG), manifold3d.JoinType.Miter, 2.0) for side in (1.0, -1.0))
    solid = (outer - inner).extrude(2 * high).translate((0.0, 0.0, -high))
    mesh = solid.to_mesh64()
    return np.asarray(mesh.vert_properties)[:, :3][np.asarray(mesh.tri_verts).astype(np.int64)]


def _holding(parts: Parts, name: str) -> tuple[frozenset[tuple[str, str]], Held | None]:
    held = {
        (body, piece_name): piece.holds[name]
        for body, solids in parts.bodies.items()
        for piece_name, piece in solids.pieces.items()
        if name in piece.holds
    }
    return frozenset(held), next(iter(held.values()), None)


def _path(joint: JointMotion, where: Mapping[str, BodyPath]) -> tuple[BodyPath, float]:
    """Return the motion of the first centre and of the line of centres, and their distance (mm).

    The distance is that at the start.
    """
    assert joint.shape is not None
    ends = [
        _centre(where[body], mm(x), mm(y))
        for body, (x, y, _) in zip(joint.shape.bodies, joint.shape.markers, strict=True)
    ]
    (place, rate, acceleration), (d, dv, da) = ends[0], (b - a for a, b in zip(*ends, strict=True))
    square = (d**2).sum(axis=1)
    turn = np.unwrap(np.arctan2(d[:, 1], d[:, 0]))
    spin = _cross(d, dv) / square
    more = _cross(d, da) / square - 2 * (d * dv).sum(axis=1) * spin / square
    columns = [np.column_stack([xy, angle]) for xy, angle in ((place, turn), (rate, spin), (acceleration, more))]
    return BodyPath(where["ground"].time, *columns), float(np.sqrt(square[0]))


def _centre(path: BodyPath, x: float, y: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (n, 2) each: place, velocity and acceleration of a point of a body."""
    c, s = np.cos(path.pose[:, 2]), np.sin(path.pose[:, 2])
    arm = np.column_stack([c * x - s * y, s * x + c * y])
    across = np.column_stack([-arm[:, 1], arm[:, 0]])
    omega, alpha = path.rate[:, 2:], path.acceleration[:, 2:]
    return (
        path.pose[:, :2] + arm,
        path.rate[:, :2] + omega * across,
        path.acceleration[:, :2] + alpha * across - omega**2 * arm,
    )


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
