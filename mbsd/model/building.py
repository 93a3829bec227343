"""Building a mechanism by name: joints, drivers, forces, contacts, traced points, starts, events.

Each method of a joint, driver, force or contact stands beside its kind; a line here makes it a method.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mbsd.base.arguments import several_numbers
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.body import Body, Marker
from mbsd.model.cables import cable, cable_span, cable_spring, capstan, over, slack_span
from mbsd.model.contacts import (
    angle_stop,
    coordinate_stop,
    one_way,
    rigid_contact,
    rigid_discs,
    rigid_terrain,
    rope,
    stop,
)
from mbsd.model.drivers import drive_angle, drive_coordinate, drive_distance, drive_relative_angle
from mbsd.model.event import Event
from mbsd.model.force import Force
from mbsd.model.forces.clearance_joint import clearance_joint
from mbsd.model.forces.contact import contact, tyre
from mbsd.model.forces.curves import curve_of_angle, curve_of_length, motor
from mbsd.model.forces.double_acting_cylinder import double_acting_cylinder
from mbsd.model.forces.fields import drag, gravitation, rotating_frame
from mbsd.model.forces.friction import friction
from mbsd.model.forces.gas import gas, gas_strut
from mbsd.model.forces.gas_cycle import gas_cycle
from mbsd.model.forces.gear_mesh import gear_mesh
from mbsd.model.forces.hydraulic_cylinder import hydraulic_cylinder
from mbsd.model.forces.loads import actuator, force, torque
from mbsd.model.forces.springs import bushing, shaft, spring, spring_law, torsion_spring, torsion_spring_law
from mbsd.model.forces.user_force import user_force
from mbsd.model.joint import Joint
from mbsd.model.joints.cams import cam_flat, cam_roller
from mbsd.model.joints.constraint import constraint
from mbsd.model.joints.curves import point_on_curve, rolling_disc, rolling_on_curve
from mbsd.model.joints.gears import belt, gear_pair, rack_and_pinion
from mbsd.model.joints.geneva import geneva
from mbsd.model.joints.pairs import angle_lock, distance, pin_in_slot, prismatic, revolute, weld
from mbsd.model.joints.ratios import ratio, travel_ratio, turn_ratio
from mbsd.model.laws.function import checked_pulses
from mbsd.model.mechanism import Model, StartVelocity, name_of, new_name, number_given, own_body, start_given
from mbsd.model.outlines.contact import outline_contact, outline_touch
from mbsd.model.outlines.outline import outline
from mbsd.model.outlines.penalty import outline_force, yielding_outline_contact


class Building(Model):
    """A model with methods that add entries, and raise an error at once for what is wrong, by name."""

    # -- joints --------------------------------------------------------------------------------------------------------

    revolute = revolute
    prismatic = prismatic
    weld = weld
    distance = distance
    pin_in_slot = pin_in_slot
    gear_pair = gear_pair
    belt = belt
    rack_and_pinion = rack_and_pinion
    rolling_disc = rolling_disc
    rolling_on_curve = rolling_on_curve
    point_on_curve = point_on_curve
    cam_roller = cam_roller
    cam_flat = cam_flat
    geneva = geneva
    ratio = ratio
    turn_ratio = turn_ratio
    travel_ratio = travel_ratio
    angle_lock = angle_lock
    constraint = constraint
    cable_span = cable_span
    cable = cable
    over = over

    # -- drivers -------------------------------------------------------------------------------------------------------

    drive_angle = drive_angle
    drive_relative_angle = drive_relative_angle
    drive_coordinate = drive_coordinate
    drive_distance = drive_distance

    # -- forces --------------------------------------------------------------------------------------------------------

    spring = spring
    torsion_spring = torsion_spring
    spring_law = spring_law
    torsion_spring_law = torsion_spring_law
    bushing = bushing
    cable_spring = cable_spring
    capstan = capstan
    torque = torque
    force = force
    actuator = actuator
    curve_of_length = curve_of_length
    curve_of_angle = curve_of_angle
    motor = motor
    gravitation = gravitation
    gas = gas
    gas_cycle = gas_cycle
    gas_strut = gas_strut
    hydraulic_cylinder = hydraulic_cylinder
    double_acting_cylinder = double_acting_cylinder
    contact = contact
    clearance_joint = clearance_joint
    gear_mesh = gear_mesh
    shaft = shaft
    tyre = tyre
    outline_force = outline_force
    yielding_outline_contact = yielding_outline_contact
    drag = drag
    rotating_frame = rotating_frame
    friction = friction
    user_force = user_force

    # -- unilateral contacts and stops, which act in simulations alone -------------------------------------------------

    rigid_contact = rigid_contact
    rigid_discs = rigid_discs
    rigid_terrain = rigid_terrain
    rope = rope
    slack_span = slack_span
    angle_stop = angle_stop
    coordinate_stop = coordinate_stop
    stop = stop
    one_way = one_way
    outline_touch = outline_touch
    outline_contact = outline_contact

    # -- outlines, points, starts, events -----------------------------------------------------------------------------

    outline = outline

    def trace(self, name: str, marker: Marker) -> Marker:
        """Follow a point: its path, velocity and acceleration are in the solution."""
        new_name(self, name, "trace", self.traces)
        if not isinstance(marker, Marker):
            raise ModelError(f"{self.name}: trace '{name}' needs a marker, got {shown(marker)}; write body.at(x, y)")
        own_body(self, marker.body, f"trace '{name}'")
        self.traces[name] = marker
        return marker

    def start_near(self, **poses: float | Sequence[float]) -> None:
        """Rough start poses that pick the assembly branch, in DEGREES: ``crank=0, coupler=45``.

        A body that no joint places, such as a slider, may be given as (x, y, degrees).
        """
        for name, pose in poses.items():
            self.known_body(name)
            if isinstance(pose, int | float | np.number):
                self.starts[name] = start_given(self, name, number_given(self, f"start of '{name}'", pose))
                continue
            x, y, degrees = several_numbers(
                f"{self.name}: start of '{name}'", pose, 3, "give degrees, or (x, y, degrees)"
            )
            self.starts[name] = start_given(self, name, degrees, (x, y))

    def start_moving(self, **velocities: float | Sequence[float]) -> None:
        """Give bodies velocities at the start of a simulation.

        A velocity is in rad/s, or (vx, vy, omega) of the body's frame in m/s and rad/s.

        Bodies that are not named move as their joints make them, with the least kinetic energy. Where joints and
        drivers forbid a given value, it is changed and the simulation warns.
        """
        for name, velocity in velocities.items():
            self.known_body(name)
            what = f"start velocity of '{name}'"
            if isinstance(velocity, int | float | np.number):
                self.velocities[name] = StartVelocity(number_given(self, what, velocity))
                continue
            vx, vy, omega = several_numbers(f"{self.name}: {what}", velocity, 3, "give rad/s, or (vx, vy, omega)")
            self.velocities[name] = StartVelocity(omega, (vx, vy))

    def event(
        self,
        name: str,
        value: Callable[..., float],
        direction: int = 0,
        terminal: bool = False,
        action: Callable[..., object] | None = None,
        shortest: float | None = None,
        frames: Body | Marker | Sequence[Body | Marker] = (),
        releases: str | Joint | Sequence[str | Joint] = (),
    ) -> Event:
        """Monitor a scalar: an event is where ``value(t, moment)`` passes zero.

        It rises through zero with ``direction`` 1, falls with -1; 0 means both. ``moment`` shows the motion now
        (mbsd/dynamics/events/moment.py). ``terminal`` ends the simulation there; ``action`` is called with the moment
        and may change velocities and release joints. A scalar that is smooth is found below zero however short a time
        it is there. One that has pulses is not seen between them: ``shortest`` (s) is how long the shortest thing in it
        lasts, and it is looked at twice as often.

        With ``frames``, bodies and markers, the functions get numbers and may be compiled with numba.njit:
        ``value(t, q, v)``, with x, y, theta and their rates of each frame in turn (m, rad, m/s, rad/s; world axes).
        ``action(t, q, v)`` then gives the velocities vx, vy, omega of each frame from there on, 3 numbers a frame;
        what the joints forbid of them is taken away. ``releases`` names joints and drivers that go for good, as if they
        broke, after the action. Raises ModelError for what is none of these.
        """
        new_name(self, name, "event", self.events)
        event = self.events[name] = checked_event(
            self, name, value, direction, terminal, action, shortest, frames, releases
        )
        return event

    def change(self, name: Body | Joint | Force | str, **values: Any) -> None:
        """Change numbers or laws of a body, joint, driver, force or contact, given itself or by name.

        The next solution has them.

            m.change("spring", stiffness=250.0)
            m.change("crank", mass=1.2)
            m.change("motor", law=constant_rate(20.0))

        ``values`` are the arguments of the method that added it, but for its markers and bodies; of a body its mass
        (kg), com (m) and inertia (kg m^2), of a bar its length (m), too, with which all that is at its end moves. The
        model is then the one that would have been built with these numbers: what was not given but follows from
        others, such as the inertia of a bar or static friction, follows the new ones, and None takes a number back.
        Nothing is compiled again. Raises ModelError where that method does, and then changes nothing.
        """
        from mbsd.model.change import change

        change(self, name_of(name), values)


def checked_event(
    m: Model,
    name: str,
    value: Any,
    direction: Any,
    terminal: bool,
    action: Any,
    shortest: float | None,
    frames: Body | Marker | Sequence[Body | Marker],
    releases: str | Joint | Sequence[str | Joint],
) -> Event:
    """The event that these arguments of :meth:`mbsd.mechanism.Mechanism.event` say. Raises ModelError."""
    event = f"{m.name}: event '{name}'"
    seen = _frames(m, event, frames)
    for what, function in (("value", value), ("action", action)):
        if what == "action" and function is None:
            continue
        if not callable(function):
            raise ModelError(f"{event}: {what} is {shown(function)}; it must be a function")
        if not seen and type(function).__module__.startswith("numba."):
            raise ModelError(
                f"{event}: {what} is compiled with numba, and compiled functions cannot take a Moment. Name the bodies "
                "and markers it needs, frames=(arm, tip), and write it as value(t, q, v) of their numbers"
            )
    if direction not in (-1, 0, 1):
        raise ModelError(f"{event}: direction is {shown(direction)}; it must be 1, -1 or 0")
    names = [marker.body.name for marker in seen]
    if action is not None and ("ground" in names or len(set(names)) < len(names)):
        raise ModelError(f"{event}: its action gives velocities to frames; take each moving body once, not ground")
    released = _released(m, event, releases)
    if released and terminal:
        raise ModelError(f"{event}: it ends the simulation, so nothing is released after it; leave one of them out")
    return Event(name, value, direction, bool(terminal), action, checked_pulses(event, (), shortest)[1], seen, released)


def _released(m: Model, event: str, releases: Any) -> tuple[str, ...]:
    given, known = (releases,) if isinstance(releases, str | Joint) else releases, {**m.joints, **m.drivers}
    if not isinstance(given, Sequence):
        raise ModelError(f"{event}: releases is {shown(releases)}; give names of joints: releases=('hinge', 'motor')")
    names = [joint.name if isinstance(joint, Joint) else joint for joint in given]
    for name in names:
        if not isinstance(name, str) or name not in known:
            raise ModelError(f"{event}: {no_such('joint to release', name, known)}")
    return tuple(dict.fromkeys(names))


def _frames(m: Model, event: str, frames: Any) -> tuple[Marker, ...]:
    given = (frames,) if isinstance(frames, Body | Marker | str) else frames
    if not isinstance(given, Sequence) or not all(isinstance(frame, Body | Marker | str) for frame in given):
        raise ModelError(f"{event}: frames are {shown(frames)}; give bodies and markers: frames=(arm, arm.end)")
    what = f"event of frames ({event})"
    for frame in given:
        own_body(m, frame.body if isinstance(frame, Marker) else frame, what)
    return tuple(frame if isinstance(frame, Marker) else own_body(m, frame, what).origin for frame in given)
