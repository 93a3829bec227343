"""The numbers of each kind of group (mbsd/kinematics/groups/groups.py) at the closed pose of the start.

All but the branch are linear in the places of the markers, which mbsd/kinematics/batch.py relies on.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mbsd.equations.system import System
from mbsd.kinematics.groups.groups import BRANCH, DRIVEN, PRP, ROD, RPR, RRP, RRR, SLIDE, WELDED, YOKE

Vector = tuple[float, float]


class Link(NamedTuple):
    """A joint or driver seen from one of its bodies."""

    joint: int
    kind: str
    here: int
    """Marker on this body."""
    there: int
    """Marker on the other."""
    first: bool
    """This body is the joint's first."""
    other: int
    """The other body."""
    offset: float
    """Of its angle row: theta_j - theta_i (rad); of a rod its length (m)."""
    motion: int


class Numbers:
    """Kind, bodies, law and numbers of a group from the links that hold it; None where it is none after all."""

    def __init__(self, system: System, pose: np.ndarray) -> None:
        self.system, self.pose = system, pose

    def _arm(self, marker: int) -> list[float]:
        return [float(value) for value in self.system.marker_arm[marker]]

    def _axis(self, marker: int) -> Vector:
        x, y = self.system.marker_axis[marker]
        return float(x), float(y)

    def _world(self, body: int, arm: list[float]) -> np.ndarray:
        return self.pose[body, :2] + _turned(arm, float(self.pose[body, 2]))

    def driven(self, body: int, pin: Link, drive: Link):
        """A body pinned to a known one, its angle driven."""
        sense = -1.0 if drive.first else 1.0
        numbers = [*self._arm(pin.there), *self._arm(pin.here), drive.offset, sense]
        return DRIVEN, (body, -1, pin.other, drive.other), drive.motion, numbers

    def welded(self, body: int, weld: Link):
        """A body fixed to a known one."""
        angle = -weld.offset if weld.first else weld.offset
        return WELDED, (body, -1, weld.other, 0), 0, [*self._arm(weld.there), *self._arm(weld.here), angle]

    def rrr(self, a: int, b: int, outer_a: Link, inner: Link, outer_b: Link):
        """Two bodies pinned to known ones and to each other."""
        numbers = [
            *self._arm(outer_a.there),
            *self._arm(outer_a.here),
            *self._arm(inner.here),
            *self._arm(outer_b.there),
            *self._arm(outer_b.here),
            *self._arm(inner.there),
        ]
        p, q, c = self._world(a, numbers[2:4]), self._world(b, numbers[8:10]), self._world(a, numbers[4:6])
        branch = math.copysign(1.0, _cross(q - p, c - p))
        return RRR, (a, b, outer_a.other, outer_b.other), 0, [*numbers, branch]

    def rrp(self, a: int, pin: Link, inner: Link | None, slide: Link, b: int | None):
        """``slide`` is seen from the sliding body b, or, without one, from a whose point runs in the slot."""
        if inner is None or b is None:
            base = self._arm(slide.there)
            axis = self._axis(slide.there)
            c_on_a, angle, c_on_b, sliding = self._arm(slide.here), 0.0, [0.0, 0.0], -1
        else:
            angle = -slide.offset if slide.first else slide.offset
            c_on_a, c_on_b, sliding = self._arm(inner.here), self._arm(inner.there), b
            reach = np.array(c_on_b) - self._arm(slide.here)
            base = list(np.array(self._arm(slide.there)) + _turned(reach, angle))
            axis = _turned(self._axis(slide.here), angle) if slide.first else self._axis(slide.there)
        k2 = slide.other
        numbers = [*self._arm(pin.there), *self._arm(pin.here), *c_on_a, *base, *axis, angle, *c_on_b]
        p, c = self._world(a, numbers[2:4]), self._world(a, c_on_a)
        along = _turned(axis, float(self.pose[k2, 2]))
        branch = math.copysign(1.0, float(np.dot(c - p, along)))
        return RRP, (a, sliding, pin.other, k2), 0, [float(x) for x in numbers] + [branch]

    def rpr(self, a: int, pin: Link, slide: Link, outer: Link | None):
        """``slide`` is seen from a; without ``outer`` it is a slot of a in which a point of a known body runs."""
        if outer is None:
            axis, angle, q_on_b, sliding = self._axis(slide.here), 0.0, [0.0, 0.0], -1
            start = np.array(self._arm(slide.here)) - self._arm(pin.here)
            k2, q_on_k2 = slide.other, self._arm(slide.there)
        else:
            angle = slide.offset if slide.first else -slide.offset
            axis = self._axis(slide.here) if slide.first else _turned(self._axis(slide.there), angle)
            q_on_b, sliding, k2, q_on_k2 = self._arm(outer.here), slide.other, outer.other, self._arm(outer.there)
            reach = _turned(np.array(q_on_b) - self._arm(slide.there), angle)
            start = np.array(self._arm(slide.here)) - self._arm(pin.here) + reach
        offset = axis[0] * start[1] - axis[1] * start[0]
        numbers = [*self._arm(pin.there), *self._arm(pin.here), *axis, offset, *q_on_k2, angle, *q_on_b]
        p, q = self._world(a, numbers[2:4]), self._world(k2, list(q_on_k2))
        branch = math.copysign(1.0, float(np.dot(q - p, _turned(axis, float(self.pose[a, 2])))))
        return RPR, (a, sliding, pin.other, k2), 0, [float(x) for x in numbers] + [branch]

    def yoke(self, a: int, slide: Link, slot: Link):
        """A sliding body in whose slot a point of a known body runs."""
        angle = -slide.offset if slide.first else slide.offset
        axis = _turned(self._axis(slide.here), angle) if slide.first else self._axis(slide.there)
        slot_on_a = self._arm(slot.here)
        base = np.array(self._arm(slide.there)) + _turned(np.array(slot_on_a) - self._arm(slide.here), angle)
        u = _turned(self._axis(slot.here), angle)
        if abs(-u[1] * axis[0] + u[0] * axis[1]) < 1e-9:
            return None
        numbers = [*base, *axis, -u[1], u[0], *self._arm(slot.there), angle, *slot_on_a]
        return YOKE, (a, -1, slide.other, slot.other), 0, [float(x) for x in numbers]

    def prp(self, a: int, slide: Link, inner: Link | None, second: Link, b: int | None):
        """``second`` is the slide of b, or, without b, a slot of a known body in which a point of a runs."""
        c_on_a = self._arm(second.here if inner is None else inner.here)
        numbers = [*self._on_slide(slide, c_on_a), *c_on_a]
        if inner is None or b is None:
            numbers += [*self._arm(second.there), *self._axis(second.there), 0.0, 0.0, 0.0]
            b = -1
        else:
            c_on_b = self._arm(inner.there)
            numbers += [*self._on_slide(second, c_on_b), *c_on_b]
        return PRP, (a, b, slide.other, second.other), 0, [float(x) for x in numbers]

    def _on_slide(self, slide: Link, arm: list[float]) -> list[float]:
        """Where the point with ``arm`` of a sliding body is on the other body at slide 0, the axis there, the angle."""
        angle = -slide.offset if slide.first else slide.offset
        axis = _turned(self._axis(slide.here), angle) if slide.first else self._axis(slide.there)
        base = np.array(self._arm(slide.there)) + _turned(np.array(arm) - self._arm(slide.here), angle)
        return [*base, *axis, angle]

    def pin(self, pin: Link) -> list[float]:
        """P on K1, P on A."""
        return [*self._arm(pin.there), *self._arm(pin.here)]

    def hanging(self, link: Link) -> list[float]:
        """Of a body of a block (mbsd/kinematics/groups/blocks.py) that hangs by a pin, a slide or a weld."""
        arm = self._arm(link.here)
        if link.kind == "P":
            return [float(x) for x in (*self._on_slide(link, arm), *arm)]
        return [*self._arm(link.there), 1.0, 0.0, -link.offset if link.first else link.offset, *arm]

    def rod(self, a: int, pin: Link, rod: Link):
        """A pinned body held by a rod or an actuator."""
        numbers = [
            *self._arm(pin.there),
            *self._arm(pin.here),
            *self._arm(rod.here),
            *self._arm(rod.there),
            rod.offset,
        ]
        p, q, c = self._world(a, numbers[2:4]), self._world(rod.other, numbers[6:8]), self._world(a, numbers[4:6])
        branch = math.copysign(1.0, _cross(q - p, c - p))
        return ROD, (a, -1, pin.other, rod.other), rod.motion, [*numbers, branch]

    def slide(self, a: int, slide: Link, drive: Link):
        """A sliding body whose way along the slide is driven."""
        point = self._arm(drive.here)
        x, y, ex, ey, angle = self._on_slide(slide, point)
        u = -_turned(self._axis(drive.here), angle) if drive.first else np.array(self._axis(drive.there))
        along = float(u @ (ex, ey))
        if abs(along) < 1e-9:
            return None
        way = np.array([ex, ey]) / along
        base = np.array([x, y]) - way * float(u @ (np.array([x, y]) - self._arm(drive.there)))
        return SLIDE, (a, -1, slide.other, 0), drive.motion, [float(v) for v in (*base, *way, angle, *point)]


def _turned(vector, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


assert set(BRANCH) == {RRR, RRP, RPR, ROD}
