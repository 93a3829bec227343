"""Takes a mechanism apart into groups, beginning at ground: each time the first group whose neighbours are known.

A mechanism with anything that no group covers (a rod, a gear, a redundant joint) has no such plan and is solved by
Newton-Raphson as a whole.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mbsd.assur.groups import BRANCH, DRIVEN, NAMES, NUMBERS, RPR, RRP, RRR, WELDED, YOKE, Groups
from mbsd.packing import Packed

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
    """Of its angle row: theta_j - theta_i (rad)."""
    motion: int


COVERED = {
    ("point",): "R",
    ("slot", "angle"): "P",
    ("point", "angle"): "W",
    ("slot",): "S",
    ("angle",): "D",
}


def plan_groups(packed: Packed, q0: np.ndarray, redundant_rows: int) -> Groups | None:
    """The groups of a mechanism at its closed pose q0 (3 nb,), or None where it has no such plan."""
    if redundant_rows:
        return None
    links = _links(packed)
    if links is None:
        return None
    plan = _Plan(packed, q0.reshape(-1, 3), links)
    while len(plan.known) < len(packed.body_names):
        if not (plan.add_single() or plan.add_pair()):
            return None
    if len(plan.used) != len(packed.joints):
        return None
    return Groups(
        np.array([kind for kind, _, _, _ in plan.groups], np.int64),
        np.array([bodies for _, bodies, _, _ in plan.groups], np.int64).reshape(-1, 4),
        np.array([motion for _, _, motion, _ in plan.groups], np.int64),
        np.array([numbers + [0.0] * (NUMBERS - len(numbers)) for _, _, _, numbers in plan.groups], float),
    )


def describe(groups: Groups, names: list[str]) -> str:
    """What the plan is, for people: ``driven crank; RRR coupler, rocker``."""
    parts = []
    for kind, bodies in zip(groups.kind, groups.body, strict=True):
        parts.append(f"{NAMES[kind]} {', '.join(names[b] for b in bodies[:2] if b >= 0)}")
    return "; ".join(parts)


def _links(packed: Packed) -> list[list[Link]] | None:
    """(nb,) links of each body; None if a joint is of a kind that no group covers."""
    system = packed.system
    links: list[list[Link]] = [[] for _ in packed.body_names]
    angle_at = {int(row[2]): k for k, row in enumerate(system.angle)}
    for number, joint in enumerate(packed.joints):
        kind = COVERED.get(tuple(joint.kind.constraints))
        if kind is None or (kind == "D") != joint.kind.driven:
            return None
        i, j = (int(marker) for marker in packed.markers[number])
        offset, motion = 0.0, 0
        for row in range(packed.first_row[number], packed.first_row[number + 1]):
            if row in angle_at:
                offset = float(system.angle_offset[angle_at[row]])
                motion = int(system.angle[angle_at[row], 3])
        bi, bj = int(system.marker_body[i]), int(system.marker_body[j])
        links[bi].append(Link(number, kind, i, j, True, bj, offset, motion))
        links[bj].append(Link(number, kind, j, i, False, bi, offset, motion))
    return links


class _Plan:
    """The plan as it grows."""

    def __init__(self, packed: Packed, pose: np.ndarray, links: list[list[Link]]) -> None:
        self.packed, self.pose, self.links = packed, pose, links
        self.known, self.used = {0}, set[int]()
        self.groups: list[tuple[int, tuple[int, int, int, int], int, list[float]]] = []

    def add_single(self) -> bool:
        """Add a group of one body, if there is one."""
        for body in range(1, len(self.links)):
            if body in self.known:
                continue
            links = [link for link in self.links[body] if link.other in self.known]
            kinds = "".join(sorted(link.kind for link in links))
            by_kind = {link.kind: link for link in links}
            made = None
            if kinds == "DR":
                made = self._driven(body, by_kind["R"], by_kind["D"])
            elif kinds == "W":
                made = self._welded(body, by_kind["W"])
            elif kinds == "RS":
                pin, slot = by_kind["R"], by_kind["S"]
                made = self._rpr(body, pin, slot, None) if slot.first else self._rrp(body, pin, None, slot, None)
            elif kinds == "PS" and by_kind["S"].first:
                made = self._yoke(body, by_kind["P"], by_kind["S"])
            if made is not None:
                self._take(made, (body,), links)
                return True
        return False

    def add_pair(self) -> bool:
        """Add a group of two bodies, if there is one."""
        for a in range(1, len(self.links)):
            if a in self.known:
                continue
            outer_a = [link for link in self.links[a] if link.other in self.known]
            if len(outer_a) != 1 or outer_a[0].kind != "R":
                continue
            for inner in self.links[a]:
                b = inner.other
                if b in self.known or b == a:
                    continue
                outer_b = [link for link in self.links[b] if link.other in self.known]
                between = [link for link in self.links[a] if link.other == b]
                if len(outer_b) != 1 or len(between) != 1:
                    continue
                made = None
                if inner.kind == "R" and outer_b[0].kind == "R":
                    made = self._rrr(a, b, outer_a[0], inner, outer_b[0])
                elif inner.kind == "R" and outer_b[0].kind == "P":
                    made = self._rrp(a, outer_a[0], inner, outer_b[0], b)
                elif inner.kind == "P" and outer_b[0].kind == "R":
                    made = self._rpr(a, outer_a[0], inner, outer_b[0])
                if made is not None:
                    self._take(made, (a, b), [*outer_a, inner, *outer_b])
                    return True
        return False

    def _take(self, made: tuple, bodies: tuple[int, ...], links: list[Link]) -> None:
        self.groups.append(made)
        self.known.update(bodies)
        self.used.update(link.joint for link in links)

    # -- the numbers of each kind -----------------------------------------------------------------------------------

    def _arm(self, marker: int) -> list[float]:
        return [float(value) for value in self.packed.system.marker_arm[marker]]

    def _axis(self, marker: int) -> Vector:
        x, y = self.packed.system.marker_axis[marker]
        return float(x), float(y)

    def _world(self, body: int, arm: list[float]) -> np.ndarray:
        return self.pose[body, :2] + _turned(arm, float(self.pose[body, 2]))

    def _driven(self, body: int, pin: Link, drive: Link):
        sense = -1.0 if drive.first else 1.0
        numbers = [*self._arm(pin.there), *self._arm(pin.here), drive.offset, sense]
        return DRIVEN, (body, -1, pin.other, drive.other), drive.motion, numbers

    def _welded(self, body: int, weld: Link):
        angle = -weld.offset if weld.first else weld.offset
        return WELDED, (body, -1, weld.other, 0), 0, [*self._arm(weld.there), *self._arm(weld.here), angle]

    def _rrr(self, a: int, b: int, outer_a: Link, inner: Link, outer_b: Link):
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

    def _rrp(self, a: int, pin: Link, inner: Link | None, slide: Link, b: int | None):
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

    def _rpr(self, a: int, pin: Link, slide: Link, outer: Link | None):
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

    def _yoke(self, a: int, slide: Link, slot: Link):
        angle = -slide.offset if slide.first else slide.offset
        axis = _turned(self._axis(slide.here), angle) if slide.first else self._axis(slide.there)
        slot_on_a = self._arm(slot.here)
        base = np.array(self._arm(slide.there)) + _turned(np.array(slot_on_a) - self._arm(slide.here), angle)
        u = _turned(self._axis(slot.here), angle)
        if abs(-u[1] * axis[0] + u[0] * axis[1]) < 1e-9:
            return None
        numbers = [*base, *axis, -u[1], u[0], *self._arm(slot.there), angle, *slot_on_a]
        return YOKE, (a, -1, slide.other, slot.other), 0, [float(x) for x in numbers]


def _turned(vector, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def _cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


assert set(BRANCH) == {RRR, RRP, RPR}
