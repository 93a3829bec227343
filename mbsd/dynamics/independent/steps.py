"""Steps in independent coordinates, which change when others are better; reference ones help where none is clear."""

from __future__ import annotations

import math
from collections.abc import Callable

from mbsd.compiling.jit import Often
from mbsd.dynamics import state as run_state
from mbsd.dynamics.genevas.packing import genevas_of
from mbsd.dynamics.genevas.steps import run_indexed
from mbsd.dynamics.independent.arrays import LIMIT, SENSITIVITY
from mbsd.dynamics.independent.embedding import DOUBLED, GOOD, POOR, Embedded, begin_at, embed, embedding_scratch
from mbsd.dynamics.independent.equations import write_alone
from mbsd.dynamics.runs.pace import Pace
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.runs.steps import advance
from mbsd.dynamics.state import NEXT, STARTED, STEP, TIME, WORK

PASSING = 6
"""Steps in reference coordinates before independent ones are tried again; doubled while they do not lead away."""
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
        self._take(made)

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
            run = self.ready.advancing.setdefault((run_indexed.__name__, type(self.arrays)), Often(run_indexed))
            return run(*arrays, self.genevas, end, steps, stops.before, stops.after)
        return self.ready.advance(self.run.method, *arrays, end, steps)

    def leave(self) -> None:
        """Let the whole state be gone on from in reference coordinates."""
        self._start_anew()

    def _take(self, made: Embedded) -> None:
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
            self._take(made)
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
        while True:
            status = advance(self.run, self.whole, out, end, self._passing)
            self._passed = float(self.whole.clock[TIME])
            if status == run_state.REACHED:
                return False
            made = self._embedded()
            if made is not None:
                self._take(made)
                return True
            pace.note()
