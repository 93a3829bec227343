"""Steps of a run in reference coordinates, and its pace: word of long runs, and an end to stuck ones.

A run is examined when it would take many more steps at its present pace. It ends where a force is found that jumps, or
one so stiff that the steps are far shorter than the motion needs, where the motion grows without bound (diagnosis.py),
and where the end is out of reach, as for steps that creep towards a time before it. Legitimate runs of many steps go
on, with word of where they are. What is decided depends on steps alone, never on the clock.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable

from mbsd.base.errors import SimulationError
from mbsd.base.running import end_if_unwanted
from mbsd.dynamics import state as run_state
from mbsd.dynamics.runs.diagnosis import Growth, Look, creeps_to, diagnosis, growth_of, refusal, runaway
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import ACCEPTED, REJECTED, TIME, State

LOG = logging.getLogger("mbsd")
CHECKED = 2000
"""Steps, the refused among them, between two looks at the pace."""
MANY = 2e5
"""Steps still to do at which a run is examined."""
PATIENCE = 10.0
"""s before the first word of a long run; the gaps double."""


class Pace:
    """Pace of one run from where ``state`` stands to ``end`` (s)."""

    def __init__(self, run: Run, state: State, end: float, progress: Callable[[float], None] | None) -> None:
        self.run, self.state, self.end, self.progress = run, state, end, progress
        self.start = self.last = float(state.clock[TIME])
        self._told = PATIENCE
        self._began = time.monotonic()
        self._done = self._steps()
        self._checks, self._next = 0, 1
        self._growth: Growth | None = None
        self._short = 0
        """Steps since they became short."""
        self._looks: list[Look] = []

    def note(self, current: Callable[[], State] | None = None, extra: int = 0) -> None:
        """After some steps: report progress, and look at the pace now and then.

        ``current`` gives the state in reference coordinates, if not that of the start of the run; ``extra`` counts work
        that is no step, as many steps as it is worth. Raises SimulationError if the run is stuck.
        """
        end_if_unwanted()
        at = float(self.state.clock[TIME])
        if self.progress is not None:
            if self.end > self.start:
                self.progress((at - self.start) / (self.end - self.start))
        elif time.monotonic() - self._began > self._told:
            self._tell(at)
        self._done -= extra
        steps = self._steps() - self._done
        if steps < CHECKED or at >= self.end:
            return
        advance = (at - self.last) / steps
        self.last, self._done = at, self._steps()
        left = (self.end - at) / advance if advance > 0.0 else float("inf")
        if self.run.method.fixed_step and not extra:
            return
        if left < MANY:
            self._checks, self._next, self._short, self._looks = 0, 1, 0, []
            return
        self._checks += 1
        self._short += steps
        if self._checks < self._next:
            return
        self._next *= 2
        state = current() if current else self.state
        before, self._growth = self._growth, growth_of(self.run, state)
        self._looks.append(Look(self._short, advance))
        ends = creeps_to(self._looks, at, self.end)
        cause = runaway(self.run, state, before, self._growth)
        cause = cause or diagnosis(self.run, state, advance, self._short, left, ends)
        if cause is not None:
            raise SimulationError(
                f"{self.run.ready.packed.name}: {self.run.method.name} no longer advances at t = {at:.6g} s: the last "
                f"{steps} steps took {advance * steps:.2g} s of {self.end - at:.3g} s that are left; {cause}"
            )

    def _steps(self) -> int:
        return int(self.state.count[ACCEPTED] + self.state.count[REJECTED])

    def _tell(self, at: float) -> None:
        waited = time.monotonic() - self._began
        self._told = 2.0 * waited
        LOG.warning(
            "mbsd: %s: t = %.4g of %.4g s after %.0f s and %d steps", self.run.ready.packed.name, at, self.end, waited,
            self._steps(),
        )  # fmt: skip


NO_LIMIT = 10**12
RECENT = 1e3
"""Steps before a run stops in which what a function of the user did may be why."""


def advance(run: Run, state: run_state.State, out: run_state.Output, end: float, steps: int = NO_LIMIT) -> int:
    """Go on to ``end`` (s), ``steps`` steps at most; returns REACHED or PAUSED, raises SimulationError."""
    status = run.advance(run.ready.dynamics, run.scratch, state, out, run.settings, end, steps)
    accepted = status in (run_state.REACHED, run_state.PAUSED)
    check_callbacks(run, state, accepted)
    if not accepted:
        raise refusal(run, status, state)
    return status


def check_callbacks(run: Run, state: run_state.State, accepted: bool) -> None:
    """Raise what functions of the user raised in steps up to ``state``, ``accepted`` or not."""
    specials = run.ready.packed.specials
    if run.method.fixed_step:
        specials.check()
    elif accepted:
        specials.check_trials()
    else:
        specials.check_trials(state.clock[run_state.TIME] - RECENT * state.clock[run_state.STEP])


def step_to(run: Run, state: run_state.State, out: run_state.Output, end: float) -> None:
    """Go on to ``end`` (s) a step at a time, with word of long runs. Raises SimulationError."""
    pace = Pace(run, state, end, None)
    while advance(run, state, out, end, 1) != run_state.REACHED:
        pace.note()
