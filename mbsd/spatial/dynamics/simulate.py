"""Forward dynamics in space from start to end, as a Solution."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws, refuse_bad_laws
from mbsd.base.errors import InitialConditionWarning, MobilityError, SimulationError
from mbsd.base.quantity import counted
from mbsd.base.warning import warn
from mbsd.dynamics.events.loop import OVER, run_events
from mbsd.dynamics.integrators.dop853 import DOP853
from mbsd.dynamics.reference.arrays import Scratch, full_matrices
from mbsd.dynamics.simulate import output_times, refuse_bad_steps
from mbsd.dynamics.state import ACCEPTED, CHOOSE, NEXT, REACHED, STEP_TOO_SMALL, TIME, Settings, output_for, start_state
from mbsd.equations.interactions.switching import WIDTH
from mbsd.kinematics.pose.held_values import independent_rows
from mbsd.kinematics.pose.mobility import better_rows
from mbsd.model.event import Happening
from mbsd.results.views import Mobility
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.dynamics.envelope import envelope_of
from mbsd.spatial.dynamics.events import Events
from mbsd.spatial.dynamics.formulation import SpaceDynamics, Switches, Table
from mbsd.spatial.dynamics.start import start_velocities
from mbsd.spatial.equations.evaluation import wrenches_along
from mbsd.spatial.kinematics.close import assemble
from mbsd.spatial.kinematics.mobility import joint_mobility
from mbsd.spatial.kinematics.newton import DrivenMotion
from mbsd.spatial.kinematics.prepared import packed_checked
from mbsd.spatial.kinematics.sharing import least_norm
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rotation import rotation_matrix
from mbsd.spatial.results.solution import Solution

OUTPUTS_LONGEST = 25
"""A step covers this part of the duration at most where drivers move, so that short ways are not stepped over."""
SMALLEST_STEP = 1e-13
"""Part of the longest step at which a run gives up."""
OWN = 0.0025
"""Square of the part of a row that must be its own among those in use."""
STEPS = 10**9


def simulate(
    m: Model, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None, tolerance: float,
    event_rows: bool = False,
) -> Solution:  # fmt: skip
    """Return a simulation; see :meth:`mbsd.spatial.mechanism.Mechanism.simulate`."""
    same_fields: Any = m
    grid = output_times(same_fields, duration, steps, times)
    refuse_bad_steps(same_fields, grid, tolerance, None)
    return Run(m, grid, tolerance, event_rows).followed()


@dataclass
class Run:
    """A simulation over output times (T,) (s)."""

    m: Model
    grid: np.ndarray
    tolerance: float
    event_rows: bool = False

    def __post_init__(self) -> None:
        start, end = float(self.grid[0]), float(self.grid[-1])
        packed = self.packed = packed_checked(self.m)
        packed.settle_laws(start, end)
        same_fields: Any = packed
        refuse_bad_laws(same_fields, start, end)
        _refuse_without_inertia(packed)
        self.q, turns = assemble(self.m, packed, start)
        self.mobility = joint_mobility(packed, self.q)
        drive = packed.drives(self.grid[:1])[0]
        begun = start_velocities(self.m, packed, self.q, drive)
        if begun.changes:
            words = "; ".join(begun.changes)
            warn(f"{packed.name}: the start was made consistent: {words}", InitialConditionWarning)
        self.laws = compiled_laws(same_fields, start, end)
        self.changes = begun.changes
        self.v = begun.v
        self.y = np.zeros((2, len(self.q)))
        self.y[0] = self.q
        self.y[1, : len(begun.v)] = _to_bodies(packed, self.q, begun.v)
        packed.ws.guess[:] = turns
        self.turns = np.zeros((len(self.grid), len(turns)))
        self.counted = np.zeros(1 + len(turns))
        self.counted[0] = start
        jac, self.kept = self._rows(self.q)
        _refuse_superfluous_drivers(packed, independent_rows(jac), self.mobility)

    def _rows(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the dimensionless J (m, 6 n) at q, and rows that are independent and far from each other."""
        jac = self.packed.scaled(q)
        kept = independent_rows(jac)
        chosen = better_rows(jac, kept) if 0 < len(kept) < len(jac) else None
        return jac, np.array(kept if chosen is None else chosen, np.int64)

    def _dynamics(self, limit: float) -> SpaceDynamics:
        packed, nb = self.packed, len(self.packed.bodies)
        inertia, weight, per_size = (np.zeros(7 * nb - 4) for _ in range(3))
        for b in range(1, nb):
            part = slice(6 * b - 3, 6 * b)
            inertia[part], inertia[6 * b : 6 * b + 3] = packed.system.mass[b], packed.system.inertia[b]
            weight[part] = packed.system.mass[b] * packed.system.gravity
            per_size[part], per_size[6 * b : 6 * b + 3] = 1.0 / packed.size, 1.0
        inverse = np.divide(1.0, inertia, out=np.zeros_like(inertia), where=inertia > 0.0)
        envelope, factors = envelope_of(packed.system.row_body, self.kept)
        none = Table(np.zeros((0, 2), np.int64), np.zeros((0, 2), np.int64))
        return SpaceDynamics(
            system=packed.system, laws=self.laws, loads=Switches(np.zeros((1, WIDTH))), schur=none, sliding=none,
            envelope=envelope, factors=factors, inertia=inertia, inverse=inverse, weight=weight, per_size=per_size,
            world=np.zeros(6 * nb - 3), pushed=np.zeros(len(packed.ws.phi)), limit=np.array([limit]), turns=self.turns,
            counted=self.counted,
        )  # fmt: skip

    def scratch(self) -> Scratch:
        """Return scratch for a run."""
        packed, entries = self.packed, len(self.q)
        factors: Any = ()
        return Scratch(
            ws=packed.ws, factors=factors, drive=np.zeros((len(packed.motions) + 1, 3)), force=np.zeros(entries),
            multipliers=np.zeros(len(packed.ws.phi)), change=np.zeros((2, packed.freedoms + 3)),
            state=np.zeros((2, entries)), stages=np.zeros((DOP853.stages, 2, entries)), power=np.zeros(DOP853.stages),
            dense=np.zeros((8, 2, entries)), dense_work=np.zeros(7), full=full_matrices(0, 0), report=np.zeros(4),
        )  # fmt: skip

    def dynamics(self) -> SpaceDynamics:
        """Return the arrays of the formulation, for which rows in use stay."""
        return self._dynamics(0.0)

    def begin(self) -> tuple[np.ndarray, np.ndarray]:
        """Return pose (3 + 7 n,) and velocities (3 + 6 n,) at the start, w in the world."""
        return self.q, self.v

    def _settings(self) -> Settings:
        packed = self.packed
        allowed = np.full((2, len(self.q)), self.tolerance)
        for b in range(1, len(packed.bodies)):
            allowed[0, 7 * b - 4 : 7 * b - 1] *= packed.size
            allowed[1, 6 * b - 3 : 6 * b] *= packed.size
        growing = np.full_like(allowed, self.tolerance)
        longest = float(self.grid[-1] - self.grid[0]) / (OUTPUTS_LONGEST if packed.motions or packed.forces else 1)
        return Settings(allowed, float(self.tolerance), growing, longest, SMALLEST_STEP * longest, longest, np.zeros(0))

    def followed(self) -> Solution:
        """Return the motion until the last output. Raises SimulationError where it cannot go on."""
        packed, end = self.packed, float(self.grid[-1])
        limit = OWN if self.mobility.redundant_rows else 0.0
        state = start_state(self.y, len(packed.ws.phi), float(self.grid[0]))
        out = output_for(self.grid, len(self.q), len(packed.ws.phi))
        scratch, settings, dyn = self.scratch(), self._settings(), self._dynamics(limit)
        watched, none = list(self.m.events.values()), np.zeros(0)
        span = end - float(self.grid[0])
        events = (
            Events(self.packed, watched, state, settings.longest, span, self.counted, self.event_rows)
            if watched
            else None
        )

        def advance(contacts: Any, most: int) -> int:
            return run_events(dyn, scratch, state, settings, contacts, out, end, most, none, none)

        while True:
            if events is None:
                status = DOP853.advance(dyn, scratch, state, out, settings, end, STEPS)
            else:  # rows are chosen between steps, never while one is tried
                choosing, dyn.limit[0] = dyn.limit[0], 0.0
                status = events.follow(advance, state, end, choosing > 0.0)
                dyn.limit[0] = choosing
                if status == CHOOSE and not scratch.report[0] < choosing:
                    continue
            packed.check_callbacks(status in (REACHED, OVER, CHOOSE))
            if status in (REACHED, OVER):
                break
            if status != CHOOSE:
                raise self._refusal(status, state)
            jac, best = self._rows(state.y[0])
            if better_rows(jac, self.kept) is None:
                limit *= 0.1
            else:
                self.kept, limit = best, OWN
            dyn = self._dynamics(limit)
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
        whole = output_for(np.zeros(0), 0, 0)._make(
            np.concatenate([one[:written], other])[order] for one, other in parts
        )
        self.grid = whole.t
        return whole

    def _refusal(self, status: int, state: Any) -> SimulationError:
        why = "its steps shrink to nothing" if status == STEP_TOO_SMALL else "its numbers are no longer finite"
        return SimulationError(
            f"{self.packed.name}: the simulation cannot go on at t = {float(state.clock[TIME]):.6g} s: {why}. The pose "
            "is singular there, or bodies lack inertia; look at the joints in this pose"
        )

    def _solution(self, out: Any, steps: int, happened: tuple[Happening, ...]) -> Solution:
        packed, count = self.packed, len(self.grid)
        q, body = np.ascontiguousarray(out.y[:, 0]), packed.freedoms + 3
        v, a = (_to_worlds(packed, q, part[:, :body]) for part in (out.y[:, 1], out.a))
        drives, none = packed.drives(self.grid), np.zeros(count)
        motion = DrivenMotion(
            times=self.grid, drives=drives, stride=none, q=q, dq=q, ddq=q, v=v, a=a, turn=self.turns,
            turn_rate=self.turns, residual=none, margin=out.margin, determinant=none[:, None], lam=out.lam,
            wrench=np.zeros((count, len(packed.passive_joints), 6)),
        )  # fmt: skip
        if self.mobility.redundant_rows:
            motion = motion._replace(lam=least_norm(packed, self.laws, motion))
        wrenches_along(packed.system, drives, q, packed.ws, motion.lam, motion.wrench)
        return Solution(
            self.m, packed, motion, np.ones(count, bool), self.mobility, self.laws, dict(self.m.starts),
            steps=steps, work=out.work, changes=self.changes, events=happened,
        )  # fmt: skip


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


def _rotations(packed: Packed, q: np.ndarray) -> np.ndarray:
    """Return (..., n, 3, 3) rotations from principal axes to the world."""
    return rotation_matrix(q[..., 3:].reshape(*q.shape[:-1], -1, 7)[..., 3:])


def _to_worlds(packed: Packed, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return v (T, 3 + 6 n) with rotations in the world instead of body axes."""
    out = np.ascontiguousarray(v)
    parts = out[:, 3:].reshape(len(out), -1, 6)
    parts[..., 3:] = np.einsum("tbij,tbj->tbi", _rotations(packed, q), parts[..., 3:])
    out[:, 3:] = parts.reshape(len(out), -1)
    return out


def _to_bodies(packed: Packed, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return v (3 + 6 n,) with rotations in body axes instead of the world."""
    out = v.copy()
    parts = out[3:].reshape(-1, 6)
    parts[:, 3:] = np.einsum("bji,bj->bi", _rotations(packed, q), parts[:, 3:])
    return out
