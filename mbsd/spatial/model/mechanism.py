"""Model of a mechanism in space: named bodies, joints, drivers, traces and starts, with shared checks."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number, positive_number, several_numbers
from mbsd.base.errors import ModelError
from mbsd.base.names import Named, Suggesting, no_such, shown
from mbsd.model.event import Event
from mbsd.spatial.model.body import (
    SHORTEST,
    Body,
    Direction,
    Fixing,
    Marker,
    Orientation,
    Place,
    Shape,
    along_x,
    ball,
    cylinder,
    cylinder_mass,
    direction_given,
    inertia_given,
    mass_given,
    orientation_given,
    place_given,
)
from mbsd.spatial.model.force import Force
from mbsd.spatial.model.joint import Joint

STANDARD_GRAVITY = (0.0, 0.0, -9.80665)
"""m/s^2, ISO 80000-3."""


@dataclass(eq=False)
class Model(Suggesting):
    """Model of a mechanism in space. See :class:`mbsd.spatial.mechanism.Mechanism`."""

    name: str
    gravity: tuple[float, float, float] | None = STANDARD_GRAVITY
    bodies: dict[str, Body] = field(default_factory=lambda: Named("body"))
    joints: dict[str, Joint] = field(default_factory=lambda: Named("joint"))
    drivers: dict[str, Joint] = field(default_factory=lambda: Named("driver"))
    forces: dict[str, Force] = field(default_factory=lambda: Named("force"))
    contacts: dict[str, Any] = field(default_factory=lambda: Named("contact"))
    events: dict[str, Event] = field(default_factory=lambda: Named("event"))
    traces: dict[str, Marker] = field(default_factory=lambda: Named("traced point"))
    starts: dict[str, float] = field(default_factory=dict)
    """Turns (rad) and slides (m) of joints at the start, by name."""
    velocities: dict[str, tuple[float, ...]] = field(default_factory=dict)
    """Rates of joints (rad/s or m/s) and of bodies at the start, by name: (wx, wy, wz) (rad/s, in the world), or
    (vx, vy, vz, wx, wy, wz) with the velocity of their frames (m/s)."""

    calls: list[Any] = field(default_factory=list, repr=False)
    """Calls of the methods that built it (journal.py), by which it is changed and saved."""
    building: bool = field(default=False, repr=False)
    """True while one of these methods is at work."""

    other_words = MappingProxyType(
        {"hinge": "revolute", "pin": "revolute", "slider": "prismatic", "ball_joint": "spherical", "weld": "fixed"}
        | {"hooke": "universal", "cardan": "universal", "bar": "rod", "gear": "gear_pair", "rack": "rack_and_pinion"}
        | {"cam": "screw", "drive_angle": "drive_turn", "drive_coordinate": "drive_slide", "solve": "sweep"}
        | {"sphere": "ball", "angle_lock": "lock", "pin_in_slot": "point_on_line"}
    )

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise ModelError(f"a mechanism needs a name, got {shown(self.name)}")
        self.bodies["ground"] = Body("ground", self.name)

    def __setattr__(self, name: str, value: object) -> None:
        if name == "gravity":
            value = place_given(f"{self.name}: gravity (m/s^2)", (0.0, 0.0, 0.0) if value is None else value)
        super().__setattr__(name, value)

    @property
    def ground(self) -> Body:
        """The frame that does not move."""
        return self.bodies["ground"]

    def body(
        self,
        name: str,
        mass: float = 0.0,
        com: Place = (0.0, 0.0, 0.0),
        inertia: Sequence[float] | np.ndarray = (0.0, 0.0, 0.0),
        at: Place = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
    ) -> Body:
        """Add a body whose frame lies ``at`` (m) with ``orientation`` (w, x, y, z) in the design pose.

        mass (kg) at ``com`` (m, in the body's frame). ``inertia`` about it, in the axes of the body (kg m^2):
        (Ixx, Iyy, Izz), these with (Ixy, Ixz, Iyz), or a matrix (3, 3). Where ``at`` and ``orientation`` are left out
        the frame is that of the world, so places on the body are those of the design.
        """
        what = f"{self.name}: body '{name}'"
        given = inertia_given(f"{what}: inertia", inertia)
        return self._add_body(name, mass_given(f"{what}: mass", mass), com, given, at, orientation)

    def rod(self, name: str, start: Place, end: Place, mass: float = 0.0, radius: float = 0.0) -> Body:
        """Add a uniform rod from ``start`` to ``end`` (m); its frame is at ``start``, x along it.

        ``radius`` (m) 0 makes it slender, without inertia about its axis.
        """
        first, last = np.array(start, float), np.array(end, float)
        length = float(np.linalg.norm(last - first))
        what = f"{self.name}: body '{name}'"
        if length < SHORTEST:
            raise ModelError(f"{what} starts where it ends; give two places")
        if radius < 0.0:
            raise ModelError(f"{what} has radius {radius:g} m; it cannot be negative")
        inertia = inertia_given(f"{what}: inertia", cylinder(mass_given(f"{what}: mass", mass), radius, length))
        orientation = along_x((last - first) / length)
        shape = Shape("rod", radius, length)
        return self._add_body(name, mass, (length / 2, 0.0, 0.0), inertia, start, orientation, shape)

    def shaft(
        self, name: str, start: Place, end: Place, radius: float, mass: float | None = None, density: float = 7850.0
    ) -> Body:
        """Add a round shaft from ``start`` to ``end`` (m): steel, if no ``mass`` (kg) is given."""
        radius = positive_number(f"{self.name}: radius of body '{name}'", radius, "m")
        length = math.dist(tuple(start), tuple(end))
        return self.rod(name, start, end, cylinder_mass(density, radius, length) if mass is None else mass, radius)

    def disc(
        self, name: str, centre: Place, axis: Direction, radius: float, mass: float = 0.0, thickness: float = 0.0
    ) -> Body:
        """Add a round disc about ``axis``; its frame is at ``centre`` (m), x along the axis."""
        radius = positive_number(f"{self.name}: radius of body '{name}'", radius, "m")
        what = f"{self.name}: body '{name}'"
        inertia = inertia_given(f"{what}: inertia", cylinder(mass_given(f"{what}: mass", mass), radius, thickness))
        turned = along_x(np.array(direction_given(f"{what}: axis", axis)))
        shape = Shape("disc", radius, thickness)
        return self._add_body(name, mass, (0.0, 0.0, 0.0), inertia, centre, turned, shape)

    def ball(self, name: str, centre: Place, radius: float, mass: float = 0.0) -> Body:
        """Add a solid ball; its frame is at ``centre`` (m) in the design pose, with the axes of the world."""
        radius = positive_number(f"{self.name}: radius of body '{name}'", radius, "m")
        what = f"{self.name}: body '{name}'"
        inertia = inertia_given(f"{what}: inertia", ball(mass_given(f"{what}: mass", mass), radius))
        turned, shape = (1.0, 0.0, 0.0, 0.0), Shape("ball", radius)
        return self._add_body(name, mass, (0.0, 0.0, 0.0), inertia, centre, turned, shape)

    def set_mass(self, name: str, mass: float, com: Place, inertia: Sequence[float] | np.ndarray) -> None:
        """Set mass (kg), centre of mass (m, the body's frame) and inertia about it (kg m^2), as from CAD."""
        body = own_body(self, name, f"{self.name}: body '{name}'")
        what = f"{self.name}: body '{body.name}'"
        body.weigh(
            mass_given(f"{what}: mass", mass),
            place_given(f"{what}: com", com),
            inertia_given(f"{what}: inertia", inertia),
        )

    def trace(self, name: str, body: Fixing, at: Place | None = None) -> Marker:
        """Trace a point of a body, ``at`` a place of the world in the design pose (m), or a marker."""
        self.refuse_name(name, "traced point", self.traces)
        what = f"{self.name}: traced point '{name}'"
        if isinstance(body, Marker):
            own_body(self, body.body, what)
            self.traces[name] = body
            return body
        owner = own_body(self, body, what)
        place = np.array(owner.place if at is None else place_given(f"{what}: at", at), float)
        marker = self.traces[name] = owner.world_marker(place, np.eye(3))
        return marker

    def start_near(self, values: Mapping[str, float] | None = None) -> None:
        """Start with joints away from the design pose: turns in degrees, slides in m, by the names of joints.

        They are held as far as joints and drivers leave them free, and say else which assembly is meant.
        """
        for name, value in (values or {}).items():
            what = f"{self.name}: start of '{name}'"
            if name not in self.joints:
                raise ModelError(f"{self.name}: {no_such('joint', name, self.joints)}")
            kind = self.joints[name].kind
            if not (kind.turns or kind.slides):
                raise ModelError(f"{what}: a {kind.name} joint has neither turn nor slide; name one that has")
            number = finite_number(what, value)
            self.starts[name] = math.radians(number) if kind.turns else number

    def start_moving(self, values: Mapping[str, float | Sequence[float] | np.ndarray] | None = None) -> None:
        """Start a simulation with joints at a rate (rad/s or m/s), or bodies at velocities.

        A body takes its angular velocity (wx, wy, wz) in the world (rad/s), or (vx, vy, vz, wx, wy, wz) with the
        velocity of its frame (m/s) before it. All else moves as joints and drivers make it, with little kinetic energy.
        What they forbid is changed, and the simulation warns.
        """
        for name, value in (values or {}).items():
            what = f"{self.name}: start velocity of '{name}'"
            if name in self.joints:
                kind = self.joints[name].kind
                if not (kind.turns or kind.slides):
                    raise ModelError(f"{what}: a {kind.name} joint has neither turn nor slide; name one that has")
                self.velocities[name] = (finite_number(what, value),)
            elif name in self.bodies:
                count = 6 if isinstance(value, Sequence | np.ndarray) and len(value) == 6 else 3
                self.velocities[name] = several_numbers(
                    what, value, count, "give (wx, wy, wz) in rad/s, or (vx, vy, vz, wx, wy, wz)"
                )
            else:
                raise ModelError(f"{self.name}: {no_such('joint or body', name, [*self.joints, *self.bodies])}")

    def refuse_name(self, name: object, what: str, *taken: Mapping[str, object]) -> None:
        """Raise ModelError for a name that is none, or is used already."""
        if not isinstance(name, str) or not name or name != name.strip() or not name.isprintable():
            raise ModelError(f"{self.name}: a {what} needs a name without spaces around it, got {shown(name)}")
        if any(name in names for names in taken or (self.joints, self.drivers, self.forces, self.contacts)):
            raise ModelError(f"{self.name}: there are two of the name '{name}'; the {what} needs another")

    def _add_body(
        self, name: str, mass: float, com: Place, inertia: tuple[tuple[float, float, float], ...], at: Place,
        orientation: Orientation, shape: Shape | None = None,
    ) -> Body:  # fmt: skip
        self.refuse_name(name, "body", self.bodies)
        what = f"{self.name}: body '{name}'"
        turned = orientation_given(f"{what}: orientation", orientation)
        com, at = place_given(f"{what}: com", com), place_given(f"{what}: at", at)
        body = self.bodies[name] = Body(name, self.name, mass, com, inertia, at, turned, shape)
        return body


def own_body(m: Model, body: Fixing, what: str) -> Body:
    """Return a body of this mechanism, given as body or name. Raises ModelError."""
    if isinstance(body, str):
        if body not in m.bodies:
            raise ModelError(f"{what}: {no_such('body', body, m.bodies)}")
        return m.bodies[body]
    if not isinstance(body, Body):
        raise ModelError(f"{what} needs a body, got {shown(body)}; give m.ground, what m.body(...) returned, or a name")
    if m.bodies.get(body.name) is not body:
        raise ModelError(f"{what} uses body '{body.name}' of another mechanism; take one of this one")
    return body
