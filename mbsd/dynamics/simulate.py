"""Forward dynamics from start to end, as a Solution, which can be asked for other times.

A run is followed to its end, with or without events, and gone on with from the last point known before a time. A
solution that was pickled is simulated once more when it is asked for such a time.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

import mbsd.dynamics.integrators
from mbsd.arrays.chambers import check_pistons, phase_changes
from mbsd.arrays.curve_branches import tabulate_along
from mbsd.arrays.friction_along import friction_along
from mbsd.arrays.loads import loads_along
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import wrenches
from mbsd.arrays.states import states_of, without_states
from mbsd.base.arguments import users_progress
from mbsd.base.errors import InitialConditionWarning, ModelError, SimulationError
from mbsd.base.names import no_such
from mbsd.base.running import keeping_interrupts
from mbsd.base.warning import warn
from mbsd.dynamics.change_points import near_singular, with_efforts_beside
from mbsd.dynamics.events.driver import EventSteps
from mbsd.dynamics.integrators.kind import INTEGRATORS, Integrator
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.prepare.refusals import refuse_opened
from mbsd.dynamics.reference.multipliers import fill_multipliers, least_norm, multipliers_along
from mbsd.dynamics.runs.motion import to_end
from mbsd.dynamics.runs.run import AUTO, FORMULATIONS, INDEPENDENT, Recording, Request, Run, Snapshot, run_of
from mbsd.dynamics.runs.steps import step_to
from mbsd.dynamics.state import ACCEPTED, NEXT, TIME, WORK, Output, State
from mbsd.dynamics.switches import standing
from mbsd.equations.products import leave
from mbsd.kinematics.limits.cables import refuse_left_wheels
from mbsd.kinematics.limits.joints import refuse_passed
from mbsd.kinematics.multipliers import JACOBIAN_NUMBERS
from mbsd.model.event import Event
from mbsd.model.mechanism import Model
from mbsd.model.output_times import equal_times, rising_times
from mbsd.results.measured import check_states
from mbsd.results.rows import Asked, jumps_of
from mbsd.results.solution import Solution
from mbsd.results.views import Stats

Progress = Callable[[float], None] | None


def follow(run: Run, times: np.ndarray, events: list[Event], event_rows: bool, progress: Progress) -> Recording:
    """Simulate from the consistent start to the last of ``times`` (s)."""
    ready = run.ready
    with keeping_interrupts():
        state, out = ready.begun(times)
        ready.approaches.forget()
        if run.formulation == INDEPENDENT or not (events or ready.is_switched):
            begun = Snapshot(state.y.copy(), float(state.clock[TIME]), float(state.clock[WORK]))
            independent = to_end(run, state, out, progress)
            plain = _plain(ready, state, out)
            return replace(plain, snapshots=[begun], approaches=ready.approaches.copy(), independent=independent)
        met = EventSteps(ready, run, state, out, events, event_rows)
        met.begin()
        met.to(float(times[-1]), progress)
        return recording_of(met, event_rows)


def _plain(ready: PreparedDynamics, state: State, out: Output) -> Recording:
    """Return the recording of steps without events."""
    held = ready.switches.held()[None].repeat(len(out.t), axis=0)
    return Recording(out, held, int(state.count[ACCEPTED]))


def recording_of(met: EventSteps, event_rows: bool = False) -> Recording:
    """Return the recording of steps with events that have ended, with rows at events if asked for."""
    written = int(met.state.count[NEXT])
    out, held, pairs = Output(*(part[:written] for part in met.out)), met.held[:written], met.pairs[:written]
    rows = met.rows if event_rows else met.rows[-1:] if met.ended else []
    if rows:
        parts = [np.stack(column) for column in zip(*(row[:-2] for row in rows), strict=True)]
        both = [np.concatenate([a, b]) for a, b in zip(out, parts, strict=True)]
        order = np.argsort(both[0], kind="stable")
        out = Output(*(part[order] for part in both))
        held = np.concatenate([held, np.stack([row[-2] for row in rows])])[order]
        pairs = np.concatenate([pairs, np.stack([row[-1] for row in rows])])[order]
    return Recording(
        out, held, int(met.state.count[ACCEPTED]), met.happenings, met.snapshots, met.ready.approaches.copy(),
        pairs=pairs if pairs.shape[1] else None,
    )  # fmt: skip


def resumed(
    run: Run, recording: Recording, times: np.ndarray, events: list[Event], passes_singular: bool = False
) -> Recording:
    """Return the motion at other times (T,), rising and within the recording: each from the last point known before it.

    ``passes_singular``: take the steps that pass singular poses at once, where the run was in independent coordinates.
    """
    t, began = recording.out.t, np.array([snapshot.time for snapshot in recording.snapshots])
    which = np.maximum(np.searchsorted(began, times, side="right") - 1, 0)
    outputs = np.searchsorted(t, times, side="right") - 1
    outputs[(outputs >= 0) & (t[outputs] <= began[which])] = -1
    cuts = np.flatnonzero((np.diff(which) != 0) | (np.diff(outputs) != 0)) + 1
    at = [0, *cuts]
    pieces = [
        _gone_on(run, recording, recording.snapshots[s], k, part, events, passes_singular)
        for s, k, part in zip(which[at].tolist(), outputs[at].tolist(), np.split(times, cuts), strict=True)
    ]
    out = Output(*(np.concatenate(parts) for parts in zip(*(piece.out for piece in pieces), strict=True)))
    held = np.concatenate([piece.held for piece in pieces])
    pairs = [piece.pairs for piece in pieces if piece.pairs is not None]
    return Recording(
        out, held, sum(piece.steps for piece in pieces), approaches=recording.approaches,
        pairs=np.concatenate(pairs) if pairs else None,
    )  # fmt: skip


def _gone_on(
    run: Run, recording: Recording, snapshot: Snapshot, k: int, times: np.ndarray, events: list[Event],
    passes_singular: bool,
) -> Recording:  # fmt: skip
    """Return the motion at ``times`` (s) from output k of a recording on, or from a snapshot where k is negative."""
    ready, known = run.ready, recording.out

    def begun() -> tuple[State, Output]:
        state, out = ready.begun(times)
        state.clock[TIME], state.clock[WORK] = (snapshot.time, snapshot.work) if k < 0 else (known.t[k], known.work[k])
        state.y[...] = snapshot.y if k < 0 else known.y[k]
        return state, out

    state, out = begun()
    if recording.approaches is not None:
        recording.approaches.recall(float(state.clock[TIME]))
    if events or ready.is_switched:
        met = EventSteps(ready, run, state, out, events)
        met.resume(snapshot, float(state.clock[WORK]))
        met.to(float(times[-1]))
        return recording_of(met)
    if not (passes_singular and recording.independent):
        try:
            step_to(run, state, out, float(times[-1]))
            return _plain(ready, state, out)
        except SimulationError:  # near a singular pose, which independent coordinates pass
            state, out = begun()
    if to_end(run.passing, state, out):
        fill_multipliers(ready.packed, ready.dynamics, out.t, out.y, out.lam, out.margin)
    return _plain(ready, state, out)


class Between:
    """Called with rising times (T,), it gives the motion there."""

    def __init__(
        self, at: Callable[[np.ndarray], Solution] | None, anew: Callable[[], Solution], last: np.ndarray
    ) -> None:
        """``anew`` simulates it again, to the same pose ``last`` (3 nb,) at its end."""
        self.at, self.anew, self.last = at, anew, last

    def __call__(self, times: np.ndarray) -> Solution:
        """Raises ModelError where the mechanism was changed before it was pickled, and does not move so any more."""
        if self.at is None:
            again = self.anew()
            assert isinstance(again.between, Between)
            if not np.array_equal(again.between.last, self.last):
                raise ModelError(
                    f"{again.mechanism.name}: the mechanism was changed after this simulation, so its motion at other "
                    "times is lost; simulate again"
                )
            self.at = again.between.at
        assert self.at is not None
        return self.at(times)

    def __getstate__(self) -> dict[str, Any]:
        """Without the run, which holds compiled functions of this process."""
        return self.__dict__ | {"at": None}


def with_phase_changes(
    ready: PreparedDynamics, run: Run, recording: Recording, events: list[Event], grid: np.ndarray, asked: Asked | None
) -> tuple[Recording, Asked | None]:
    """The recording with rows beside each change of phase, and what was asked for with them.

    ``grid`` (T,): output times (s); ``asked``: what was, with those beside jumps at known times.
    """
    out = recording.out

    def motion(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        y = resumed(run, recording, times, events).out.y
        return y[:, 0], y[:, 1]

    changes = phase_changes(ready.packed, out.t, (out.y[:, 0], out.y[:, 1], out.a), motion)
    if not changes:
        return recording, asked
    known = ready.stops.jumps
    rows = [*zip(known.before.tolist(), known.after.tolist(), known.names, strict=True)]
    asked = jumps_of([*rows, *((a, b, (name,)) for a, b, name in changes)]).among(grid)
    new = asked.solved[~np.isin(asked.solved, out.t) & (asked.solved < out.t[-1])]
    kept = ~np.isin(out.t, np.setdiff1d(grid, asked.solved))
    more = resumed(run, recording, new, events)
    parts = zip(out, more.out, strict=True)
    both = [np.concatenate([first[kept], second]) for first, second in parts]
    held = np.concatenate([recording.held[kept], more.held])
    order, pairs = np.argsort(both[0], kind="stable"), None
    if recording.pairs is not None and more.pairs is not None:
        pairs = np.concatenate([recording.pairs[kept], more.pairs])[order]
    return replace(recording, out=Output(*(part[order] for part in both)), held=held[order], pairs=pairs), asked


PART = "the part done, 0 .. 1"
LEAST_TOLERANCE = 1e-16
MOST_STEPS = 1e12


def simulate(
    m: Model,
    duration: float | None,
    steps: int,
    times: Sequence[float] | np.ndarray | None,
    method: str,
    tolerance: float,
    step: float | None,
    progress: Callable[[float], None] | None,
    options: Mapping[str, float],
    event_rows: bool = False,
    formulation: str = AUTO,
    ready: PreparedDynamics | None = None,
) -> Solution:
    """See :meth:`mbsd.mechanism.Mechanism.simulate`; ``ready``: what an earlier run has prepared over the same span."""
    request = request_for(m, duration, steps, times, method, tolerance, step, formulation, options)
    return simulated(m, request, users_progress(f"{m.name}: progress", progress, PART), event_rows, ready)


def request_for(
    m: Model,
    duration: float | None,
    steps: int,
    times: Sequence[float] | np.ndarray | None,
    method: str,
    tolerance: float,
    step: float | None,
    formulation: str,
    options: Mapping[str, float],
) -> Request:
    """Return how a mechanism is simulated. Raises ModelError for what cannot be asked."""
    integrator = integrator_named(m.name, method)
    integrator.numbers(m.name, options)
    grid = output_times(m, duration, steps, times)
    refuse_bad_steps(m, grid, tolerance, step)
    refuse_formulation(m, formulation, integrator)
    return Request(grid, integrator, tolerance, step, formulation, options)


def simulated(
    m: Model,
    request: Request,
    progress: Progress = None,
    event_rows: bool = False,
    ready: PreparedDynamics | None = None,
) -> Solution:
    """Simulate as requested."""
    grid, events = request.times, list(m.events.values())
    ready = ready or prepare_dynamics(m, float(grid[0]), float(grid[-1]), contacts=True)
    warn_of_start(ready)
    run = run_of(m, request, ready)
    check_pistons(ready.packed, grid[:1], ready.initial.q[None], tell=False)
    asked = ready.stops.jumps.among(grid) if event_rows and ready.stops.jumps else None
    recording = follow(run, grid if asked is None else asked.solved, events, event_rows, progress)

    def solve_between(times: np.ndarray) -> Solution:
        try:
            sol = solution(m, ready, resumed(run, recording, times, events))
        except SimulationError:
            if clear.all():
                raise
            sol = solve_at(times)
        return with_efforts_beside(ready, sol, near_singular(sol), solve_at, span)

    def solve_at(times: np.ndarray) -> Solution:
        return solution(m, ready, resumed(run, recording.only(clear), times, events, True))

    refuse_impossible(ready.packed, recording.out.t, recording.out.y)
    if event_rows:
        recording, asked = with_phase_changes(ready, run, recording, events, grid, asked)
    method, tolerance, step = request.integrator.name, request.tolerance, request.step
    anew = partial(
        simulate, m, None, 1, grid, method, tolerance, step, None, request.options, event_rows, request.formulation
    )
    span = float(recording.out.t[0]), float(recording.out.t[-1])
    sol = solution(m, ready, recording, Between(solve_between, anew, recording.out.y[-1, 0]))
    is_near = near_singular(sol)
    clear = ~is_near
    sol = with_efforts_beside(ready, sol, is_near, solve_at, span)
    return sol if asked is None else asked.rows(sol)


def warn_of_start(ready: PreparedDynamics) -> None:
    """Say what had to change of the velocities that the start was given."""
    if ready.initial.velocities:
        warn(
            f"{ready.packed.name}: the start was made consistent: " + "; ".join(ready.initial.velocities),
            InitialConditionWarning,
        )


def refuse_impossible(packed: Packed, t: np.ndarray, y: np.ndarray) -> None:
    """Raise an error where y (T, 2, 3 nb) at t (T,) (s) passes limits of joints, cables, cylinders or states."""
    poses = np.ascontiguousarray(y[:, 0])
    refuse_passed(packed, t, poses)
    refuse_left_wheels(packed, t, poses)
    check_pistons(packed, t, poses)
    check_states(packed, t, poses, states_of(packed, y[:, 1]))


def refuse_bad_steps(m: Model, grid: np.ndarray, tolerance: float, step: float | None) -> None:
    """Raise ModelError for a tolerance or a step (s) with which nothing can be integrated over ``grid`` (T,) (s)."""
    if not LEAST_TOLERANCE <= tolerance <= 1.0:
        raise ModelError(
            f"{m.name}: tolerance is {tolerance:g}; it must be positive, within {LEAST_TOLERANCE:g} .. 1, and 1e-12 is "
            "near what rounding allows"
        )
    if step is not None and not (step > 0 and (grid[-1] - grid[0]) / step <= MOST_STEPS):
        raise ModelError(
            f"{m.name}: step is {step:g} s; it must be positive, and {grid[-1] - grid[0]:g} s may take {MOST_STEPS:g} "
            "steps at most"
        )


def refuse_formulation(m: Model, formulation: str, integrator: Integrator) -> None:
    """Raise ModelError for a formulation that there is not, or that this integrator does not have."""
    if formulation not in FORMULATIONS:
        raise ModelError(f"{m.name}: {no_such('formulation', formulation, FORMULATIONS)}")
    if formulation == INDEPENDENT and not integrator.independent:
        raise ModelError(
            f"{m.name}: formulation='independent' is not possible here: method '{integrator.name}' works in reference "
            "coordinates"
        )


def integrator_named(model: str, method: str) -> Integrator:
    """The integrator of this name; raises ModelError with the known names."""
    if method not in INTEGRATORS:
        for module in pkgutil.iter_modules(mbsd.dynamics.integrators.__path__):
            importlib.import_module(f"mbsd.dynamics.integrators.{module.name}")
    if method not in INTEGRATORS:
        raise ModelError(f"{model}: {no_such('integrator', method, sorted(INTEGRATORS))}")
    return INTEGRATORS[method]


def output_times(
    m: Model, duration: float | None, steps: int, times: Sequence[float] | np.ndarray | None
) -> np.ndarray:
    """(T,) rising output times (s). Raises ModelError for anything else."""
    if times is not None:
        return rising_times(m, times, 2)
    if duration is None:
        raise ModelError(f"{m.name}: say how long: simulate(duration=...) in seconds, or simulate(times=...)")
    return equal_times(m, duration, steps)


def solution(
    m: Model, ready: PreparedDynamics, recording: Recording, between: Callable[[np.ndarray], Solution] | None = None
) -> Solution:
    """The results by name, with reactions and residuals; ``between`` gives those at other times."""
    packed, out = ready.packed, recording.out
    count, rows = len(out.t), len(packed.ws.phi)
    drives, states = packed.drives(out.t), states_of(packed, out.y[:, 1]) if packed.states else None
    q, v = np.ascontiguousarray(out.y[:, 0]), np.ascontiguousarray(out.y[:, 1])
    approached = None if recording.approaches is None else recording.approaches.at(out.t)
    lam, wrench, residuals = np.zeros((count, rows)), np.zeros((count, len(packed.joints), 3)), np.zeros(4)
    placed = packed.holds_position()
    chunk = max(1, JACOBIAN_NUMBERS // max(1, 6 * rows))
    for start in range(0, count, chunk):
        at = slice(start, min(start + chunk, count))
        phi, bend, rate = np.zeros((3, at.stop - start, rows))
        compact = np.zeros((at.stop - start, rows, 6))
        held = recording.held[at]
        pairs = None if recording.pairs is None else recording.pairs[at]
        tabulate_along(packed, drives[at], q[at], v[at], phi, compact, bend, pairs)  # gamma; J a - gamma below
        if recording.independent:
            motion = out.t[at], q[at], v[at]
            out.lam[at], out.margin[at] = multipliers_along(
                packed, ready.dynamics, motion, compact, bend, None if approached is None else approached[at]
            )
        refuse_opened(ready, out.t[at], phi * held)
        lam[at] = least_norm(packed, compact, out.lam[at], held) if ready.shares_loads else out.lam[at]
        wrench[at] = wrenches(packed, compact, q[at], lam[at])
        loads = loads_along(
            packed, ready.dynamics.loads, ready.dynamics.laws, out.t[at], q[at], v[at],
            None if approached is None else approached[at],
        )  # fmt: skip
        _add_friction(loads, ready, q[at], v[at], compact, out.lam[at], held)
        leave(
            packed.system.row_body, packed.driver_rows, ready.dynamics.inertia, ready.dynamics.weight, drives[at],
            compact, v[at], out.a[at], lam[at], rate, bend, loads,
        )  # fmt: skip
        power = np.einsum("tc,tc->t", loads[:, 3:], v[at, 3:])
        all_hold = held.all() and placed.all()
        errors = [phi, rate, bend] if all_hold else [phi * (held & placed), rate * held, bend * held]
        residuals = np.maximum(residuals, [np.abs(error).max(initial=0.0) for error in (*errors, power)])
    shown = without_states(packed)
    end = 3 * len(shown.body_names)
    q, v, a = (part[:, :end].reshape(count, -1, 3) for part in (q, v, out.a))
    return Solution(
        mechanism=m,
        packed=shown,
        t=out.t,
        q=q,
        v=v,
        a=a,
        wrench=wrench,
        lam=lam,
        drives=drives,
        margin=np.sqrt(np.maximum(out.margin, 0.0)),
        stats=Stats(
            *(float(r) for r in residuals), steps=recording.steps, inserted_steps=0, independent=recording.independent
        ),
        mobility=ready.mobility,
        work=out.work,
        changes=ready.initial.poses + ready.initial.velocities,
        events=tuple(recording.happenings),
        held=recording.held,
        pairs=recording.pairs,
        span=(ready.start, ready.end),
        approached=approached,
        states=states,
        between=between,
    )


def _add_friction(
    out: np.ndarray,
    ready: PreparedDynamics,
    q: np.ndarray,
    v: np.ndarray,
    compact: np.ndarray,
    lam: np.ndarray,
    held: np.ndarray,
) -> None:
    """Add to out (T, 3 nb) that of the joints whose friction no multipliers hold, as long as they are not released."""
    for loads, at in standing(ready.dynamics.loads, held):
        out[at] += friction_along(ready.packed, loads, q[at], v[at], compact[at], lam[at])
