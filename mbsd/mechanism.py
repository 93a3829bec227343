"""A mechanism by name: bodies, markers, joints, drivers, traces. Numbers in SI; angles in radians.

    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)

Everything wrong is refused here, by name, before anything is solved.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import checked_methods, several_numbers
from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.model.adding.forces import Amount
from mbsd.model.body import Body, Marker
from mbsd.model.contacts.discs import rigid_discs
from mbsd.model.contacts.line import rigid_contact
from mbsd.model.contacts.one_way import one_way
from mbsd.model.contacts.rope import rope
from mbsd.model.contacts.stops import angle_stop, coordinate_stop, stop
from mbsd.model.contacts.terrain import rigid_terrain
from mbsd.model.drivers.angle import drive_angle
from mbsd.model.drivers.coordinate import drive_coordinate
from mbsd.model.drivers.distance import drive_distance
from mbsd.model.drivers.relative_angle import drive_relative_angle
from mbsd.model.event import Event
from mbsd.model.force import Force
from mbsd.model.forces.actuator import actuator
from mbsd.model.forces.bushing import bushing
from mbsd.model.forces.contact import contact
from mbsd.model.forces.curve_of_angle import curve_of_angle, motor
from mbsd.model.forces.curve_of_length import curve_of_length
from mbsd.model.forces.drag import drag
from mbsd.model.forces.force import force
from mbsd.model.forces.friction import friction
from mbsd.model.forces.gas import gas
from mbsd.model.forces.gas_cycle import gas_cycle
from mbsd.model.forces.gas_strut import gas_strut
from mbsd.model.forces.gravitation import gravitation
from mbsd.model.forces.hydraulic_cylinder import hydraulic_cylinder
from mbsd.model.forces.rotating_frame import rotating_frame
from mbsd.model.forces.spring import spring
from mbsd.model.forces.spring_law import spring_law
from mbsd.model.forces.torque import torque
from mbsd.model.forces.torsion_spring import torsion_spring
from mbsd.model.forces.torsion_spring_law import torsion_spring_law
from mbsd.model.forces.tyre import tyre
from mbsd.model.forces.user_force import user_force
from mbsd.model.joint import Joint
from mbsd.model.joints.angle_lock import angle_lock
from mbsd.model.joints.belt import belt
from mbsd.model.joints.cam_flat import cam_flat
from mbsd.model.joints.cam_roller import cam_roller
from mbsd.model.joints.constraint import constraint
from mbsd.model.joints.distance import distance
from mbsd.model.joints.gear_pair import gear_pair
from mbsd.model.joints.geneva import geneva
from mbsd.model.joints.pin_in_slot import pin_in_slot
from mbsd.model.joints.point_on_curve import point_on_curve
from mbsd.model.joints.prismatic import prismatic
from mbsd.model.joints.rack_and_pinion import rack_and_pinion
from mbsd.model.joints.revolute import revolute
from mbsd.model.joints.rolling_disc import rolling_disc
from mbsd.model.joints.rolling_on_curve import rolling_on_curve
from mbsd.model.joints.weld import weld
from mbsd.model.laws.function import checked_pulses
from mbsd.model.mechanism import STANDARD_GRAVITY, Model, Start, StartVelocity, new_name, number_given, own_body

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mbsd.analyses.efforts import ActuatedMotion
    from mbsd.analyses.equilibrium import Equilibrium
    from mbsd.analyses.modes import Mode
    from mbsd.analyses.state_space import Linearisation
    from mbsd.analyses.suspicious_units import Finding
    from mbsd.drawing.picture import Picture, Svg
    from mbsd.kinematics.batch import Batch
    from mbsd.results.mobility import Mobility
    from mbsd.results.solution import Solution

__all__ = ["STANDARD_GRAVITY", "Body", "Force", "Joint", "Marker", "Mechanism", "Start"]


@checked_methods
class Mechanism(Model):
    """Bodies, joints, drivers and traced points, by name. ``gravity`` in m/s^2; None turns it off."""

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
    angle_lock = angle_lock
    constraint = constraint

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
    contact = contact
    tyre = tyre
    drag = drag
    rotating_frame = rotating_frame
    friction = friction
    user_force = user_force

    # -- unilateral contacts and stops, which act in simulations alone -------------------------------------------------

    rigid_contact = rigid_contact
    rigid_discs = rigid_discs
    rigid_terrain = rigid_terrain
    rope = rope
    angle_stop = angle_stop
    coordinate_stop = coordinate_stop
    stop = stop
    one_way = one_way

    # -- points, starts, events -------------------------------------------------------------------------------------

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
                self.starts[name] = Start(math.radians(number_given(self, f"start of '{name}'", pose)))
                continue
            x, y, degrees = several_numbers(
                f"{self.name}: start of '{name}'", pose, 3, "give degrees, or (x, y, degrees)"
            )
            self.starts[name] = Start(math.radians(degrees), (x, y))

    def start_moving(self, **velocities: float | Sequence[float]) -> None:
        """Velocities at the start of a simulation: rad/s, or (vx, vy, omega) of the body's frame in m/s and rad/s.

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
        value: Callable[[float, Any], float],
        direction: int = 0,
        terminal: bool = False,
        action: Callable[[Any], object] | None = None,
        shortest: float | None = None,
    ) -> Event:
        """Monitor a scalar: ``value(t, moment)`` passes zero, rising (direction 1), falling (-1) or either (0).

        ``moment`` shows the motion now (mbsd/dynamics/events/moment.py). ``terminal`` ends the simulation there;
        ``action`` is called with the moment and may change velocities and release joints. A scalar that is smooth is
        found below zero however short a time it is there. One that has pulses is not seen between them: ``shortest``
        (s) is how long the shortest thing in it lasts, and it is looked at twice as often.
        """
        new_name(self, name, "event", self.events)
        for what, function in (("value", value), ("action", action)):
            if not callable(function) and not (what == "action" and function is None):
                raise ModelError(f"{self.name}: event '{name}': {what} is {shown(function)}; it must be a function")
        if direction not in (-1, 0, 1):
            raise ModelError(f"{self.name}: event '{name}': direction is {shown(direction)}; it must be 1, -1 or 0")
        event = self.events[name] = Event(
            name,
            value,
            direction,
            bool(terminal),
            action,
            checked_pulses(f"{self.name}: event '{name}'", (), shortest)[1],
        )
        return event

    def marker_in_world(self, body: Body, x: float, y: float, angle: float) -> Marker:
        """See :meth:`mbsd.model.body.Body.at_world`."""
        from mbsd.kinematics.pose.world_places import marker_in_world

        return marker_in_world(self, body, x, y, angle)

    def change(self, name: str, **values: Any) -> None:
        """Change numbers or laws of a body, joint, driver, force or contact; the next solution has them.

            m.change("spring", stiffness=250.0)
            m.change("crank", mass=1.2)
            m.change("motor", law=constant_rate(20.0))

        ``values`` are the arguments of the method that added it, but for its markers and bodies; of a body its mass
        (kg), com (m) and inertia (kg m^2), of a bar its length (m), too, with which all that is at its end moves. The
        model is then the one that would have been built with these numbers: what was not given but follows from
        others, such as the inertia of a bar or static friction, follows the new ones, and None takes a number back.
        Nothing is compiled anew. Raises ModelError, and changes nothing, for what that method refuses.
        """
        from mbsd.model.change import change

        change(self, name, values)

    def check(self) -> list[Finding]:
        """Numbers that look like a mixed-up unit, with remedies; the first solution warns of them (ModelWarning)."""
        from mbsd.analyses.suspicious_units import check

        return check(self)

    # -- what it can compute -----------------------------------------------------------------------------------

    def mobility(self) -> Mobility:
        """Degrees of freedom, nominal and by rank, and redundant joints; does not need drivers."""
        from mbsd.dynamics.mobility import mobility

        return mobility(self)

    def sweep(
        self,
        duration: float | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        event_rows: bool = False,
    ) -> Solution[Mechanism]:
        """Solve the driven motion: positions, velocities, accelerations, reactions, driver efforts, energy.

        ``steps`` equal steps over ``duration`` seconds, both ends included; by default over one :meth:`period`, and
        where there is none over that of the laws, with a ModelWarning; with gas over whole cycles of it. ``times`` (s),
        rising, replaces both. ``event_rows`` adds two rows where a law or gas makes forces jump, right before and
        after it, which share its time.
        """
        from mbsd.analyses.suspicious_units import tell
        from mbsd.kinematics.sweep import sweep

        tell(self)
        return sweep(self, duration, steps, times, event_rows)

    def period(self) -> float | None:
        """The time (s) after which every body is back but for whole turns, with its velocity and acceleration.

        It is a whole multiple of the common period of all drivers, which gears, belts and indexed wheels make longer:
        two turns of a driver that turns a gear at half its speed. None where no law repeats, or within 100 of these
        nothing does. Raises what :meth:`sweep` raises.
        """
        from mbsd.kinematics.period import period

        return period(self)

    def batch(
        self,
        lengths: Mapping[str, Sequence[float] | np.ndarray] | None = None,
        places: Mapping[str, Sequence[Sequence[float]] | np.ndarray] | None = None,
        angles: Sequence[str] = (),
        duration: float | None = None,
        steps: int = 360,
        threads: int | None = None,
    ) -> Batch:
        """Sweep n designs of this mechanism at once, tens of thousands a second: traced points, and angles asked for.

        ``lengths``: bar names to (n,) lengths (m), which move the bar's ``end``, or rods (distance joints) to their
        lengths. ``places``: joint names to (n, 2) places (m) of the joint's marker on ground, or else of its first
        marker, in that body's frame; or names of traced points to their places. Times are those of :meth:`sweep`.
        Designs share the branch of the mechanism itself. Raises ModelError for a mechanism that is not made of driven
        bodies and dyads.
        """
        from mbsd.kinematics.batch import batch

        return batch(
            self, {} if lengths is None else lengths, {} if places is None else places, angles, duration, steps, threads
        )

    def simulate(
        self,
        duration: float | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        method: str = "dop853",
        tolerance: float = 1e-7,
        step: float | None = None,
        progress: Callable[[float], None] | None = None,
        event_rows: bool = False,
        formulation: str = "auto",
        **options: float,
    ) -> Solution[Mechanism]:
        """Forward dynamics from ``start_near`` and ``start_moving``: M a + J^T lam = Q, J a = gamma.

        ``steps`` equal output steps over ``duration`` seconds, both ends included; ``times`` (s), rising, replaces
        both. ``method`` names an integrator (mbsd/dynamics/integrators). Methods with an error estimate keep to
        ``tolerance`` (relative to the mechanism's size, to 1 rad, and to speeds); those with a fixed step take ``step``
        (s), by default the time between outputs. ``progress`` is called with the part done (0 .. 1); what it
        raises ends the run.
        ``event_rows`` adds two rows at every event and where a force jumps at a known time, right before and after
        it (docs/events.md).
        ``formulation``: "reference" integrates all coordinates and projects them onto the joints; "independent" only
        as many as there are degrees of freedom, where the mechanism falls apart into driven bodies, gear trains, Assur
        groups and blocks of a few bodies: several times faster. "auto" takes the latter where it can and that pays
        (``solution.stats.independent``).
        ``options`` are numbers of the method itself, such as ``rho`` of "generalized_alpha".

        Raises AssemblyError where the links do not close, SimulationError where the integration cannot go on.
        """
        from mbsd.analyses.suspicious_units import tell
        from mbsd.dynamics.simulate import simulate

        tell(self)
        return simulate(
            self, duration, steps, times, method, tolerance, step, progress, options, event_rows, formulation
        )

    def equilibrium(self, time: float = 0.0, nearest: bool = False) -> Equilibrium:
        """Static equilibrium: pose, reactions, efforts of the drivers, stiffness and stability.

        Found from ``start_near``, downhill to a stable pose; ``nearest`` takes the nearest pose that balances, stable
        or not. Drivers hold where they are at ``time`` (s), laws of forces have the value of then.

        Raises AssemblyError where the links do not close, EquilibriumError where nothing balances, SingularPoseError
        where the pose that balances is a toggle or change point.
        """
        from mbsd.analyses.equilibrium import equilibrium
        from mbsd.analyses.suspicious_units import tell

        tell(self)
        return equilibrium(self, time, nearest)

    def linearise(
        self,
        at: Equilibrium | Solution | str = "equilibrium",
        t: float | None = None,
        inputs: Sequence[str] = (),
    ) -> Linearisation:
        """A, B, eigenvalues and modes of the motion near a state: dx' = A dx + B du.

        ``at``: ``"equilibrium"`` (the stable one, found from start_near), ``"start"`` (start_near and start_moving),
        an equilibrium, or a solution and its output nearest to ``t`` (s). ``inputs`` are efforts: names of drivers,
        which are released and keep their effort, or of torques, forces and actuators.

        Raises MobilityError if nothing can move, SingularPoseError at a toggle or change point.
        """
        from mbsd.analyses.linearise import linearise
        from mbsd.analyses.suspicious_units import tell

        tell(self)
        return linearise(self, at, t, inputs)

    def modes(self) -> tuple[Mode, ...]:
        """Natural frequencies, damping and shapes about the stable equilibrium, by rising frequency."""
        return self.linearise().modes

    # -- efforts and motions -----------------------------------------------------------------------------------

    def inverse_dynamics(self, motion: Solution, actuators: Sequence[str]) -> ActuatedMotion:
        """Efforts of ``actuators`` that make a known motion, and the reactions under them.

        ``motion`` comes from sweep() or simulate(). ``actuators`` are names of drivers, torques, forces or actuators;
        the other drivers only gave the motion its shape and carry nothing. With more actuators than degrees of
        freedom the efforts share with the least norm. Raises MobilityError where the actuators cannot make the motion.
        """
        from mbsd.analyses.efforts import inverse_dynamics

        return inverse_dynamics(self, motion, actuators)

    def with_efforts(self, **efforts: Amount | None) -> Mechanism:
        """A copy moved by efforts: each named driver gives this effort instead of imposing its law.

        An effort is a number, a law of time (``table(sol.t, sol.driver("motor").effort)``) or a function, in N or
        N m; None leaves the driver or force out. Torques, forces and actuators are given another law alike.
        """
        from mbsd.analyses.efforts import with_efforts

        return with_efforts(self, efforts)

    # -- pictures ----------------------------------------------------------------------------------------------

    def draw(self, ax: Axes | None = None, frames: bool = True, names: bool = True) -> Picture:
        """The skeleton at the start, with joints by their standard symbols, into ``ax`` or a figure of its own.

        ``frames`` shows the bodies' axes (x red, y green). Links that do not close are shown where they were put.
        A notebook shows the result, ``.save(path)`` writes it. Needs the extra ``draw``.
        """
        from mbsd.drawing.pose import start_pose
        from mbsd.drawing.skeleton import draw

        return draw(self, start_pose(self), ax, frames, names)

    def topology(self) -> Svg:
        """Bodies and joints as a diagram, redundant joints in red; a notebook shows it, ``.save(path)`` writes SVG."""
        from mbsd.drawing.topology.topology import topology

        return topology(self)

    # -- files -------------------------------------------------------------------------------------------------

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as JSON (docs/schema/model.schema.json), whole, the same bytes for the same model.

        Raises ModelError for what a file cannot hold, a Python function, and when it cannot be written.
        """
        from mbsd.saving.file import save

        save(self, path)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Mechanism:
        """The model that :meth:`save` wrote. Raises ModelError naming the file, the field and the remedy."""
        from mbsd.saving.file import load

        return load(path, Mechanism)

    def __repr__(self) -> str:
        bodies, joints, drivers = len(self.bodies) - 1, len(self.joints), len(self.drivers)
        return f"<Mechanism {self.name}: {bodies} bodies, {joints} joints, {drivers} drivers>"
