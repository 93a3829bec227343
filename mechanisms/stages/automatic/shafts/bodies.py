"""Bodies of a machine along a shaft: their kinds, the planes they stand in, and knuckles of rods."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from mbsd import Mechanism
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.planar import placed
from shared.shapes.units import mm
from shared.stage.errors import UserError

# Roles of bodies with places along the normal: shafts, links in one plane, pistons, rams, valves
# (mm).

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
        """Return how far a throw is from the axis."""
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
class Sliding:
    """A body that slides along a line of ground."""

    body: str
    joint: str
    """Name of the joint that guides it."""
    along: Point
    """Unit vector on ground: of a valve the way in which its cam pushes, of others away from what drives them."""
    turn: float
    """Direction of ``along`` in its own frame (rad)."""


@dataclass(frozen=True, eq=False)
class Piston(Sliding):
    """A body that slides in a bore."""

    z: float
    line: Point
    """A place of ground on the line of its middle."""
    wrist: Point
    """The place of its wrist pin in its own frame."""
    aside: float
    """From the line of its middle to the wrist pin, to the left of ``along``."""
    link: str | None
    """Name of the link that drives it."""
    area: float | None
    """Area of the bore (mm^2), where gas acts on it."""


@dataclass(frozen=True)
class RamPin:
    """A pin of a ram with one link: s along its way from the first pin, q to the left of the guide."""

    joint: str
    link: str
    s: float
    q: float
    z: float


@dataclass(frozen=True, eq=False)
class Ram(Sliding):
    """A body that slides along a line of ground and is driven in several planes."""

    line: Point
    """A place of ground on the line of the guide."""
    origin: Point
    """Where s and q are 0 in its own frame."""
    pins: tuple[RamPin, ...]
    """In the order of their planes."""
    nearest: float
    farthest: float
    """Where s = 0 comes to, from ``line``."""


@dataclass(frozen=True, eq=False)
class Valve(Sliding):
    """A body that slides along a line of ground and is pushed by the cam of a shaft with its flat face."""

    cam: str
    """The joint with the cam."""
    shaft: str
    z: float
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
        """Return (T, 2) a place of a body on ground over the motion."""
        return placed(np.array([[x, y]]), self.poses[body])[:, 0]


# Where along the normal of the plane the joints of a body lie, as the model gives it (mm).

SAME = 1e-3
"""Planes that are nearer than this are one (mm)."""


def has_places(m: Mechanism) -> bool:
    """Return True if a moving body, or a joint's marker on one, has a place along the normal."""
    moving = [body for name, body in m.bodies.items() if name != "ground"]
    ends = [marker for joint in m.joints.values() for marker in (joint.i, joint.j)]
    return any(body.z is not None for body in moving) or any(
        end.z is not None for end in ends if end.body.name != "ground"
    )


def marker_on(joint: Joint, body: str) -> Marker:
    """Return the end of a joint on one of its bodies."""
    return joint.i if joint.i.body.name == body else joint.j


def other_on(joint: Joint, body: str) -> Marker:
    """Return the end of a joint that is not on this body."""
    return joint.j if joint.i.body.name == body else joint.i


def place(marker: Marker) -> tuple[float, float]:
    """Return a marker in its body's frame (mm)."""
    return mm(marker.x), mm(marker.y)


def plane(joint: Joint, body: str) -> float | None:
    """Return the plane (mm) in which a joint acts on ``body``, None if none is given.

    It is the marker's own, else the body's, else that of the other body unless this is ground.
    """
    own, other = marker_on(joint, body), other_on(joint, body)
    z = own.plane
    if z is None and other.body.name != "ground":
        z = other.plane
    return None if z is None else mm(z)


def planes(m: Mechanism, body: str) -> list[float]:
    """Return all different planes (mm) in which joints with moving bodies act on a body, in rising order."""
    heights: list[float] = []
    for joint in m.joints.values():
        if body in joint.bodies and "ground" not in joint.bodies:
            z = plane(joint, body)
            if z is not None and all(abs(z - other) > SAME for other in heights):
                heights.append(z)
    return sorted(heights)


def no_plane(m: Mechanism, joint: str, body: str) -> UserError:
    """Return the error for a joint that lies in no plane."""
    return UserError(
        f"{m.name}: joint '{joint}' of '{body}' has no place z along the normal, and others have; give the body or the "
        f"marker one, such as m.body('{body}', z=0.02)"
    )


# Parts that sit on a shaft in one plane, as its plan sees them (mm).


@dataclass(frozen=True)
class Mounted:
    """A wheel or a cam from ``low`` to ``high`` along a shaft."""

    what: str
    """In messages."""
    z: float
    thickness: float
    radius: float
    """Radius of what it sweeps."""
    inner: float
    """The largest radius of a shaft through it."""
    is_wheel: bool
    """True if it may sit beyond the last bearing."""

    @property
    def low(self) -> float:
        """Its lower face."""
        return self.z - self.thickness / 2

    @property
    def high(self) -> float:
        """Its upper face."""
        return self.z + self.thickness / 2


# Rods that carry pins of other rods in their own plane, as the master rod of a radial engine does (mm).
#
# The big end of such a carrier is a fork: two flanges with the knuckle pins from one to the other, and between them the
# eyes of the carried rods, as thick as the carrier's shank. All in all it is
#
#     height = 2 flange + 2 gap + middle,    middle = MIDDLE (height - 2 gap)
#
# high. Radii are parts of the bore.

KNUCKLE_PIN, KNUCKLE_EYE = 0.1, 0.17
HUB = 0.34
"""Radius of the carrier's big end between its flanges."""
BESIDE = 0.02
"""Between that and the eye of a carried rod."""
MIDDLE = 0.62


def carrier(machine: Machine, link: Link) -> Link | None:
    """Return the rod on a crank pin from which a rod of a piston hangs in the same plane.

    None for other links.
    """
    if _crank_eye(machine, link) is not None or not _drives(machine, link):
        return None
    for eye in link.eyes:
        other = machine.links.get(eye.on)
        if other is not None and abs(other.z - link.z) < SAME and _crank_eye(machine, other) is not None:
            return other if _drives(machine, other) else None
    return None


def knuckle_eyes(machine: Machine, link: Link) -> list[LinkEye]:
    """Return the eyes of a carrier that carry rods, or the eye of a carried rod on its carrier."""
    above = carrier(machine, link)
    if above is not None:
        return [eye for eye in link.eyes if eye.on == above.body]
    others = [(eye, machine.links[eye.on]) for eye in link.eyes if eye.on in machine.links]
    return [eye for eye, other in others if carrier(machine, other) is link]


def is_carrier(machine: Machine, link: Link) -> bool:
    """Return True if rods hang from it in its plane."""
    return carrier(machine, link) is None and bool(knuckle_eyes(machine, link))


def carries(machine: Machine, a: Link, b: Link) -> bool:
    """Return True if one of two links hangs from the other in its plane."""
    return carrier(machine, a) is b or carrier(machine, b) is a


def throw_of(machine: Machine, link: Link) -> tuple[Shaft, Throw] | None:
    """Return the crank pin that a link turns on, or its carrier."""
    body = (carrier(machine, link) or link).body
    every = [(shaft, throw) for shaft in machine.shafts.values() for throw in shaft.throws]
    return next((pair for pair in every if pair[1].link == body), None)


def rod_foot(machine: Machine, link: Link) -> LinkEye | None:
    """Return the eye of a rod that is away from its piston: on the crank pin, or on its carrier."""
    return _crank_eye(machine, link) or next(iter(knuckle_eyes(machine, link)), None)


def ring_reach(machine: Machine, link: Link, bore: float) -> float:
    """Return how far the flanges of a rod's carrier, or its own, reach from the crank pin.

    0 without flanges.
    """
    own = carrier(machine, link) or link
    main = _crank_eye(machine, own)
    if main is None:
        return 0.0
    away = [math.hypot(eye.x - main.x, eye.y - main.y) for eye in knuckle_eyes(machine, own)]
    return max(away) + KNUCKLE_EYE * bore if away else 0.0


def refuse_near(machine: Machine, link: Link, bore: float) -> None:
    """Raise UserError for knuckle pins of a carrier that leave the eyes on them no room."""
    main = _crank_eye(machine, link)
    if main is None:
        return
    least = (HUB + BESIDE + KNUCKLE_EYE) * bore
    places = [(eye.on, eye.x, eye.y) for eye in knuckle_eyes(machine, link)]
    for k, (body, x, y) in enumerate(places):
        away = math.hypot(x - main.x, y - main.y)
        if away < least:
            raise UserError(
                f"{machine.m.name}: '{body}' turns on '{link.body}' {away:.4g} mm from the crank pin; with a bore "
                f"of {bore:.4g} mm its eye beside the big end needs {least:.4g} mm; move the knuckle pin out, or make "
                "the bore smaller"
            )
        for other, u, v in places[:k]:
            if math.hypot(x - u, y - v) < (2 * KNUCKLE_EYE + BESIDE) * bore:
                raise UserError(
                    f"{machine.m.name}: '{other}' and '{body}' turn on '{link.body}' {math.hypot(x - u, y - v):.4g} mm "
                    f"from each other, and their eyes need {(2 * KNUCKLE_EYE + BESIDE) * bore:.4g} mm; move the "
                    "knuckle pins out, or make the bore smaller"
                )


def middle(height: float, gap: float) -> float:
    """Return the thickness between the flanges of a carrier of that height."""
    return MIDDLE * (height - 2 * gap)


def flange(height: float, gap: float) -> float:
    """Return the thickness of each flange."""
    return (height - 2 * gap - middle(height, gap)) / 2


def height_for(thickness: float, gap: float) -> float:
    """Return the height of a carrier, for rods of that thickness."""
    return thickness / MIDDLE + 2 * gap


def _crank_eye(machine: Machine, link: Link) -> LinkEye | None:
    return next((eye for eye in link.eyes if eye.on in machine.shafts), None)


def _drives(machine: Machine, link: Link) -> bool:
    """Return True if a link moves a piston; pistons are those of the model, as theirs follow links."""
    slides = {body for joint in machine.m.joints.values() if joint.kind.name == "prismatic" for body in joint.bodies}
    return any(eye.on in slides and eye.on != "ground" for eye in link.eyes)
