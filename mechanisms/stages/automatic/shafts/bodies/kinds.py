"""What bodies of a machine with places along the normal become: shafts, links in one plane, pistons, rams, valves
(mm).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mbsd import Mechanism

type Point = tuple[float, float]
NEAR = 0.01
"""Places on a body that are nearer than this are one (mm)."""


@dataclass(frozen=True)
class Throw:
    """A crank pin's part that carries one link, in the shaft's frame."""

    joint: str
    link: str
    x: float
    y: float
    z: float


@dataclass(frozen=True, eq=False)
class Shaft:
    """A body that turns on ground and carries links in several planes."""

    body: str
    joint: str
    axis: Point
    """Its axis in its own frame."""
    at: Point
    """Its axis on ground."""
    throws: tuple[Throw, ...]
    """In the order of their planes."""

    def radius(self, throw: Throw) -> float:
        """How far a throw is from the axis."""
        return math.hypot(throw.x - self.axis[0], throw.y - self.axis[1])


@dataclass(frozen=True)
class LinkEye:
    """A joint of a link: ``on`` is a shaft, a piston, ground, or another link; a free end has neither."""

    joint: str
    on: str
    x: float
    y: float


@dataclass(frozen=True, eq=False)
class Link:
    """A body whose joints all lie in one plane."""

    body: str
    z: float
    eyes: tuple[LinkEye, ...]


@dataclass(frozen=True, eq=False)
class Piston:
    """A body that slides along a line of ground."""

    body: str
    joint: str
    z: float
    along: Point
    """Unit vector on ground, away from what drives it."""
    line: Point
    """A place of ground on the line of its middle."""
    turn: float
    """Direction of ``along`` in its own frame (rad)."""
    wrist: Point
    """The place of its wrist pin in its own frame."""
    aside: float
    """From the line of its middle to the wrist pin, to the left of ``along``."""
    link: str | None
    """What drives it."""
    wrist_joint: str
    area: float | None
    """Area of the bore (mm^2), where gas acts on it."""


@dataclass(frozen=True)
class RamPin:
    """A pin of a ram, which carries one link: s along its way from its first pin, q to the left of the guide's line."""

    joint: str
    link: str
    s: float
    q: float
    z: float


@dataclass(frozen=True, eq=False)
class Ram:
    """A body that slides along a line of ground and is driven in several planes."""

    body: str
    joint: str
    along: Point
    """Unit vector on ground, away from what drives it."""
    line: Point
    """A place of ground on the line of the guide."""
    turn: float
    """Direction of ``along`` in its own frame (rad)."""
    origin: Point
    """Where s and q are 0 in its own frame."""
    pins: tuple[RamPin, ...]
    """In the order of their planes."""
    nearest: float
    farthest: float
    """Where s = 0 comes to, from ``line``."""


@dataclass(frozen=True, eq=False)
class Valve:
    """A body that slides along a line of ground and is pushed by the cam of a shaft with its flat face."""

    body: str
    joint: str
    """What guides it."""
    cam: str
    """The joint with the cam."""
    shaft: str
    z: float
    along: Point
    """Unit vector on ground, the way in which the cam pushes."""
    turn: float
    """Direction of ``along`` in its own frame (rad)."""
    face: Point
    """The place of its face's marker, in its own frame."""
    closed: Point
    """Where that place is on ground where the cam pushes it least."""
    lift: float
    """How far the cam pushes it."""


@dataclass(frozen=True, eq=False)
class Machine:
    """All bodies that get parts, by what they become."""

    m: Mechanism
    poses: Mapping[str, np.ndarray]
    """By body, (T, 3): x, y (mm) and theta (rad) over the motion."""
    times: np.ndarray
    shafts: dict[str, Shaft] = field(default_factory=dict)
    links: dict[str, Link] = field(default_factory=dict)
    pistons: dict[str, Piston] = field(default_factory=dict)
    rams: dict[str, Ram] = field(default_factory=dict)
    """Bodies that slide along a line of ground and are driven in several planes."""
    valves: dict[str, Valve] = field(default_factory=dict)
    left_out: frozenset[str] = frozenset()

    def path(self, body: str, x: float, y: float) -> np.ndarray:
        """(T, 2): a place of a body on ground over the motion."""
        pose = self.poses[body]
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        return np.stack([pose[:, 0] + c * x - s * y, pose[:, 1] + s * x + c * y], axis=1)
