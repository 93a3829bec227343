"""Joints that serve as independent coordinates: angles of hinges, ways of slides between a known body and a new one.

The program takes the mechanism apart from ground on; wherever no group and no wheel of a gear train can be added it
takes the next hinge or slide as a coordinate, and goes back where that leads nowhere. Of the choices that come to an
end it keeps the first under which no body moves much faster than its coordinate, or else the best. Blocks, whose bodies
Newton-Raphson places (blocks/), are added only where closed forms alone come to no end. States of forces are the last
coordinates in every choice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.kinematics.groups.blocks import BLOCK
from mbsd.kinematics.groups.groups import SLIDE, Link
from mbsd.kinematics.groups.kinds.slide import ANGLE, G_X, S1_X, SA_X
from mbsd.kinematics.groups.kinds.train import train
from mbsd.kinematics.groups.parts import Tables, fixed_bodies, hanging, tables_of
from mbsd.kinematics.groups.plan import Plan, link_kind, links_of_joints
from mbsd.kinematics.groups.trains import Trains
from mbsd.kinematics.prepared import sample_jacobians

MOST = 6
"""More coordinates than this are solved faster by multipliers."""
TRIALS = 200
"""Joints tried altogether."""
CHOICES = 12
"""Plans compared."""
ALONG_X = 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0
"""Numbers of a slide (mbsd/kinematics/groups/kinds/slide.py) of a body's origin along the x axis of ground."""


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


def coordinates_along(coordinates: Sequence[Coordinate], q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return (R, 2, 3 + f) independent coordinates and their rates at q, v (R, 3 nb)."""
    out = np.zeros((len(q), 2, 3 + len(coordinates)))
    for k, coordinate in enumerate(coordinates):
        if coordinate.slide is None:
            i, j = 3 * coordinate.body + 2, 3 * coordinate.other + 2
            out[:, 0, 3 + k], out[:, 1, 3 + k] = q[:, i] - q[:, j], v[:, i] - v[:, j]
        else:
            out[:, 0, 3 + k] = [coordinate.at(row) for row in q]
            out[:, 1, 3 + k] = [coordinate.rate(*row) for row in zip(q, v, strict=True)]
    return out


@dataclass(frozen=True)
class Choice:
    """Coordinates, and all bodies placed by them."""

    plan: Plan
    """Law -k of a group is coordinate k."""
    blocks: tuple[Tables, ...] = ()


def choices(packed: Packed, q: np.ndarray, count: int) -> Iterator[Choice]:
    """Complete choices of ``count`` coordinates, with states, at a closed pose q (3 nb,); without blocks if any are."""
    if not 0 < count <= MOST:
        return
    everything = range(len(packed.joints))
    trains = _Trains(packed, q, [joint for joint in everything if link_kind(packed.joints[joint]) is None])
    for blocks in (False, True):
        if not blocks and not trains.possible:
            continue
        start = Choice(Plan(packed, q.reshape(-1, 3), links_of_joints(packed, everything)))
        _take_states(start.plan, count)
        complete = _complete(start, trains, count - packed.states, 0, [TRIALS], blocks)
        first = next(complete, None)
        if first is not None:
            yield first
            yield from islice(complete, CHOICES - 1)
            return


def _take_states(plan: Plan, count: int) -> None:
    """The bodies that hold states slide along the x axis of ground, each as its coordinate says."""
    states = plan.packed.states
    for k in range(states):
        body = len(plan.links) - states + k
        plan.add_group((SLIDE, (body, -1, 0, 0), states - count - k - 1, list(ALONG_X)), (body,))


def coordinates_of(plan: Plan, count: int) -> list[Coordinate]:
    """Coordinates of a complete plan."""
    out: list[Coordinate | None] = [None] * count
    for kind, bodies, motion, numbers in plan.taken:
        if motion < 0:
            slide = kind == SLIDE
            out[-motion - 1] = Coordinate(bodies[0], bodies[2 if slide else 3], np.array(numbers) if slide else None)
    return [coordinate for coordinate in out if coordinate is not None]


class _Trains:
    """Gears, belts and locks, of which each gives one more angle as a sum of known ones."""

    def __init__(self, packed: Packed, q: np.ndarray, joints: list[int]) -> None:
        self.row_of = {joint: packed.rows_of(joint).start for joint in joints}
        self.trains = Trains(packed, q) if joints else None
        self.possible = self.trains is None or all(
            len(packed.rows_of(joint)) == 1 and row in self.trains.rows for joint, row in self.row_of.items()
        )

    def add(self, plan: Plan) -> bool:
        """Add a wheel on a known body, if there is one."""
        for joint, row in self.row_of.items():
            if joint in plan.used or self.trains is None:
                continue
            unknown = [body for body in self.trains.rows.get(row, ()) if body not in plan.known]
            if len(unknown) != 1:
                continue
            body = unknown[0]
            holding = [link for link in plan.links[body] if link.other in plan.known]
            if [link.kind for link in holding] != ["R"] or not self.trains.solve([row], [body], {}):
                continue
            angle_sum = self.trains.sums[body]
            made = train(plan.places, body, holding[0], angle_sum.constant, angle_sum.shares)
            if made is not None:
                plan.used |= {joint, holding[0].joint}
                plan.add_group(made, (body,))
                return True
        return False


def _complete(
    choice: Choice, trains: _Trains, count: int, taken: int, left: list[int], blocks: bool
) -> Iterator[Choice]:
    plan = choice.plan
    while True:
        plan.grow()
        if trains.add(plan):
            continue
        added = _with_block(choice) if blocks else None
        if added is None:
            break
        choice = added
    if taken == count:
        if plan.complete:
            yield choice
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
            yield from _complete(replace(choice, plan=trial), trains, count, taken + 1, left, blocks)


def _with_block(choice: Choice) -> Choice | None:
    """With the smallest block that the joints left fix, or None where they fix none."""
    plan = choice.plan
    packed = plan.packed
    if len(plan.known) == len(plan.links):
        return None
    open_joints = [joint for joint in range(len(packed.joints)) if joint not in plan.used]
    left = [row for joint in open_joints for row in packed.rows_of(joint)]
    inner = [row for row in left if any(int(body) not in plan.known for body in packed.system.row_body[row])]
    members = fixed_bodies(packed, plan.known, inner, (sample_jacobians(packed) != 0.0).any(axis=0))
    block = None if members is None else hanging(plan, members, inner)
    tables = None if block is None else tables_of(plan, block)
    if block is None or tables is None:
        return None
    plan.used |= {joint for joint in open_joints if {*packed.rows_of(joint)} <= {*block.rows}}
    bodies = [body for body, _, _ in block.tree]
    plan.add_group((BLOCK, (bodies[0], -1, 0, 0), len(choice.blocks), []), bodies)
    return replace(choice, blocks=(*choice.blocks, tables))


def _turned(vector: np.ndarray, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def _perp(vector: np.ndarray) -> np.ndarray:
    return np.array([-vector[1], vector[0]])
