"""Planar mechanism as a file of another program describes it: links, points, joints, motors.

Lengths are metres, angles radians, both in the world's axes at the start.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields

from shared.stage.errors import UserError
from studio.imports.limits import LARGEST_NUMBER, check_count

Place = tuple[float, float]
GROUND = ""
"""Stands for the frame among the names of links. Links have a name, so none in a file can be taken for it."""


@dataclass
class Link:
    """Rigid link as it stands at the start; a mass has its centre and inertia about it (kg m^2)."""

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
    """Joint in which two links turn about a place."""

    name: str
    first: str
    second: str
    place: Place


@dataclass
class Slide:
    """Joint in which ``second`` slides along a direction of ``first``.

    With ``turns`` it is a pin in a slot, else it does not turn.
    """

    name: str
    first: str
    second: str
    place: Place
    angle: float
    turns: bool = False
    along: Place | None = None
    """Place of the slot on ``first``, if not at ``place``."""


@dataclass
class Weld:
    """Rigid connection of two links."""

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
    """Motor that turns ``second`` against ``first`` at ``rate`` (rad/s).

    ``start`` is the angle between their x axes at the start (rad).

    ``law``: an expression of time in Python in place of a constant rate, from which ``start`` is left out.
    """

    name: str
    first: str
    second: str
    rate: float
    start: float | None = None
    law: str = ""


@dataclass
class Push:
    """Drive that moves a place of ``second`` along a direction of ``first`` at ``rate`` (m/s)."""

    name: str
    first: str
    second: str
    place: Place
    angle: float
    rate: float
    along: Place | None = None
    """Place on ``first`` from which the way is measured, if not from ``place``."""


@dataclass
class Ram:
    """Actuator: the distance of two places varies by ``stroke`` (m), ``cycles`` times a second."""

    name: str
    first: str
    second: str
    places: tuple[Place, Place]
    stroke: float
    cycles: float


ROWS = {Pin: 2, Weld: 3, Gears: 1}
"""Freedoms that a joint takes; a slide takes one or two."""


@dataclass
class Load:
    """Constant force (N) on a place of a link at an angle of the world; it ``turns`` with the link."""

    name: str
    link: str
    place: Place
    force: float
    angle: float
    turns: bool = False


@dataclass
class Sketch:
    """Whole mechanism, and what of the file could not be translated."""

    name: str
    program: str
    links: dict[str, Link] = field(default_factory=dict)
    joints: list[Pin | Slide | Weld | Gears] = field(default_factory=list)
    motors: list[Motor] = field(default_factory=list)
    pushes: list[Push] = field(default_factory=list)
    rams: list[Ram] = field(default_factory=list)
    loads: list[Load] = field(default_factory=list)
    traces: dict[str, tuple[str, Place]] = field(default_factory=dict)
    gravity: Place | None = None
    duration: float | None = None
    unit: str = ""
    """Unit of its numbers, where it is not SI."""
    freedom: int | None = None
    """Degrees of freedom (3 for each moving link, less what joints take) by the file's own records."""
    inputs: int | None = None
    """Inputs of the file, where its program moves nothing but what they drive, and does not count freedoms itself."""
    left_out: list[str] = field(default_factory=list)

    def link(self, name: str) -> Link:
        """Return the link of this name, added if it is missing. Raises UserError for an empty name."""
        if not name:
            raise UserError("a link has no name")
        return self.links.setdefault(name, Link(name))

    def pin_all(self, name: str, links: list[str], place: Place) -> None:
        """Pin several links at one place: each to the first of them, or to the ground if it is one."""
        order = sorted(dict.fromkeys(links), key=lambda link: link != GROUND)
        for k, other in enumerate(order[1:]):
            self.joints.append(Pin(name if k == 0 else f"{name}_{k + 1}", order[0], other, place))
        for link in order:
            if link != GROUND:
                self.link(link).points.setdefault(name, place)

    def counted_freedom(self) -> int:
        """Return 3 for each link less what the joints remove."""
        taken = [ROWS.get(type(joint), 0) or (1 if getattr(joint, "turns", False) else 2) for joint in self.joints]
        return 3 * len(self.links) - sum(taken)

    def check(self) -> None:
        """Raise UserError for an invalid mechanism.

        It has no link, too many, invalid numbers, or joints of no link.

        Raises it also where the degrees of freedom differ from those of the file, and nothing was left out: then the
        file was misread, and what would be written moves otherwise than its author's.
        """
        if not self.links:
            raise UserError("nothing in it moves")
        for things, words in ((self.links, "links"), (self.joints, "joints"), (self.traces, "traced points")):
            check_count(things, words)
        check_count([*self.motors, *self.pushes, *self.rams], "motors")
        check_count(self.loads, "forces")
        for thing in (self, *self.links.values(), *self.joints, *self.motors, *self.pushes, *self.rams, *self.loads):
            _check_numbers(thing)
        for thing in (*self.joints, *self.motors, *self.pushes, *self.rams):
            for link in (thing.first, thing.second):
                if link != GROUND and link not in self.links:
                    raise UserError(
                        f"{type(thing).__name__.lower()} '{thing.name}' is on '{link}', which is not a link"
                    )
            if thing.first == thing.second:
                raise UserError(f"{type(thing).__name__.lower()} '{thing.name}' is on one link alone")
        if any(motor.second == GROUND for motor in self.motors):
            raise UserError("a motor turns the ground")
        for link in (*(link for link, _ in self.traces.values()), *(load.link for load in self.loads)):
            if link not in self.links:
                raise UserError(f"a traced point or a force is on '{link}', which is not a link")
        counted = self.counted_freedom()
        if self.freedom is not None and counted != self.freedom and not self.left_out:
            raise UserError(
                f"its degrees of freedom are {self.freedom}, and {counted} of what was read of it; "
                "that is a fault of this importer: please report the file"
            )


def _check_numbers(thing: object) -> None:
    """Raise UserError for a number that is not finite or is too large."""
    for given in fields(thing):  # pyright: ignore[reportArgumentType]
        for number in _numbers_in(getattr(thing, given.name)):
            if not math.isfinite(number) or abs(number) > LARGEST_NUMBER:
                kind, name = type(thing).__name__.lower(), getattr(thing, "name", "")
                raise UserError(
                    f"{given.name} of {kind} '{name}' is {number:g}; it must be a number up to {LARGEST_NUMBER:g} (SI)"
                )


def _numbers_in(value: object) -> Iterator[float]:
    if isinstance(value, int | float):
        yield value
    elif isinstance(value, tuple):
        for part in value:
            yield from _numbers_in(part)
    elif isinstance(value, dict):
        yield from _numbers_in(tuple(value.values()))
