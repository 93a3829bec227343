"""Joints as groups see them, and where their points are on the bodies at the closed pose of the start.

All numbers of groups but the branch are linear in the places of the markers, which mbsd/kinematics/design_sweeps.py
relies on.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from mbsd.equations.system import System

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
    """Offset of its angle row: theta_j - theta_i (rad); of a rod its length (m)."""
    motion: int


class Places:
    """Where the points of links are."""

    def __init__(self, system: System, pose: np.ndarray) -> None:
        self.system, self.pose = system, pose

    def arm(self, marker: int) -> list[float]:
        """Arm of a marker, from its body's centre of mass, in body axes (m)."""
        return [float(value) for value in self.system.marker_arm[marker]]

    def axis(self, marker: int) -> Vector:
        """Unit x axis of a marker, in body axes."""
        x, y = self.system.marker_axis[marker]
        return float(x), float(y)

    def world(self, body: int, arm: list[float]) -> np.ndarray:
        """Place (2,) of a point of a body (m)."""
        return self.pose[body, :2] + turned(arm, float(self.pose[body, 2]))

    def along(self, body: int, axis: Vector | list[float] | np.ndarray) -> np.ndarray:
        """Direction (2,) of an axis of a body."""
        return turned(axis, float(self.pose[body, 2]))

    def side_of(self, p: np.ndarray, q: np.ndarray, c: np.ndarray) -> float:
        """1.0 if C is to the left of the line from P to Q, else -1.0."""
        return math.copysign(1.0, cross(q - p, c - p))

    def pin(self, pin: Link) -> list[float]:
        """P on K1, P on A."""
        return [*self.arm(pin.there), *self.arm(pin.here)]

    def on_slide(self, slide: Link, arm: list[float]) -> list[float]:
        """Return the place of a sliding body's ``arm`` on the other body at slide 0, the axis, the angle."""
        angle = own_angle(slide)
        axis = turned(self.axis(slide.here), angle) if slide.first else self.axis(slide.there)
        base = np.array(self.arm(slide.there)) + turned(np.array(arm) - self.arm(slide.here), angle)
        return [*base, *axis, angle]

    def hanging(self, link: Link) -> list[float]:
        """Return numbers of a body of a block that hangs by a pin, slide or weld (groups/blocks.py)."""
        arm = self.arm(link.here)
        if link.kind == "P":
            return [float(x) for x in (*self.on_slide(link, arm), *arm)]
        return [*self.arm(link.there), 1.0, 0.0, own_angle(link), *arm]


def own_angle(link: Link) -> float:
    """Constant angle of this body against the other (rad)."""
    return -link.offset if link.first else link.offset


def turned(vector, angle: float) -> np.ndarray:
    """(2,) turned by an angle (rad)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def cross(a: np.ndarray, b: np.ndarray) -> float:
    """Cross product of two vectors (2,)."""
    return float(a[0] * b[1] - a[1] * b[0])
