"""Forward dynamics in space from start to end, as a Solution."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws, refuse_bad_laws
from mbsd.base.errors import InitialConditionWarning, MobilityError, ModelError, SimulationError
from mbsd.base.names import no_such
from mbsd.base.quantity import counted
from mbsd.base.warning import warn
from mbsd.dynamics.events.loop import OVER, run_events
from mbsd.dynamics.integrators.dop853 import DOP853
from mbsd.dynamics.reference.arrays import Scratch, full_matrices
from mbsd.dynamics.simulate import output_times, refuse_bad_steps
from mbsd.dynamics.state import (
    ACCEPTED,
    CHOOSE,
    NEXT,
    REACHED,
    STEP_TOO_SMALL,
    TIME,
    Output,
    Settings,
    State,
    output_for,
    start_state,
)
from mbsd.kinematics.pose.held_values import independent_rows
from mbsd.model.event import Happening
from mbsd.results.views import Mobility
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.dynamics.events import Events
from mbsd.spatial.dynamics.reference import ReferenceCoordinates
from mbsd.spatial.dynamics.start import start_velocities
from mbsd.spatial.dynamics.tree.coordinates import TreeCoordinates
from mbsd.spatial.equations.evaluation import wrenches_along
from mbsd.spatial.kinematics.close import assemble
from mbsd.spatial.kinematics.mobility import joint_mobility, refuse_shared_friction
from mbsd.spatial.kinematics.newton import DrivenMotion
from mbsd.spatial.kinematics.prepared import packed_checked
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.results.solution import Solution

OUTPUTS_LONGEST = 25
"""A step covers this part of the duration at most where drivers move, so that short ways are not stepped over."""
SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""
AUTO, REFERENCE, TREE = FORMULATIONS = ("auto", "reference", "tree")
STEPS = 10**9


def simulate(m: Model, event_rows: bool, asked: Mapping[str, Any]) -> Solution:
    """Return a simulation; see :meth:`mbsd.spatial.mechanism.Mechanism.simulate`. ``asked``: see request_for."""
    return Run(m, event_rows=event_rows, **asked).followed()


def request_for(
    m: Model, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None, tolerance: float,
    formulation: str,
) -> dict[str, Any]:  # fmt: skip
    """Return how a mechanism is simulated, as arguments of Run. Raises ModelError for what cannot be asked."""
    same_fields: Any = m
    grid = output_times(same_fields, duration, steps, times)
    refuse_bad_steps(same_fields, grid, tolerance, None)
    if formulation not in FORMULATIONS:
        raise ModelError(f"{m.name}: {no_such('formulation', formulation, FORMULATIONS)}")
    return {"grid": grid, "tolerance": tolerance, "formulation": formulation}


@dataclass
class Run:
    """A simulation over output times (T,) (s)."""

    m: Model
    grid: np.ndarray
    tolerance: float
    formulation: str = AUTO
    event_rows: bool = False

    def __post_init__(self) -> None:
        start, end = float(self.grid[0]), float(self.grid[-1])
        packed = self.packed = packed_checked(self.m)
        packed.settle_laws(start, end)
        same_fields: Any = packed
        refuse_bad_laws(same_fields, start, end)
        _refuse_without_inertia(packed)
        q, turns = assemble(self.m, packed, start)
        self.mobility = joint_mobility(packed, q)
        refuse_shared_friction(packed, self.mobility)
        self.drive = packed.drives(self.grid[:1])[0]
        begun = start_velocities(self.m, packed, q, self.drive)
        if begun.changes:
            words = "; ".join(begun.changes)
            warn(f"{packed.name}: the start was made consistent: {words}", InitialConditionWarning)
        self.laws = compiled_laws(same_fields, start, end)
        self.changes = begun.changes
        packed.ws.guess[:] = turns
        self.turns = np.zeros((len(self.grid), len(turns)))
        independent = independent_rows(packed.scaled(q))
        _refuse_superfluous_drivers(packed, independent, self.mobility)
        self.coordinates = self._coordinates(q, begun.v, turns, len(independent))

    def _coordinates(
        self, q: np.ndarray, v: np.ndarray, turns: np.ndarray, rank: int
    ) -> TreeCoordinates | ReferenceCoordinates:
        """Return the coordinates that were asked for, else those that are likely to be quicker."""
        why = _why_reference(self.m)
        if self.formulation == TREE and why:
            raise ModelError(f"{self.m.name}: {why} need formulation='reference'; leave formulation= out")
        if self.formulation != REFERENCE and not why:
            tree = TreeCoordinates(self.m, self.packed, q, v, turns, rank)
            if self.formulation == TREE or tree.nanoseconds() < ReferenceCoordinates.nanoseconds(self.packed):
                return tree
        return ReferenceCoordinates(self.packed, q, v, self.mobility.redundant_rows > 0, float(self.grid[0]))

    def scratch(self) -> Scratch:
        """Return scratch for a run."""
        packed, entries = self.packed, self.coordinates.entries
        factors: Any = ()
        return Scratch(
            ws=self.coordinates.ws, factors=factors, drive=np.zeros((len(packed.motions) + 1, 3)),
            force=np.zeros(entries), multipliers=np.zeros(len(self.coordinates.ws.phi)), change=np.zeros((2, entries)),
            state=np.zeros((2, entries)), stages=np.zeros((DOP853.stages, 2, entries)), power=np.zeros(DOP853.stages),
            dense=np.zeros((8, 2, entries)), dense_work=np.zeros(7), full=full_matrices(0, 0), report=np.zeros(4),
        )  # fmt: skip

    def settings(self) -> Settings:
        """Return tolerances and lengths of steps."""
        packed = self.packed
        absolute, growing = self.coordinates.allowed(self.tolerance)
        longest = float(self.grid[-1] - self.grid[0]) / (OUTPUTS_LONGEST if packed.motions or packed.forces else 1)
        return Settings(
            absolute, float(self.tolerance), growing, longest, SMALLEST_STEP * longest, longest, np.zeros(0)
        )

    def dynamics(self) -> Any:
        """Return the arrays of the formulation, ready for the loop."""
        return self.coordinates.dynamics(self.laws, self.turns, self.drive)

    def begun(self) -> tuple[State, Output]:
        """Return the state at the start, and room for the outputs."""
        rows = len(self.coordinates.ws.phi)
        state = start_state(self.coordinates.y, rows, float(self.grid[0]))
        return state, output_for(self.grid, 7 * len(self.packed.bodies) - 4, rows)

    def start(self) -> tuple[np.ndarray, np.ndarray]:
        """Return pose (3 + 7 n,) and velocities (3 + 6 n,) at the start, w in the world; of reference coordinates."""
        y = self.coordinates.y[:, None]
        return y[0, 0], self.coordinates.to_world(y[0], y[1, :, : self.packed.freedoms + 3].copy())[0]

    def followed(self) -> Solution:
        """Return the motion until the last output. Raises SimulationError where it cannot go on."""
        end, watched, none = float(self.grid[-1]), list(self.m.events.values()), np.zeros(0)
        dyn = self.dynamics()
        (state, out), scratch, settings = self.begun(), self.scratch(), self.settings()
        events = Events(self.packed, watched, state, settings.longest, end, dyn, self.event_rows) if watched else None

        def advance(contacts: Any, most: int) -> int:
            return run_events(dyn, scratch, state, settings, contacts, out, end, most, none, none)

        while True:
            if events is None:
                status = DOP853.advance(dyn, scratch, state, out, settings, end, STEPS)
            else:  # rows are chosen between steps, never while one is tried
                choosing, dyn.limit[0] = float(dyn.limit[0]), 0.0
                status = events.follow(advance, state, end, choosing > 0.0)
                dyn.limit[0] = choosing
                if status == CHOOSE and not scratch.report[0] < choosing:
                    continue
            self.coordinates.check_callbacks(status in (REACHED, OVER, CHOOSE))
            if status in (REACHED, OVER):
                break
            if status != CHOOSE or isinstance(self.coordinates, TreeCoordinates):
                raise self._refusal(status, state)
            self.coordinates.choose(state.y)
            dyn = self.dynamics()
        if events is not None:
            out = self._with_rows(out, int(state.count[NEXT]), events)
        happened = () if events is None else tuple(events.happenings)
        return self._solution(out, int(state.count[ACCEPTED]), happened)

    def _with_rows(self, out: Any, written: int, events: Events) -> Any:
        """Return outputs that were written, with those beside events between them."""
        rows = events.rows
        t, y, a, lam, work, turns = (
            np.array([row[k] for row in rows]).reshape(len(rows), *part.shape[1:])
            for k, part in enumerate((out.t, out.y, out.a, out.lam, out.work, self.turns))
        )
        parts = [(out.t, t), (out.y, y), (out.a, a), (out.lam, lam), (out.work, work), (out.margin, np.ones(len(t)))]
        order = np.argsort(np.concatenate([out.t[:written], t]), kind="stable")
        self.turns = np.concatenate([self.turns[:written], turns])[order]
        whole = Output(*(np.concatenate([series[:written], added])[order] for series, added in parts))
        self.grid = whole.t
        return whole

    def _refusal(self, status: int, state: Any) -> SimulationError:
        why = "its steps shrink to nothing" if status == STEP_TOO_SMALL else "its numbers are no longer finite"
        return SimulationError(
            f"{self.packed.name}: the simulation cannot go on at t = {float(state.clock[TIME]):.6g} s: {why}. The pose "
            "is singular there, or bodies lack inertia; look at the joints in this pose"
        )

    def joined(self, times: np.ndarray, y: np.ndarray, a: np.ndarray, starts: dict[str, np.ndarray]) -> Solution:
        """Return R motions of this run's kind behind one another: what it says of frames is (T, R, ...).

        ``y`` (R, T, 2, n) and ``a`` (R, T, n) at ``times`` (T,); ``starts``: turns and slides that differ (R,).
        """
        count, parts = len(times), []
        for part in self._in_world(y.reshape(-1, *y.shape[2:]), a.reshape(-1, a.shape[-1])):
            parts.append(np.swapaxes(part.reshape(len(y), count, -1), 0, 1))
        motion = self._motion(times, parts, np.zeros((count, 0)), np.zeros(count))
        return Solution(
            self.m, self.packed, motion, np.ones(count, bool), self.mobility, self.laws, {**self.m.starts, **starts}
        )

    def _in_world(self, y: np.ndarray, a: np.ndarray) -> list[np.ndarray]:
        """Return q (T, 3 + 7 n), v and a (T, 3 + 6 n) in the world of outputs y (T, 2, n) and a (T, n)."""
        q, body = np.ascontiguousarray(y[:, 0]), self.packed.freedoms + 3
        return [q, *(self.coordinates.to_world(q, part[:, :body]) for part in (y[:, 1], a))]

    def _motion(
        self, times: np.ndarray, parts: list[np.ndarray], turns: np.ndarray, margin: np.ndarray
    ) -> DrivenMotion:
        """Return a motion without multipliers from q, v and a in ``parts``."""
        packed, none, (q, v, a) = self.packed, np.zeros(len(times)), parts
        return DrivenMotion(
            times=times, drives=packed.drives(times), stride=none, q=q, dq=q, ddq=q, v=v, a=a, turn=turns,
            turn_rate=turns, residual=none, margin=margin, determinant=none[:, None],
            lam=np.zeros((0, len(packed.ws.phi))), wrench=np.zeros((0, len(packed.passive_joints), 6)),
        )  # fmt: skip

    def _solution(self, out: Any, steps: int, happened: tuple[Happening, ...]) -> Solution:
        packed, count = self.packed, len(self.grid)
        motion = self._motion(self.grid, self._in_world(out.y, out.a), self.turns, out.margin)
        in_tree = isinstance(self.coordinates, TreeCoordinates)
        if not in_tree and not self.mobility.redundant_rows:
            motion = motion._replace(lam=out.lam, wrench=np.zeros((count, *motion.wrench.shape[1:])))
            wrenches_along(packed.system, motion.drives, motion.q, packed.ws, motion.lam, motion.wrench)
        return Solution(
            self.m, packed, motion, np.ones(count, bool), self.mobility, self.laws, dict(self.m.starts),
            steps=steps, work=out.work, changes=self.changes, formulation=TREE if in_tree else REFERENCE,
            events=happened,
        )  # fmt: skip


def _why_reference(m: Model) -> str:
    """Return what needs reference coordinates, in words; empty if nothing does."""
    if m.events:
        return "events of the user"
    return "joints with friction" if any(force.kind.friction_of is not None for force in m.forces.values()) else ""


def _refuse_superfluous_drivers(packed: Packed, independent: list[int], mobility: Mobility) -> None:
    """Raise MobilityError where drivers impose what joints or other drivers fix already."""
    rows = range(packed.driver_rows, len(packed.row_joint))
    idle = [driver.name for row, driver in zip(rows, packed.drivers, strict=True) if row not in independent]
    if idle:
        raise MobilityError(
            f"{packed.name}: driver '{idle[0]}' drives a freedom that the joints and other drivers already fix: "
            f"{counted(len(packed.motions), 'driver')}, {counted(mobility.dof, 'degree')} of freedom. "
            "Remove a driver or free a joint."
        )


def _refuse_without_inertia(packed: Packed) -> None:
    """Raise MobilityError for a body without mass, or without inertia about an axis."""
    for body, mass, moments in zip(packed.bodies[1:], packed.system.mass[1:], packed.system.inertia[1:], strict=True):
        if mass == 0.0:
            raise MobilityError(
                f"{packed.name}: body '{body.name}' has no mass, so nothing says how it accelerates. Give it mass=, or "
                "join its neighbours by a universal joint or a distance without it"
            )
        if not moments.all():
            axis = body.principal[1][:, int(np.argmin(moments))]
            raise MobilityError(
                f"{packed.name}: body '{body.name}' has no inertia about its axis ({axis[0]:.3g}, {axis[1]:.3g}, "
                f"{axis[2]:.3g}), so nothing says how it turns about it. Give it inertia=, or a rod a radius="
            )
