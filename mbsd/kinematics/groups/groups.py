"""Groups solved in closed form, their kinds and joints: driven bodies, Assur groups.

An Assur group has one or two bodies. A group has bodies A and B (or A alone), which stand on known bodies K1 and K2.
Each kind has a file in kinds/, which says what its numbers are; arms are from centres of mass, in body axes (m). Joints
have letters: see LETTERS in plan.py.

All numbers of groups but the branch are linear in the places of the markers, which mbsd/kinematics/design_sweeps.py
relies on.

Source: Assur 1914; Norton, Design of Machinery, ch. 4, 6, 7 (loop closure of dyads).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from mbsd.equations.system import System

DRIVEN, WELDED, RRR, RRP, RPR, YOKE, PRP, ROD, SLIDE = range(9)
"""Kinds; blocks.py has two more."""
NUMBERS = 14
WATCHED = 2
"""Last column of Groups.turning."""
FIRST, SECOND, K1, K2, LAW, COORDINATE, KIND, THIRD = range(8)
"""Columns of Groups.group: bodies A and B, known bodies, law of a driver, coordinate, kind, and the third
known body of a train; -1 or law 0 for none. The first four are those of Groups.body."""


class Groups(NamedTuple):
    """Groups in the order of their solution."""

    kind: Any
    """(g,)"""
    body: Any
    """(g, 4) A, B or -1, K1, K2."""
    motion: Any
    """(g,) law of DRIVEN and SLIDE groups and of actuators, else 0; -k for coordinate k."""
    number: Any
    """(g, 14) columns in kinds/; linear in the places of markers."""
    group: Any
    """(g, 8) the first three in one, for the compiled loops; law 0 where there is none."""
    row: Any
    """(g, 21) ``number`` as the compiled loops need it (tables.py)."""
    angle: Any
    """(g, 2) constant angles (rad) of A and B against the body with which they turn."""
    turning: Any
    """(g, 3) that body for A and B, or -1; how many of them a motion watches."""


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
        """Return arm of a marker, from its body's centre of mass, in body axes (m)."""
        return [float(value) for value in self.system.marker_arm[marker]]

    def axis(self, marker: int) -> Vector:
        """Return unit x axis of a marker, in body axes."""
        x, y = self.system.marker_axis[marker]
        return float(x), float(y)

    def world(self, body: int, arm: list[float]) -> np.ndarray:
        """Place (2,) of a point of a body (m)."""
        return self.pose[body, :2] + turned(arm, float(self.pose[body, 2]))

    def along(self, body: int, axis: Vector | list[float] | np.ndarray) -> np.ndarray:
        """Return direction (2,) of an axis of a body."""
        return turned(axis, float(self.pose[body, 2]))

    def side_of(self, p: np.ndarray, q: np.ndarray, c: np.ndarray) -> float:
        """Return 1.0 if C is to the left of the line from P to Q, else -1.0."""
        return math.copysign(1.0, cross(q - p, c - p))

    def pin(self, pin: Link) -> list[float]:
        """Return the places of a pin: P on K1, P on A."""
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
    """Return constant angle of this body against the other (rad)."""
    return -link.offset if link.first else link.offset


def turned(vector, angle: float) -> np.ndarray:
    """Return (2,) turned by an angle (rad)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def cross(a: np.ndarray, b: np.ndarray) -> float:
    """Return cross product of two vectors (2,)."""
    return float(a[0] * b[1] - a[1] * b[0])


Bodies = tuple[int, int, int, int]
"""A, B or -1, K1, K2."""
Made = tuple[int, Bodies, int, list[float]]
"""Kind, bodies, law, numbers: a row of Groups."""


@dataclass(frozen=True)
class GroupKind:
    """One kind. Functions that make a group return None where the joints make none after all."""

    code: int
    """Code in groups.py."""
    name: str
    row: Callable[[np.ndarray], list[np.ndarray]]
    """Its row of Groups.row, from its numbers (14, ...): what compiled loops would compute anew each time."""
    one: tuple[str, ...] = ()
    """Letters, sorted, of the joints by which known bodies hold one body, if they make it a group."""
    of_one: Callable[[Places, int, dict[str, Link]], Made | None] | None = None
    """The group of that body, from its links by letter."""
    two: tuple[str, ...] = ()
    """Letters of the joints K1 - A - B - K2, if they make two bodies a group."""
    of_two: Callable[[Places, int, int, Link, Link, Link], Made | None] | None = None
    """The group of A and B: links of A to K1, of A to B, of B to K2."""
    branch: int | None = None
    """Column of the sign of the root, where two poses satisfy the joints."""
    follows: tuple[tuple[int, int, int], ...] = ()
    """Bodies that turn with another: 0 for A or 1 for B, column of the constant angle, column of the other body."""
    watched: int = 0
    """Number of its bodies that a motion watches, so that they turn little from pose to pose."""


def line(x: np.ndarray, y: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Return (x, y) over its squared length, and that square.

    Turning it along a vector of that length then takes two products.
    """
    square = x * x + y * y
    return (x / square, y / square), square
