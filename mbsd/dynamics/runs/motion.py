"""Runs in the coordinates that suit them: independent ones where there are some, else reference coordinates.

Independent coordinates change when others are better; reference ones help where none is clear. Where joints nearly
depend on each other the multipliers of reference coordinates grow without bound, and rounding with them: with the
inverse square of the distance from the pose in velocities, with its inverse cube in accelerations. A step that comes
near such a pose is taken back, and the mechanism goes in independent coordinates, which pass it smoothly
(independent/groups.py), until it is well beyond. Mechanisms without such coordinates pass as well as they can.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from mbsd.base.errors import ModelError, SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.genevas import genevas_of, run_indexed
from mbsd.dynamics.independent.arrays import LIMIT, SENSITIVITY
from mbsd.dynamics.independent.equations import write_alone
from mbsd.dynamics.integrators.kind import Integrator
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.reference.multipliers import fill_multipliers
from mbsd.dynamics.runs.embedding import (
    DOUBLED,
    GOOD,
    NO_PLAN,
    POOR,
    Embedded,
    begin_at,
    can_embed,
    embed,
    embedded_at_start,
    embedding_scratch,
)
from mbsd.dynamics.runs.run import AUTO, INDEPENDENT, REFERENCE, Run
from mbsd.dynamics.runs.steps import Pace, advance
from mbsd.dynamics.state import NEXT, PAUSED, REACHED, STARTED, STEP, TIME, WORK, Output, State, copied
from mbsd.kinematics.groups.groups import KIND
from mbsd.kinematics.groups.tables import BRANCH

PASSING = 6
"""Steps in reference coordinates before independent ones are tried again; doubled while they do not lead away."""
SHARE = 8
"""Steps so far, of one passage, for each one until the next trial, for a trial costs as much as a hundred steps."""
AWAY = 1e-2
"""Part of the longest step by which passing must advance before it counts as having led away."""
BEYOND = 0.05
"""Part of the duration by which the last step may go beyond the end."""
HYSTERESIS = 0.7
"""A new choice must be better by this factor."""


class IndependentSteps:
    """See the file. Clock and counters are those of the state in reference coordinates with which it begins."""

    def __init__(self, run: Run, made: Embedded, state: run_state.State) -> None:
        self.run, self.ready, self.whole = run, run.ready, state
        self._passing, self._passed = PASSING, -math.inf
        self._enter(made)

    def to_end(
        self, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
    ) -> None:
        """Go on to the last output time; ``state`` is the one with which these steps began."""
        start, end = float(state.clock[TIME]), float(out.t[-1])
        target = end
        pace = None if progress is None else Pace(self.run, state, end, progress)
        while True:
            status = self._advance(out, target, self.run.steps_at_once)
            self.ready.packed.specials.check_trials()
            if pace is not None:
                pace.note(self._in_reference_coordinates)
            if status == run_state.REACHED:
                state.y[...] = out.y[-1]
                state.clock[TIME], state.clock[WORK], state.count[STARTED] = end, out.work[-1], 0
                return
            pace = pace or Pace(self.run, state, end, progress)
            if status == run_state.PAUSED:
                continue
            last_output = state.count[NEXT] == len(out.t) - 1
            if status != run_state.CHOOSE and last_output and target < end + BEYOND * (end - start):
                # the end itself may be unclear: it is an output within a step that goes beyond it
                target = end + max(2.0 * (target - end), 1e-4 * (end - start))
                self._start_anew()
                continue
            self._write_whole()
            if not (status == run_state.CHOOSE and self._choose()) and not self._pass(out, end, pace):
                return

    def one_step(self, out: run_state.Output, end: float) -> int | None:
        """Take one step towards ``end`` (s) and write it into the whole state; PAUSED, REACHED, or None if it fails."""
        state = self.whole
        status = self._advance(out, end, 1)
        self.ready.packed.specials.check_trials()
        if status == run_state.REACHED:
            state.y[...] = out.y[-1]
            state.clock[TIME], state.clock[WORK], state.count[STARTED] = end, out.work[-1], 0
            return status
        if status not in (run_state.PAUSED, run_state.CHOOSE):
            return None
        step, started = float(state.clock[STEP]), int(state.count[STARTED])
        self._write_whole()
        if status == run_state.CHOOSE and not self._choose():
            return None
        if status == run_state.PAUSED:
            state.clock[STEP], state.count[STARTED] = step, started
        return run_state.PAUSED

    def _advance(self, out: run_state.Output, end: float, steps: int) -> int:
        """The integrator's own, from jump to jump where there are Genevas."""
        arrays = self.arrays, self.scratch, self.own, out, self.settings
        if self.genevas is not None:
            stops = self.ready.stops
            indexing = self.ready.loop((run_indexed.__name__, type(self.arrays)), run_indexed)
            return indexing(*arrays, self.genevas, end, steps, stops.before, stops.after)
        return self.run.advance(*arrays, end, steps)

    def leave(self) -> None:
        """Let the whole state be gone on from in reference coordinates."""
        self._start_anew()

    def _enter(self, made: Embedded) -> None:
        """Go on in these coordinates from the whole state."""
        (q, v), clock = self.whole.y, self.whole.clock
        self.arrays = made.copied(self.run.tolerance)
        self.scratch = embedding_scratch(self.ready, made, self.run.method.stages, q)
        self.settings = made.settings(self.run.settings)
        begun = run_state.start_state(made.state(q, v), 0, float(clock[TIME]))
        self.own = begun._replace(clock=clock, count=self.whole.count)
        limit = DOUBLED * max(made.sensitivity, GOOD)
        self.genevas = genevas_of(self.ready.packed, self.own, self.arrays, self.scratch)
        begin_at(self.arrays, self.scratch, self.own.y, float(clock[TIME]), limit)
        self._start_anew()

    def _start_anew(self) -> None:
        self.whole.clock[STEP] = self.whole.count[STARTED] = 0

    def _write_whole(self) -> None:
        """Write where the run stands into the whole state."""
        here = run_state.output_for(self.whole.clock[TIME : TIME + 1], self.whole.y.shape[1], 0)
        write_alone(self.arrays, self.scratch, float(here.t[0]), self.own.y.copy(), self.scratch.stages[0], here, 0)
        self.whole.y[...] = here.y[0]

    def _in_reference_coordinates(self) -> run_state.State:
        """The whole state now."""
        self._write_whole()
        return self.whole

    def _embedded(self) -> Embedded | None:
        return embed(self.ready, self.whole.y[0], self.whole.y[1], float(self.whole.clock[TIME]))

    def _choose(self) -> bool:
        """Take better coordinates if there are any, else keep these until they are worse by far.

        Returns whether those it ends with are good enough.
        """
        now, made = float(self.scratch.watch[SENSITIVITY]), self._embedded()
        if made is not None and made.sensitivity < HYSTERESIS * now:
            self._enter(made)
            return True
        self.scratch.watch[LIMIT] = min(DOUBLED * now, POOR)
        return now < POOR

    def _pass(self, out: run_state.Output, end: float, pace: Pace) -> bool:
        """Take some steps in reference coordinates; returns whether the end is still ahead.

        Raises SimulationError where they hardly advance.
        """
        self._start_anew()
        near = self.whole.clock[TIME] - self._passed < AWAY * self.settings.longest
        self._passing = min(2 * self._passing, self.run.steps_at_once) if near else PASSING
        steps = taken = self._passing
        while True:
            status = advance(self.run, self.whole, out, end, steps)
            self._passed = float(self.whole.clock[TIME])
            if status == run_state.REACHED:
                return False
            made = self._embedded()
            if made is not None:
                self._enter(made)
                return True
            pace.note()
            steps = min(max(self._passing, taken // SHARE), self.run.steps_at_once)
            taken += steps


NEAR = 0.05
"""Part of the largest margin so far below which a pose is near a singular one; it goes with the distance squared."""


def can_carry(run: Run) -> bool:
    """Return True if a run in reference coordinates may meet such poses and has independent ones to pass them."""
    ready = run.ready
    if not run.method.independent or can_embed(ready) is not None:
        return False
    made = embedded_at_start(ready)
    if made is None:
        return False
    return any(int(kind) in BRANCH for kind in made.arrays.group[:, KIND])


class CarriedSteps:
    """See the file; one step at a time."""

    def __init__(self, run: Run, state: State, out: Output, pace: Pace) -> None:
        self.run, self.state, self.out, self.pace = run, state, out, pace
        self.end = float(out.t[-1])
        self.widest = self._margin()
        self.carried = False

    def to_end(self) -> bool:
        """Go on to the last output time; returns whether outputs were written in independent coordinates."""
        vain = False
        while True:
            before, failure = copied(self.state), None
            try:
                status = advance(self.run, self.state, self.out, self.end, 1)
            except SimulationError as error:
                if vain:
                    raise
                failure, status = error, PAUSED
            self.pace.note()
            if status == REACHED:
                return self.carried
            near = failure is not None or self._near(float(self.run.scratch.report[0]))
            if not near:
                vain = False
            elif not vain:
                for target, source in zip(self.state, before, strict=True):
                    target[...] = source
                status = self._carry()
                if status == REACHED:
                    return True
                vain = status != PAUSED
                if vain and failure is not None:
                    raise failure
                if vain:
                    for target, source in zip(self.state, before, strict=True):
                        target[...] = source

    def _near(self, margin: float) -> bool:
        self.widest = max(self.widest, margin)
        return not margin > NEAR * self.widest

    def _margin(self) -> float:
        state, ready = self.state, self.run.ready
        derivative(
            ready.dynamics, self.run.scratch, float(state.clock[TIME]), state.y, np.zeros_like(state.y),
            np.zeros_like(state.lam),
        )  # fmt: skip
        return float(self.run.scratch.report[0])

    def _carry(self) -> int | None:
        """Go on in independent coordinates until the pose is clear; returns PAUSED or REACHED, None if that fails."""
        state = self.state
        made = embed(self.run.ready, state.y[0], state.y[1], float(state.clock[TIME]))
        if made is None:
            return None
        independent = IndependentSteps(self.run, made, state)
        moved = False
        while True:
            status = independent.one_step(self.out, self.end)
            self.pace.note()
            if status is None or status == REACHED:
                self.carried = self.carried or status == REACHED or moved
                return status
            moved = self.carried = True
            if not self._near(self._margin()):
                independent.leave()
                return PAUSED


def to_end(
    run: Run, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
) -> bool:
    """Go on to the last output time, from a start or restart; returns whether in independent coordinates.

    Then multipliers and margins are still to be found (reference/multipliers.py). Raises SimulationError, and
    ModelError if independent coordinates are asked for and impossible.
    """
    independent = independent_steps(run, state)
    if independent is None:
        in_reference(run, state, out, progress)
        return False
    independent.to_end(state, out, progress)
    return True


def independent_steps(run: Run, state: run_state.State) -> IndependentSteps | None:
    """Steps in independent coordinates from this state on, or None where the run stays in reference coordinates.

    Raises ModelError if independent coordinates are asked for and impossible.
    """
    if run.formulation == REFERENCE or (run.formulation == AUTO and run.ready.masses_apart):
        return None  # independent coordinates solve once, and lose the digits of the light bodies
    why, made = _choice(run, state)
    if made is not None and (made.pays or run.formulation == INDEPENDENT):
        return IndependentSteps(run, made, state)
    if run.formulation == INDEPENDENT:
        raise ModelError(f"{run.ready.packed.name}: formulation='independent' is not possible here: {why}")
    return None


def _choice(run: Run, state: run_state.State) -> tuple[str | None, Embedded | None]:
    if not run.method.independent:
        return f"method '{run.method.name}' works in reference coordinates", None
    why = can_embed(run.ready)
    if why is not None:
        return why, None
    if np.array_equal(state.y[0], run.ready.initial.q) and np.array_equal(state.y[1], run.ready.initial.v):
        return NO_PLAN, embedded_at_start(run.ready)
    return NO_PLAN, embed(run.ready, state.y[0], state.y[1], float(state.clock[run_state.TIME]))


def in_reference(
    run: Run, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
) -> None:
    """Go on to the last output time in reference coordinates; where these are asked for, independent ones carry them
    across singular poses."""
    end = float(out.t[-1])
    if run.formulation == REFERENCE and can_carry(run):
        if CarriedSteps(run, state, out, Pace(run, state, end, progress)).to_end():
            fill_multipliers(run.ready.packed, run.ready.dynamics, out.t, out.y, out.lam, out.margin)
        return
    pace = None if progress is None else Pace(run, state, end, progress)
    while advance(run, state, out, end, run.steps_at_once) != run_state.REACHED:
        pace = pace or Pace(run, state, end, progress)
        pace.note()
    if pace is not None:
        pace.note()


def integrate(
    ready: PreparedDynamics,
    method: Integrator,
    times: np.ndarray,
    tolerance: float,
    step: float,
    progress: Callable[[float], None] | None = None,
    options: Mapping[str, float] | None = None,
    formulation: str = AUTO,
) -> tuple[run_state.State, run_state.Output]:
    """Integrate to the last of ``times`` (s), which begin with the start; no events. Raises SimulationError.

    Multipliers are found in reference coordinates alone.
    """
    state, out = ready.begun(times)
    run = Run(ready, method, tolerance, step, float(times[-1] - times[0]), options or {}, formulation)
    to_end(run, state, out, progress)
    missing = len(times) - int(state.count[run_state.NEXT])
    if missing:
        raise SimulationError(
            f"{ready.packed.name}: the last {missing} of {len(times)} outputs were not reached, which is a fault of "
            "mbsd, not of the model; formulation='reference' goes another way"
        )
    return state, out
