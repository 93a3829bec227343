"""A mechanism by name: bodies, markers, joints, drivers, traces. Numbers in SI; angles in radians.

    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)

Every error of a model is raised here, by name, before anything is solved.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import checked_methods
from mbsd.base.quantity import counted
from mbsd.model.body import Body, Marker
from mbsd.model.building import Building
from mbsd.model.entries import Amount
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import STANDARD_GRAVITY, Start

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mbsd.analyses.efforts import ActuatedMotion
    from mbsd.analyses.equilibrium import Equilibrium
    from mbsd.analyses.findings import Finding
    from mbsd.analyses.modes import Mode
    from mbsd.analyses.state_space import Linearisation
    from mbsd.derivatives.sensitivities import Sensitivities
    from mbsd.drawing.drawer import SkeletonDrawer
    from mbsd.dynamics.batch.simulate_many import Simulations
    from mbsd.dynamics.measures.kinds import Measure
    from mbsd.kinematics.batch import Batch
    from mbsd.pictures import Picture, Svg
    from mbsd.results.solution import Solution
    from mbsd.results.views import Mobility

__all__ = ["STANDARD_GRAVITY", "Body", "Force", "Joint", "Marker", "Mechanism", "Start"]


@checked_methods
class Mechanism(Building):
    """Bodies, joints, drivers and traced points, by name. ``gravity`` in m/s^2; None turns it off."""

    def check(self) -> list[Finding]:
        """Return what looks as if it was not meant, with remedies: mixed-up units, links that do not close.

        The first solution warns of the former (ModelWarning) and raises the latter as an error. Notes (``is_note``)
        come last: closed chains of four links that have change points.
        """
        from mbsd.analyses.findings import change_point_chains, start_problems
        from mbsd.analyses.suspicious_units import check

        odd = check(self) or list(start_problems(self))  # a wrong unit keeps links from closing, too
        return [*odd, *change_point_chains(self)]

    # -- what it can compute -----------------------------------------------------------------------------------

    def mobility(self) -> Mobility:
        """Degrees of freedom, nominal and by rank, and redundant joints; does not need drivers."""
        from mbsd.dynamics.prepare.large import mobility

        return mobility(self)

    def sweep(
        self,
        duration: float | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        event_rows: bool = False,
        switch_at: Sequence[float] | np.ndarray = (),
    ) -> Solution[Mechanism]:
        """Solve the driven motion: positions, velocities, accelerations, reactions, driver efforts, energy.

        ``steps`` equal steps over ``duration`` seconds, both ends included; by default over one :meth:`period`, and
        where there is none over that of the laws, with a ModelWarning; with gas over whole cycles of it. ``times`` (s),
        rising, replaces both. ``event_rows`` adds two rows where a law or gas makes forces jump, right before and
        after it, which share its time.

        Change points, where two assemblies meet, are passed on the smooth continuation. At those whose times (s)
        ``switch_at`` names the motion goes on to the other assembly instead: velocities jump there. Where efforts do
        not exist at such a pose they are NaN, and ``notes`` of the solution name the rows.
        """
        from mbsd.analyses.suspicious_units import tell
        from mbsd.kinematics.sweep import sweep

        tell(self)
        return sweep(self, duration, steps, times, event_rows, switch_at=switch_at)

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
        """Sweep n designs of this mechanism at once: traced points, and the ``angles`` of bodies.

        ``lengths``: bar names to (n,) lengths (m), which move the bar's ``end``, or rods (distance joints) to their
        lengths. ``places``: joint names to (n, 2) places (m) of the joint's marker on ground, or else of its first
        marker, in that body's frame; or names of traced points to their places. A place that is given does not move
        with a length. Times are those of :meth:`sweep`.
        Designs share the branch of the mechanism itself; those that come near a change point are swept each by itself.
        Raises ModelError for a mechanism that is not made of driven bodies and dyads.
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

    def simulate_many(
        self,
        duration: float | None = None,
        vary: Mapping[str, Mapping[str, Sequence[float] | np.ndarray]] | None = None,
        start: Mapping[str, Sequence[float] | np.ndarray] | None = None,
        moving: Mapping[str, Sequence[float] | np.ndarray] | None = None,
        measure: Mapping[str, Measure] | Callable[[Solution[Mechanism]], Mapping[str, float]] | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        method: str = "dop853",
        tolerance: float = 1e-7,
        step: float | None = None,
        formulation: str = "auto",
        threads: int | None = None,
        progress: Callable[[float], None] | None = None,
        **options: float,
    ) -> Simulations:
        """Simulate n times with other numbers and starts, on all cores, and keep measures alone.

        ``vary``: names to arguments of :meth:`change`, or to other numbers that :meth:`sensitivities` names
        (``{"hinge": {"x": ...}, "motor": {"rate": ...}}``), and their (n,) values in SI units and rad; places are those
        in the frame of their body. ``start`` and ``moving``: names of bodies to what :meth:`start_near` (degrees) and
        :meth:`start_moving` take, (n,) or (n, 3). A single value is that of all. ``measure``: names to measures
        (mbsd.measures), or a function of a solution that gives numbers by name, for which each simulation is made by
        itself. The other arguments are those of :meth:`simulate`; ``progress`` gets the part that is done, ``threads``
        is one a core by default.

        What can be simulated in one compiled loop is, the rest one by one: ``way`` of the result says which and why.
        Simulations that fail have a reason there. Raises ModelError for what cannot be asked.
        """
        from mbsd.analyses.suspicious_units import tell
        from mbsd.dynamics.batch.designs import designs_of
        from mbsd.dynamics.batch.simulate_many import simulations
        from mbsd.dynamics.simulate import request_for

        tell(self)
        asked = request_for(self, duration, steps, times, method, tolerance, step, formulation, options)
        return simulations(designs_of(self, vary, start, moving), measure, asked, threads, progress)

    def sensitivities(
        self,
        of: Any,
        to: Sequence[str] | str,
        duration: float | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        simulate: bool | None = None,
        tolerance: float = 1e-9,
    ) -> Sensitivities:
        """Return derivatives of results of a sweep or simulation, events included, by numbers of the model.

        ``of``: names of quantities (``"P.x"``, ``"A.fx"``, ``"motor.effort"``, as measures have them), a list of them,
        a measure alone, or labels to quantities, measures (mbsd.measures) and functions of a solution. ``to``: names of
        numbers, such as ``"crank.length"``, ``"spring.stiffness"``, ``"rod.mass"``, ``"B.x"`` (the place of a joint),
        ``"P.y"`` (of a traced point), ``"motor.rate"``, ``"gravity.y"``, ``"door.moving.omega"``; docs/derivatives.md
        lists them.
        A mechanism is swept where its drivers leave no freedom and simulated otherwise; ``simulate`` says which. The
        other arguments are those of :meth:`sweep` and :meth:`simulate`; times stay what they are.

        Raises ModelError for names that do not exist, before anything is solved, and for what has no derivative.
        """
        from mbsd.analyses.suspicious_units import tell
        from mbsd.derivatives.sensitivities import sensitivities

        tell(self)
        return sensitivities(self, of, to, duration, steps, times, simulate, tolerance)

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
        """Draw the skeleton at the start, with symbols of joints, into ``ax`` or a figure of its own.

        ``frames`` shows the bodies' axes (x red, y green). Links that do not close are shown where they were put.
        A notebook shows the result, ``.save(path)`` writes it. Needs the extra ``draw``.
        """
        from mbsd.drawing.pose import start_pose
        from mbsd.drawing.skeleton import draw

        return draw(self, start_pose(self), ax, frames, names)

    def topology(self) -> Svg:
        """Return bodies and joints as a diagram, redundant joints in red; ``.save(path)`` writes SVG."""
        from mbsd.drawing.topology import topology

        return topology(self)

    @property
    def drawer(self) -> SkeletonDrawer:
        """The drawer of its solutions, for ``draw``, ``animate`` and ``view`` of a Solution."""
        from mbsd.drawing.drawer import SkeletonDrawer

        return SkeletonDrawer()

    def marker_in_world(self, body: Body, x: float, y: float, angle: float) -> Marker:
        """See :meth:`mbsd.model.body.Body.at_world`."""
        from mbsd.kinematics.pose.world_places import marker_in_world

        return marker_in_world(self, body, x, y, angle)

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
        said = ", ".join([counted(bodies, "body"), counted(joints, "joint"), counted(drivers, "driver")])
        return f"<Mechanism {self.name}: {said}>"
