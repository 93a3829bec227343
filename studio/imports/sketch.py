"""What a file of another program says of a mechanism in the plane: links with points, joints between them, motors.

Lengths are metres, angles radians, both in the world's axes at the start; the ground is the link ``ground``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

Place = tuple[float, float]
GROUND = "ground"


@dataclass
class Link:
    """A rigid link as it stands at the start; a mass is given with its centre and the inertia about it (kg m^2)."""

    name: str
    points: dict[str, Place] = field(default_factory=dict)
    """Places of its pins and traced points, by name, in the order of the file."""
    angle: float | None = None
    """Direction of its x axis, where the file gives one; else it runs from its first point to its second."""
    mass: float | None = None
    centre: Place | None = None
    inertia: float | None = None
    velocity: tuple[float, float, float] | None = None
    """At the start: vx, vy of its first point (m/s) and omega (rad/s)."""


@dataclass
class Pin:
    """Two links turn about a place."""

    name: str
    first: str
    second: str
    place: Place


@dataclass
class Slide:
    """``second`` moves along a direction of ``first``; ``turns``: as a pin in a slot, else without turning."""

    name: str
    first: str
    second: str
    place: Place
    angle: float
    turns: bool = False
    along: Place | None = None
    """Where the slot lies on ``first``, if not at ``place``."""


@dataclass
class Weld:
    """Two links are one."""

    name: str
    first: str
    second: str
    place: Place


@dataclass
class Gears:
    """Two wheels about places of two links; as a belt or chain they turn the same way."""

    name: str
    first: str
    second: str
    places: tuple[Place, Place]
    radii: tuple[float, float]
    belt: bool = False
    internal: bool = False


@dataclass
class Motor:
    """Turns ``second`` against ``first``: at ``rate`` (rad/s) from ``start``, the angle between their x axes (rad).

    ``law``: an expression of time in Python in place of a constant rate, from which ``start`` is left out.
    """

    name: str
    first: str
    second: str
    rate: float
    start: float | None = None
    law: str = ""


@dataclass
class Ram:
    """An actuator: the distance of two places moves to and fro by ``stroke`` (m), ``cycles`` times a second."""

    name: str
    first: str
    second: str
    places: tuple[Place, Place]
    stroke: float
    cycles: float


@dataclass
class Sketch:
    """A whole mechanism, and what of the file could not be said."""

    name: str
    program: str
    links: dict[str, Link] = field(default_factory=dict)
    joints: list[Pin | Slide | Weld | Gears] = field(default_factory=list)
    motors: list[Motor] = field(default_factory=list)
    rams: list[Ram] = field(default_factory=list)
    traces: dict[str, tuple[str, Place]] = field(default_factory=dict)
    gravity: Place | None = None
    duration: float | None = None
    unit: str = ""
    """What its numbers are taken for, where the file does not say it."""
    left_out: list[str] = field(default_factory=list)

    def link(self, name: str) -> Link:
        """The link of this name, which is added where it is not there."""
        return self.links.setdefault(name, Link(name))

    def pin_all(self, name: str, links: list[str], place: Place) -> None:
        """Pin several links at one place: each with the first of them, the ground where it is one."""
        order = sorted(dict.fromkeys(links), key=lambda link: link != GROUND)
        for k, other in enumerate(order[1:]):
            self.joints.append(Pin(name if k == 0 else f"{name}_{k + 1}", order[0], other, place))
        for link in order:
            if link != GROUND:
                self.link(link).points.setdefault(name, place)
