"""Massless links of joints in space as bodies of the motion: rods and crosses, with their rates.

A link's frame follows from the markers of its joint, so its rates and accelerations follow from theirs: every vector
here is known with both derivatives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from shared.contract.parts import Link, Parts
from shared.contract.quaternions import matrices, quaternion_of
from shared.contract.space import BodyMotion3, Motion3, Vector3, columns
from shared.stage.errors import UserError

Array = NDArray[np.float64]
SHORTEST = 1e-9
"""Least distance of the two places of a rod (m)."""
INK, INK_ON_DARK = "#66717b", "#b5bec7"


@dataclass(frozen=True)
class Changing:
    """Vectors over time, (T, 3) or (T, 1), with their first and second derivatives."""

    value: Array
    rate: Array
    bend: Array

    def __add__(self, other: Changing) -> Changing:
        return Changing(self.value + other.value, self.rate + other.rate, self.bend + other.bend)

    def __sub__(self, other: Changing) -> Changing:
        return Changing(self.value - other.value, self.rate - other.rate, self.bend - other.bend)

    def times(self, number: Changing) -> Changing:
        """Return these vectors times numbers (T, 1)."""
        return self._product(number, np.multiply)

    def cross(self, other: Changing) -> Changing:
        """Return the cross product of two vectors."""
        return self._product(other, np.cross)

    def dot(self, other: Changing) -> Changing:
        """Return the dot product (T, 1) of two vectors."""
        return self._product(other, lambda a, b: (a * b).sum(axis=1, keepdims=True))

    def unit(self) -> Changing:
        """Return the vectors divided by their lengths."""
        square = self.dot(self)
        power = square.value**-0.5
        rate = -0.5 * square.rate * power**3
        bend = -0.5 * square.bend * power**3 + 0.75 * square.rate**2 * power**5
        return self.times(Changing(power, rate, bend))

    def _product(self, other: Changing, rule: Callable[[Array, Array], Array]) -> Changing:
        both = 2.0 * rule(self.rate, other.rate)
        return Changing(
            rule(self.value, other.value),
            rule(self.rate, other.value) + rule(self.value, other.rate),
            rule(self.bend, other.value) + both + rule(self.value, other.bend),
        )


def with_links(motion: Motion3, parts: Parts) -> Motion3:
    """Return the motion with a body for each massless link of the parts.

    Raises UserError for a link that has the name of a body, whose joint is missing, or whose ends meet.
    """
    links = {name: body.link for name, body in parts.bodies.items() if body.link}
    if not links:
        return motion
    for name, link in links.items():
        if name in motion.bodies:
            raise UserError(f"{motion.mechanism}: parts.json has a link '{name}', and data.json a body of that name")
        if link.joint not in motion.joints:
            raise UserError(f"{motion.mechanism}: the link '{name}' of parts.json has no joint '{link.joint}'")
    bodies = {name: _link(name, link, motion) for name, link in links.items()}
    return msgspec.structs.replace(motion, bodies=motion.bodies | bodies)


def _link(name: str, link: Link, motion: Motion3) -> BodyMotion3:
    joint = motion.joints[link.joint]
    ends = list(zip(joint.bodies, joint.markers, strict=True))
    (first, axis), (second, other) = (
        (place_of(motion, body, marker.place), direction_of(motion, body, marker.axis)) for body, marker in ends
    )
    if joint.kind == "universal":
        return _moving(first, (axis, other, axis.cross(other)))
    way = second - first
    length = np.linalg.norm(way.value, axis=1)
    if length.min() < SHORTEST:
        at = motion.time[int(length.argmin())]
        raise UserError(f"{motion.mechanism}: both ends of the link '{name}' are on one place at t={at:.4g} s")
    x, near = way.unit(), direction_of(motion, link.body, link.z)
    z = (near - x.times(near.dot(x))).unit()
    return _moving(first, (x, z.cross(x), z))


def place_of(motion: Motion3, body: str, point: Vector3) -> Changing:
    """Return the place of a point of a body in the world (m)."""
    turned = direction_of(motion, body, point)
    if body == "ground":
        return turned
    moved = motion.bodies[body]
    return Changing(moved.place, columns(moved, "vx", "vy", "vz"), columns(moved, "ax", "ay", "az")) + turned


def direction_of(motion: Motion3, body: str, direction: Vector3) -> Changing:
    """Return a direction of a body in the world."""
    if body == "ground":
        still = np.zeros((len(motion.time), 3))
        return Changing(still + np.array(direction), still, still)
    moved = motion.bodies[body]
    value = matrices(moved.quaternion) @ np.array(direction)
    w, alpha = (columns(moved, *(f"{name}{axis}" for axis in "xyz")) for name in ("w", "alpha"))
    rate = np.cross(w, value)
    return Changing(value, rate, np.cross(alpha, value) + np.cross(w, rate))


def _moving(place: Changing, axes: tuple[Changing, Changing, Changing]) -> BodyMotion3:
    """Return a body without mass whose frame has these axes: w is half the sum of all e x e'."""
    q = quaternion_of(np.stack([axis.value for axis in axes], axis=2))
    w = 0.5 * np.sum([np.cross(axis.value, axis.rate) for axis in axes], axis=0)
    alpha = 0.5 * np.sum([np.cross(axis.value, axis.bend) for axis in axes], axis=0)
    groups = {"": place.value, "v": place.rate, "a": place.bend, "w": w, "alpha": alpha}
    series = {f"{group}{axis}": rows[:, k].tolist() for group, rows in groups.items() for k, axis in enumerate("xyz")}
    series |= {f"q{entry}": q[:, k].tolist() for k, entry in enumerate("wxyz")}
    return BodyMotion3(
        **series,
        mass=0.0,
        mass_from="parts",
        com=(0.0, 0.0, 0.0),
        inertia=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        colour=INK,
        colour_on_dark=INK_ON_DARK,
    )
