"""A mechanism by name: bodies, markers, joints, drivers, traces. Numbers in SI; angles in radians.

    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)

Everything wrong is refused here, by name, before anything is solved.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mbsd.drivers.angle import DRIVE_ANGLE
from mbsd.drivers.coordinate import DRIVE_COORDINATE
from mbsd.drivers.distance import DRIVE_DISTANCE
from mbsd.drivers.relative_angle import DRIVE_RELATIVE_ANGLE
from mbsd.errors import ModelError
from mbsd.joints.distance import DISTANCE
from mbsd.joints.kind import JointKind
from mbsd.joints.pin_in_slot import PIN_IN_SLOT
from mbsd.joints.prismatic import PRISMATIC
from mbsd.joints.revolute import REVOLUTE
from mbsd.joints.weld import WELD
from mbsd.motions import Motion
from mbsd.motions.function import Function

if TYPE_CHECKING:
    from mbsd.mobility import Mobility
    from mbsd.solution import Solution

Law = Motion | Callable[[float], float]
STANDARD_GRAVITY = (0.0, -9.80665)
"""m/s^2, ISO 80000-3."""


@dataclass(frozen=True, eq=False)
class Marker:
    """A frame fixed to a body: ``x``, ``y`` (m) and ``angle`` (rad) in the body's frame."""

    body: Body
    x: float
    y: float
    angle: float = 0.0


@dataclass(eq=False)
class Body:
    """A rigid body with the frame its author chose. Ground is body 0 and never moves.

    mass (kg), com (m, body frame), inertia about the centre of mass (kg m^2).
    """

    name: str
    mass: float = 0.0
    com: tuple[float, float] = (0.0, 0.0)
    inertia: float = 0.0
    length: float | None = None
    """Of a bar (m); None for other bodies."""

    def at(self, x: float, y: float, angle: float = 0.0) -> Marker:
        """The marker at (x, y) in this body's frame (m), its x axis turned by ``angle`` (rad)."""
        for what, value in (("x", x), ("y", y), ("angle", angle)):
            _number(f"{self.name}.at: {what}", value)
        return Marker(self, float(x), float(y), float(angle))

    @property
    def origin(self) -> Marker:
        """The body's own frame."""
        return self.at(0.0, 0.0)

    @property
    def start(self) -> Marker:
        """A bar's first end: its frame's origin."""
        self._bar_length("start")
        return self.at(0.0, 0.0)

    @property
    def end(self) -> Marker:
        """A bar's second end, at (length, 0)."""
        return self.at(self._bar_length("end"), 0.0)

    def _bar_length(self, what: str) -> float:
        if self.length is None:
            raise ModelError(f"{self.name}.{what}: '{self.name}' is no bar; use {self.name}.at(x, y)")
        return self.length

    def __repr__(self) -> str:
        return f"<Body {self.name}: {self.mass:g} kg>"


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint or driver between marker i (first body) and marker j (second body)."""

    kind: JointKind
    name: str
    i: Marker
    j: Marker
    length: float = 0.0
    """Of a distance joint (m)."""
    motion: Motion | None = None

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the first and second body."""
        return self.i.body.name, self.j.body.name


@dataclass(frozen=True)
class Start:
    """Rough pose of a body at the start: angle (rad) and, if given, place of its frame (m)."""

    angle: float
    place: tuple[float, float] | None = None


@dataclass(eq=False)
class Mechanism:
    """Bodies, joints, drivers and traced points, by name. ``gravity`` in m/s^2; None turns it off."""

    name: str
    gravity: tuple[float, float] | None = STANDARD_GRAVITY
    bodies: dict[str, Body] = field(default_factory=dict)
    joints: dict[str, Joint] = field(default_factory=dict)
    drivers: dict[str, Joint] = field(default_factory=dict)
    traces: dict[str, Marker] = field(default_factory=dict)
    starts: dict[str, Start] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.name or not isinstance(self.name, str):
            raise ModelError(f"a mechanism needs a name, got {self.name!r}")
        gravity = self.gravity if self.gravity is not None else (0.0, 0.0)
        if len(gravity) != 2:
            raise ModelError(f"{self.name}: gravity is {gravity!r}; it must be (gx, gy) in m/s^2, or None")
        self.gravity = (self._number("gravity", gravity[0]), self._number("gravity", gravity[1]))
        self.bodies["ground"] = Body("ground")

    # -- bodies -------------------------------------------------------------------------------------------------

    @property
    def ground(self) -> Body:
        """The frame that does not move."""
        return self.bodies["ground"]

    def body(self, name: str, mass: float = 0.0, com: Sequence[float] = (0.0, 0.0), inertia: float = 0.0) -> Body:
        """Add a body. Raises ModelError on a name already used or an impossible mass."""
        self._new_name(name, self.bodies, "body")
        body = self.bodies[name] = Body(name)
        try:
            self.set_mass(name, mass, com, inertia)
        except ModelError:
            del self.bodies[name]
            raise
        return body

    def bar(
        self,
        name: str,
        length: float,
        mass: float = 0.0,
        com: Sequence[float] | None = None,
        inertia: float | None = None,
    ) -> Body:
        """Add a bar from ``start`` (0, 0) to ``end`` (length, 0).

        With a mass and nothing else it is a uniform slender rod: com at the middle, inertia m l^2 / 12.
        """
        length = self._number(f"bar '{name}': length", length)
        if length <= 0:
            raise ModelError(f"{self.name}: bar '{name}' has length {length:g} m; it must be positive")
        com = (length / 2, 0.0) if com is None else com
        inertia = mass * length**2 / 12 if inertia is None else inertia
        body = self.body(name, mass, com, inertia)
        body.length = length
        return body

    def set_mass(self, name: str, mass: float, com: Sequence[float], inertia: float) -> None:
        """Set mass (kg), centre of mass (m, body frame) and inertia about it (kg m^2), as from CAD."""
        body = self.known_body(name)
        if len(com) != 2:
            raise ModelError(f"{self.name}: com of body '{name}' is {com!r}; it must be (x, y)")
        values = [self._number(f"mass of body '{name}'", mass), self._number(f"inertia of body '{name}'", inertia)]
        for what, value, unit in zip(("mass", "inertia"), values, ("kg", "kg m^2"), strict=True):
            if value < 0:
                raise ModelError(f"{self.name}: body '{name}' has {what} {value:g} {unit}; it cannot be negative")
        body.mass, body.inertia = values
        body.com = (self._number(f"com of '{name}'", com[0]), self._number(f"com of '{name}'", com[1]))

    def known_body(self, name: str) -> Body:
        """The body of this name; raises ModelError with the known names."""
        if name not in self.bodies:
            raise ModelError(f"{self.name}: there is no body '{name}'; there is: {', '.join(self.bodies)}")
        return self.bodies[name]

    # -- joints -------------------------------------------------------------------------------------------------

    def revolute(self, name: str, i: Marker, j: Marker) -> Joint:
        """A pin: markers i and j share one point."""
        return self._join(REVOLUTE, name, i, j)

    def prismatic(self, name: str, i: Marker, j: Marker) -> Joint:
        """A slider: marker j moves along the x axis of marker i and does not turn against it."""
        return self._join(PRISMATIC, name, i, j)

    def weld(self, name: str, i: Marker, j: Marker) -> Joint:
        """Marker j is fixed to marker i in place and direction."""
        return self._join(WELD, name, i, j)

    def distance(self, name: str, i: Marker, j: Marker, length: float) -> Joint:
        """A massless rod of the given length (m) between the points of markers i and j."""
        length = self._number(f"joint '{name}': length", length)
        if length <= 0:
            raise ModelError(
                f"{self.name}: distance joint '{name}' has length {length:g} m; it must be positive "
                "(use a revolute joint for two points that coincide)"
            )
        return self._join(DISTANCE, name, i, j, length=length)

    def pin_in_slot(self, name: str, slot: Marker, pin: Marker) -> Joint:
        """The point of marker ``pin`` moves along the x axis of marker ``slot``."""
        return self._join(PIN_IN_SLOT, name, slot, pin)

    # -- drivers ------------------------------------------------------------------------------------------------

    def drive_angle(self, name: str, body: Body, law: Law) -> Joint:
        """Impose the absolute angle of a body (rad)."""
        self._own_body(body, f"driver '{name}'")
        return self._join(DRIVE_ANGLE, name, self.ground.origin, body.origin, law=law)

    def drive_relative_angle(self, name: str, first: Body, second: Body, law: Law) -> Joint:
        """Impose the angle of body ``second`` against body ``first`` (rad)."""
        self._own_body(first, f"driver '{name}'")
        self._own_body(second, f"driver '{name}'")
        return self._join(DRIVE_RELATIVE_ANGLE, name, first.origin, second.origin, law=law)

    def drive_coordinate(self, name: str, i: Marker, j: Marker, law: Law) -> Joint:
        """Impose how far marker j lies along the x axis of marker i (m)."""
        return self._join(DRIVE_COORDINATE, name, i, j, law=law)

    def drive_distance(self, name: str, i: Marker, j: Marker, law: Law) -> Joint:
        """Impose the distance of the points of markers i and j (m), as a linear actuator does."""
        return self._join(DRIVE_DISTANCE, name, i, j, law=law)

    # -- points and start ---------------------------------------------------------------------------------------

    def trace(self, name: str, marker: Marker) -> Marker:
        """Follow a point: its path, velocity and acceleration are in the solution."""
        self._new_name(name, self.traces, "trace")
        self._own_body(marker.body, f"trace '{name}'")
        self.traces[name] = marker
        return marker

    def start_near(self, **poses: float | Sequence[float]) -> None:
        """Rough start poses that pick the assembly branch, in DEGREES: ``crank=0, coupler=45``.

        A body that no joint places, such as a slider, may be given as (x, y, degrees).
        """
        for name, pose in poses.items():
            self.known_body(name)
            if isinstance(pose, int | float):
                self.starts[name] = Start(math.radians(self._number(f"start of '{name}'", pose)))
                continue
            if len(pose) != 3:
                raise ModelError(f"{self.name}: start of '{name}' is {pose!r}; give degrees, or (x, y, degrees)")
            x, y, degrees = (self._number(f"start of '{name}'", value) for value in pose)
            self.starts[name] = Start(math.radians(degrees), (x, y))

    # -- what it can compute ------------------------------------------------------------------------------------

    def mobility(self) -> Mobility:
        """Degrees of freedom, nominal and by rank, and redundant joints; does not need drivers."""
        from mbsd.mobility import mobility

        return mobility(self)

    def sweep(
        self, duration: float | None = None, steps: int = 360, times: Sequence[float] | np.ndarray | None = None
    ) -> Solution:
        """Solve the driven motion: positions, velocities, accelerations, reactions, driver efforts, energy.

        ``steps`` equal steps over ``duration`` seconds, both ends included; by default one period of the first
        driver that has one. ``times`` (s), rising, replaces both.
        """
        from mbsd.sweep import sweep

        return sweep(self, duration, steps, times)

    # -- checks -------------------------------------------------------------------------------------------------

    def _join(
        self, kind: JointKind, name: str, i: Marker, j: Marker, length: float = 0.0, law: Law | None = None
    ) -> Joint:
        what = "driver" if kind.driven else "joint"
        self._new_name(name, self.joints | self.drivers, what)
        for marker in (i, j):
            if not isinstance(marker, Marker):
                raise ModelError(
                    f"{self.name}: {what} '{name}' needs two markers, got {marker!r}; "
                    "write body.at(x, y), bar.start or bar.end"
                )
            self._own_body(marker.body, f"{what} '{name}'")
        if i.body is j.body:
            raise ModelError(
                f"{self.name}: {what} '{name}' connects '{i.body.name}' with itself; give markers of two bodies"
            )
        motion = None
        if kind.driven:
            if not (isinstance(law, Motion) or callable(law)):
                raise ModelError(
                    f"{self.name}: driver '{name}' needs a motion law, got {law!r}; "
                    "say constant_rate(...), harmonic(...), or a function of time"
                )
            motion = law if isinstance(law, Motion) else Function(law)
        joint = Joint(kind, name, i, j, length, motion)
        (self.drivers if kind.driven else self.joints)[name] = joint
        return joint

    def _own_body(self, body: Body, what: str) -> None:
        if not isinstance(body, Body):
            raise ModelError(f"{self.name}: {what} needs a body, got {body!r}")
        if self.bodies.get(body.name) is not body:
            raise ModelError(f"{self.name}: {what} uses body '{body.name}' of another mechanism")

    def _new_name(self, name: str, taken: dict, what: str) -> None:
        if not isinstance(name, str) or not name:
            raise ModelError(f"{self.name}: a {what} needs a name, got {name!r}")
        if name in taken:
            raise ModelError(f"{self.name}: there are two of the name '{name}'; the {what} needs another")

    def _number(self, what: str, value: object) -> float:
        return _number(f"{self.name}: {what}", value)

    def __repr__(self) -> str:
        bodies, joints, drivers = len(self.bodies) - 1, len(self.joints), len(self.drivers)
        return f"<Mechanism {self.name}: {bodies} bodies, {joints} joints, {drivers} drivers>"


def _number(what: str, value: object) -> float:
    """``value`` as a float; raises ModelError if it is no finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating | np.integer):
        raise ModelError(f"{what} is {value!r}; it must be a number")
    if not math.isfinite(value):
        raise ModelError(f"{what} is {value}; it must be finite")
    return float(value)
