"""A mechanism in space by name: bodies, joints, drivers, traces. Numbers in SI; angles in radians.

    m = Mechanism("pendulum")
    rod = m.rod("rod", (0, 0, 0), (0.5, 0, 0), mass=1.0)
    m.revolute("A", m.ground, rod, at=(0, 0, 0), axis=(0, 1, 0))

Every error of a model is raised here, by name, before anything is solved.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import checked_methods
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.base.quantity import counted
from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.building import Building
from mbsd.spatial.model.force import Force
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.journal import change, recorded
from mbsd.spatial.model.mechanism import STANDARD_GRAVITY

if TYPE_CHECKING:
    from typing import Self

    from mbsd.analyses.modes import Mode
    from mbsd.dynamics.batch.simulate_many import Simulations
    from mbsd.dynamics.measures.kinds import Measure
    from mbsd.results.views import Mobility
    from mbsd.spatial.analyses.equilibrium import Equilibrium
    from mbsd.spatial.analyses.linearise import Linearisation
    from mbsd.spatial.results.solution import Solution

__all__ = ["STANDARD_GRAVITY", "Body", "Joint", "Marker", "Mechanism"]


@recorded
@checked_methods
class Mechanism(Building):
    """Bodies, joints, drivers, traced points by name. ``gravity`` in m/s^2; None turns it off."""

    def mobility(self) -> Mobility:
        """Return degrees of freedom, nominal and by rank, and redundant joints; it needs no drivers."""
        from mbsd.spatial.kinematics.prepared import mobility

        return mobility(self)

    def sweep(
        self,
        duration: float | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        switch_at: Sequence[float] | np.ndarray = (),
    ) -> Solution:
        """Solve the driven motion: poses, velocities, accelerations, reactions, driver efforts.

        ``steps`` equal steps over ``duration`` seconds, both ends included; by default over the common period of the
        laws of the drivers. ``times`` (s), rising, replaces both. Steps in between keep the motion on its assembly
        branch. Change points are passed on the smooth continuation; at those of the times ``switch_at`` (s) the motion
        goes on to the other assembly. Raises AssemblyError where the joints do not close at the start, MobilityError
        where drivers and freedoms do not match, SingularPoseError and BranchError where the motion cannot go on.
        """
        from mbsd.spatial.kinematics.sweep import sweep

        return sweep(self, duration, steps, times, switch_at)

    def simulate(
        self,
        duration: float | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        tolerance: float = 1e-7,
        event_rows: bool = False,
        formulation: str = "auto",
    ) -> Solution:
        """Simulate the motion under gravity from ``start_near`` and ``start_moving``, drivers imposed.

        ``steps`` equal output steps over ``duration`` seconds, both ends included; ``times`` (s), rising, replaces
        both. ``tolerance`` is relative to the mechanism's size, to 1 rad, and to speeds. ``event_rows`` adds two rows
        at every event, right before and after it; a terminal event is the last row. ``formulation``: "tree"
        integrates the turns and slides of a spanning tree of joints and keeps the others as rows, "reference" all
        coordinates, which events and friction need; by default the one that is usually quicker. Raises MobilityError
        for a body without mass or inertia, SimulationError where the integration cannot go on.
        """
        from mbsd.spatial.dynamics.simulate import request_for, simulate

        return simulate(self, event_rows, request_for(self, duration, steps, times, tolerance, formulation))

    def simulate_many(
        self,
        duration: float | None = None,
        vary: Mapping[str, Mapping[str, Sequence[float] | np.ndarray]] | None = None,
        start: Mapping[str, Sequence[float] | np.ndarray] | None = None,
        moving: Mapping[str, Sequence[float] | np.ndarray] | None = None,
        measure: Mapping[str, Measure] | Callable[[Solution], Mapping[str, Any]] | None = None,
        steps: int = 360,
        times: Sequence[float] | np.ndarray | None = None,
        tolerance: float = 1e-7,
        formulation: str = "auto",
        threads: int | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> Simulations:
        """Simulate n times with other numbers and starts, on all cores, and keep measures alone.

        ``vary``: names to arguments of :meth:`change` and their (n,) or (n, k) values; ``start`` and ``moving``: names
        to what :meth:`start_near` (degrees, m) and :meth:`start_moving` take. A single value is that of all.
        ``measure``: names to measures (mbsd.measures), or a function of a solution that gives numbers by name, for
        which each simulation is made by itself. The other arguments are those of :meth:`simulate`; ``progress`` gets
        the part that is done, ``threads`` is one a core by default.

        What can be simulated in one compiled loop is, the rest one by one: ``way`` of the result says which and why.
        Simulations that fail have a reason there. Raises ModelError for what cannot be asked.
        """
        from mbsd.spatial.batch.designs import designs_of
        from mbsd.spatial.batch.simulate_many import simulations
        from mbsd.spatial.dynamics.simulate import request_for

        asked = request_for(self, duration, steps, times, tolerance, formulation)
        return simulations(designs_of(self, vary, start, moving), measure, asked, threads, progress)

    def change(self, name: Body | Joint | Force | str, **values: Any) -> None:
        """Change arguments of the method that added a body, joint, driver, force or event.

            m.change("spring", stiffness=250.0)
            m.change("top", mass=1.2, com=(0, 0, 0.2))

        The mechanism is then the one that would have been built with them; places that were given as numbers stay.
        Raises ModelError where that method does, and then changes nothing.
        """
        change(self, name if isinstance(name, str) else name.name, values)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the mechanism to a JSON file. Raises ModelError for functions of the user, which no file can hold."""
        from mbsd.spatial.saving import save

        save(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Return the mechanism of a file that :meth:`save` wrote. Raises ModelError for any other."""
        from mbsd.spatial.saving import load

        return load(path, cls)

    def equilibrium(self, time: float = 0.0, nearest: bool = False) -> Equilibrium:
        """Return the static equilibrium: pose, reactions, efforts of drivers, stiffness and stability.

        Found from ``start_near``, downhill to a stable pose; ``nearest`` takes the nearest pose that balances, stable
        or not. Drivers hold where they are at ``time`` (s), laws of forces have the value of then. Raises AssemblyError
        where the joints do not close, SimulationError where nothing balances.
        """
        from mbsd.spatial.analyses.equilibrium import equilibrium

        return equilibrium(self, time, nearest)

    def linearise(self, at: Equilibrium | str = "equilibrium") -> Linearisation:
        """Return A, eigenvalues and modes of small motions: x' = A x.

        ``at``: "equilibrium" (the stable one, found from start_near), "start" (start_near and start_moving, which must
        be a steady motion, such as a bicycle that goes straight on), or an equilibrium. Raises MobilityError if nothing
        can move.
        """
        from mbsd.spatial.analyses.linearise import linearise

        if at not in ("equilibrium", "start") and isinstance(at, str):
            raise ModelError(f"{self.name}: {no_such('state to linearise at', at, ('equilibrium', 'start'))}")
        return linearise(self, self.equilibrium() if at == "equilibrium" else at)

    def modes(self) -> tuple[Mode, ...]:
        """Return natural frequencies, damping and shapes about the stable equilibrium, by rising frequency."""
        return self.linearise().modes

    def __repr__(self) -> str:
        bodies, joints, drivers = len(self.bodies) - 1, len(self.joints), len(self.drivers)
        said = ", ".join([counted(bodies, "body"), counted(joints, "joint"), counted(drivers, "driver")])
        return f"<Mechanism {self.name} in space: {said}>"
