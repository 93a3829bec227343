"""Which joints serve as independent coordinates: angles of hinges, ways of slides between a known body and a new one.

The program takes the mechanism apart from ground on; wherever no group can be added it takes the next hinge or slide as
a coordinate, and goes back where that leads nowhere. Of the choices that come to an end it keeps the first under which
no body moves much faster than its coordinate, or else the best.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.kinematics.groups.groups import SLIDE
from mbsd.kinematics.groups.kinds.slide import ANGLE, G_X, S1_X, SA_X
from mbsd.kinematics.groups.links import Link
from mbsd.kinematics.groups.plan import Plan, links_of

MOST = 6
"""More coordinates than this are solved faster by multipliers."""
TRIALS = 200
"""Joints tried altogether."""
CHOICES = 12
"""Plans compared."""


@dataclass(frozen=True)
class Coordinate:
    """One independent coordinate: angle of a body against another, or its way along a slide."""

    body: int
    other: int
    slide: np.ndarray | None
    """(7,) numbers of a driven slide (mbsd/kinematics/groups/kinds/slide.py), or None for an angle."""

    def at(self, q: np.ndarray) -> float:
        """Its value (rad, m) at q (3 nb,)."""
        pose = q.reshape(-1, 3)
        if self.slide is None:
            return float(pose[self.body, 2] - pose[self.other, 2])
        way, reach = self._reach(pose)
        return float(way @ reach / (way @ way))

    def rate(self, q: np.ndarray, v: np.ndarray) -> float:
        """Its rate (rad/s, m/s)."""
        pose, speed = q.reshape(-1, 3), v.reshape(-1, 3)
        if self.slide is None:
            return float(speed[self.body, 2] - speed[self.other, 2])
        way, reach = self._reach(pose)
        point, base = self._arms(pose)
        relative = speed[self.body, :2] + speed[self.body, 2] * _perp(point)
        relative = relative - speed[self.other, :2] - speed[self.other, 2] * _perp(base + reach)
        return float(way @ relative / (way @ way))

    def _arms(self, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        assert self.slide is not None
        return _turned(self.slide[SA_X:], pose[self.body, 2]), _turned(self.slide[S1_X:G_X], pose[self.other, 2])

    def _reach(self, pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        assert self.slide is not None
        point, base = self._arms(pose)
        reach = pose[self.body, :2] + point - pose[self.other, :2] - base
        return _turned(self.slide[G_X:ANGLE], pose[self.other, 2]), reach


def choices(packed: Packed, q: np.ndarray, count: int) -> Iterator[Plan]:
    """Complete plans with ``count`` coordinates at a closed pose q (3 nb,); law -k of a group is coordinate k."""
    links = links_of(packed)
    if links is None or not 0 < count <= MOST:
        return
    left = [TRIALS]
    yield from islice(_complete(Plan(packed, q.reshape(-1, 3), links), count, 0, left), CHOICES)


def coordinates_of(plan: Plan, count: int) -> list[Coordinate]:
    """Of a complete plan."""
    out: list[Coordinate | None] = [None] * count
    for kind, bodies, motion, numbers in plan.taken:
        if motion < 0:
            slide = kind == SLIDE
            out[-motion - 1] = Coordinate(bodies[0], bodies[2 if slide else 3], np.array(numbers) if slide else None)
    return [one for one in out if one is not None]


def _complete(plan: Plan, count: int, taken: int, left: list[int]) -> Iterator[Plan]:
    plan.grow()
    if taken == count:
        if plan.complete:
            yield plan
        return
    for body in range(1, len(plan.links)):
        if body in plan.known:
            continue
        for link in plan.links[body]:
            if link.other not in plan.known or link.kind not in "RP":
                continue
            left[0] -= 1
            if left[0] < 0:
                return
            trial = plan.copy()
            joint = len(plan.packed.joints) + taken
            if link.kind == "R":
                drive = Link(joint, "D", link.here, link.there, False, link.other, 0.0, -taken - 1)
            else:
                drive = Link(joint, "A", link.here, link.there, link.first, link.other, 0.0, -taken - 1)
            trial.hold(body, [drive])
            yield from _complete(trial, count, taken + 1, left)


def _turned(vector: np.ndarray, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def _perp(vector: np.ndarray) -> np.ndarray:
    return np.array([-vector[1], vector[0]])
