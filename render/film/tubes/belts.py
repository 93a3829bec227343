"""Belts and chains that run: a round belt with marks, a chain of rollers between plates. As tubes.

The belt moves with the first pulley: what lies on it at the body's angle gamma is r (gamma + theta - phi - beta) along
the path of shared/contract/geometry.py (phi is the direction of the line of centres). Marks and rollers are evenly
spread over the belt. Where the motion has a period, the way of the belt in it is rounded to a whole number of their
distances, so that the film loops without a jump; of a chain whose length is a whole number of its pitch nothing is
rounded. Its inner and outer plates take turns, unless it has an odd number of links or moves on by one in a period.
A belt that an event releases is gone from then on: its tubes shrink to a point.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Poses
from render.film.scene import Point, SurfaceSpec, TubeSpec
from render.film.tubes.stretched import BLACK, STEEL, placed
from shared.contract import Held, Motion, Shape
from shared.contract.geometry import APART, BOLT, LONG, PIN, PLATE, PLATES, PROUD, ROLLER, BeltPath

Array = NDArray[np.float64]
BELT = SurfaceSpec(colour=(0.045, 0.045, 0.05), finish="rubber", roughness=0.55)
MARK = SurfaceSpec(colour=(0.86, 0.5, 0.06), finish="satin", roughness=0.4)
CHAIN = (("roller", STEEL, ROLLER), ("pin", STEEL, BOLT), ("lower plate", BLACK, PLATE), ("upper plate", BLACK, PLATE))
"""Name, surface and radius of what each link has; its plates reach to the next."""
POINTS, MARK_POINTS = 181, 5
"""Numbers of points of a belt's tube and of a mark."""
FEWEST, MOST = 6, 14
"""Marks on a belt."""
OUTER, INNER = 1.0, 0.72
"""Distance of the plates of every other link of a chain from its middle, in PLATES."""


@dataclass(frozen=True)
class Belt:
    """One belt: its path, and how it looks."""

    name: str
    shape: Shape
    path: BeltPath
    z: float
    radius: float
    count: int
    """Number of marks or rollers."""
    chain: bool
    lines: tuple[float, float]
    """Direction of the line of centres at the start and the end of the motion (rad), not wrapped."""
    start: float
    """The first body's angle against that line at the start (rad)."""
    pace: float
    """Factor by which the belt is shown faster than it is."""

    alike: bool
    """True if all links of a chain have the same plates; else every other link's lie inside its neighbours'."""
    until: float = math.inf
    """Time (s) of the event that releases it."""

    @property
    def specs(self) -> list[TubeSpec]:
        """Description of each tube."""
        if not self.chain:
            marks = [
                TubeSpec(name=f"{self.name} mark {k + 1}", surface=MARK, radius=PROUD * self.radius, points=MARK_POINTS)
                for k in range(self.count)
            ]
            return [TubeSpec(name=self.name, surface=BELT, radius=self.radius, points=POINTS), *marks]
        return [
            TubeSpec(name=f"{self.name} {what} {k + 1}", surface=surface, radius=part * self.radius, points=2)
            for what, surface, part in CHAIN
            for k in range(self.count)
        ]

    def paths(self, poses: Poses, at: Moment) -> list[list[Point]]:
        """Return the path of each tube at that moment."""
        place, every = self.run(poses, at)
        if at.time > self.until:
            return [[(*place.origin, self.z)] * spec.points for spec in self.specs]
        if not self.chain:
            reach = LONG * self.radius * np.linspace(-1.0, 1.0, MARK_POINTS)
            return [place.points(self.closed), *(place.points(s + reach) for s in every)]
        seats, ways = place.points(every), []
        for (x, y, z), half in ((seat, half) for half in (self.roller, PIN * self.radius) for seat in seats):
            ways.append([(x, y, z - half), (x, y, z + half)])
        for side in (-1.0, 1.0):
            for k, (start, end) in enumerate(zip(seats, [*seats[1:], seats[0]], strict=True)):
                ways.append([(x, y, z + side * self.aside(k)) for x, y, z in (start, end)])
        return ways

    @property
    def closed(self) -> Array:
        """Lengths (m) of the points of the whole belt."""
        return np.linspace(0.0, self.path.length, POINTS)

    @property
    def roller(self) -> float:
        """Half of a chain's roller's length (m)."""
        return 0.85 * self.aside(1)

    def aside(self, link: int) -> float:
        """Return how far (m) the plates of a link lie from the middle."""
        return PLATES * self.radius * (OUTER if self.alike or link % 2 == 0 else INNER)

    def still(self) -> Placing:
        """Return the placing with its first pulley's centre at the origin, the second on the x axis."""
        return Placing(self, (0.0, 0.0), 0.0)

    def run(self, poses: Poses, at: Moment) -> tuple[Placing, Array]:
        """Return where the belt is at a moment, and the lengths (m) along it of its marks or rollers."""
        first, second = (
            placed(poses.body(body, at), marker)
            for body, marker in zip(self.shape.bodies, self.shape.markers, strict=True)
        )
        line = math.atan2(second[1] - first[1], second[0] - first[0])
        theta = poses.body(self.shape.bodies[0], at)[2]
        whole = round((self.lines[1] - self.lines[0]) / math.tau) if poses.motion.period is not None else 0
        part = (at.time - poses.time[0]) / (poses.time[-1] - poses.time[0])
        guess = self.lines[0] + part * (self.lines[1] - self.lines[0])
        steady = line + math.tau * (round((guess - line) / math.tau) + whole * at.turns)
        begin = self.path.first * (self.start - self.path.beta)
        gone = begin + self.pace * self.path.first * (theta - steady - self.start)
        return Placing(self, first, line), gone + self.path.length / self.count * np.arange(self.count)


@dataclass(frozen=True)
class Placing:
    """From lengths along a belt to points of the world."""

    belt: Belt
    origin: tuple[float, float]
    line: float

    def points(self, along: Array, height: float = 0.0) -> list[Point]:
        """Return places at these lengths, so far over the belt's middle (m)."""
        flat, rest = self.belt.path.places(along)
        c, s = math.cos(self.line), math.sin(self.line)
        over = APART * self.belt.radius * np.sin(np.pi * rest) if self.belt.path.crossed else 0 * rest
        return [
            (self.origin[0] + c * x - s * y, self.origin[1] + s * x + c * y, self.belt.z + height + dz)
            for (x, y), dz in zip(flat.tolist(), over.tolist(), strict=True)
        ]


def belts(motion: Motion, held: Mapping[str, Held]) -> Iterator[Belt]:
    """Yield all belts whose pulleys have a place, if there is room for a path.

    ``held``: the places, by the names of joints.
    """
    time = np.asarray(motion.time)
    for name, joint in motion.joints.items():
        shape, own = joint.shape, held.get(name)
        if joint.look != "band" or shape is None or own is None or not shape.radius_first or not shape.radius_second:
            continue
        places = [
            _places(motion, body, marker, len(time)) for body, marker in zip(shape.bodies, shape.markers, strict=True)
        ]
        way = places[1] - places[0]
        path = BeltPath(shape.radius_first, shape.radius_second, float(np.hypot(*way[0])), shape.crossed)
        if not path.has_room:
            continue
        line = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
        body = motion.bodies.get(shape.bodies[0])
        theta = np.asarray(body.theta) if body else np.zeros(len(time))
        gone = shape.radius_first * float((theta - line)[-1] - (theta - line)[0])
        gone = gone if motion.period is not None else 0.0
        chain = bool(shape.teeth)
        if chain:
            count = max(round(path.length * shape.teeth[0] / (math.tau * shape.radius_first)), 3)
        else:
            count = min(range(FEWEST, MOST + 1), key=lambda n: abs(_pace(gone, path.length / n) - 1))
        yield Belt(
            name, shape, path, own.z, own.radius, count, chain, (float(line[0]), float(line[-1])),
            float(theta[0] - line[0]), _pace(gone, path.length / count),
            alike=count % 2 == 1 or round(gone * count / path.length) % 2 == 1,
            until=math.inf if joint.released is None else joint.released,
        )  # fmt: skip


def _pace(gone: float, apart: float) -> float:
    """Return the factor that makes a path a whole number of distances; 1 where that would be none."""
    whole = round(gone / apart)
    return whole * apart / gone if whole else 1.0


def _places(motion: Motion, name: str, marker: tuple[float, float, float], count: int) -> Array:
    """Return (T, 2) of a marker (m)."""
    body = motion.bodies.get(name)
    if body is None:
        return np.broadcast_to(np.array(marker[:2]), (count, 2))
    c, s = np.cos(body.theta), np.sin(body.theta)
    x, y, _ = marker
    return np.stack([np.array(body.x) + c * x - s * y, np.array(body.y) + s * x + c * y], axis=1)
