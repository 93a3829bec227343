"""A run in independent coordinates that changes them when others are better, and passes in reference coordinates
where none is clear."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from mbsd.embedding.embed import DOUBLED, GOOD, POOR, Embedded, begin_at, embed, scratch_for
from mbsd.embedding.equations import write
from mbsd.integrators import state as run_state
from mbsd.integrators.state import NEXT, STARTED, STEP, TIME, WORK

if TYPE_CHECKING:
    from mbsd.dynamics.run import Run

STEPS_AT_ONCE = 2000
"""Between two looks at the clock and the keyboard."""
PASSING = 6
"""Steps in reference coordinates before independent ones are tried again."""
BEYOND = 0.05
"""Part of the duration by which the last step may go beyond the end."""
HYSTERESIS = 0.7
"""A new choice must be better by this factor."""


class EmbeddedRun:
    """See the file."""

    def __init__(self, run: Run, made: Embedded, q: np.ndarray, v: np.ndarray, time: float) -> None:
        self.run, self.ready = run, run.ready
        self._take(made, q, v, time, max(DOUBLED * made.sensitivity, DOUBLED * GOOD))

    def _take(self, made: Embedded, q: np.ndarray, v: np.ndarray, time: float, limit: float) -> None:
        self.made, self.limit = made, limit
        self.arrays = made.copied()
        self.scratch = scratch_for(self.ready, made, self.run.method.stages, q)
        self.settings = made.settings(self.run.settings)
        self.state = run_state.start_state(made.state(q, v), 0, time)
        begin_at(self.arrays, self.scratch, self.state.y, time, limit)

    def in_one_go(
        self, state: run_state.State, out: run_state.Output, progress: Callable[[float], None] | None = None
    ) -> None:
        """Go on to the last output time, from the state with which this run began."""
        start, end = float(state.clock[TIME]), float(out.t[-1])
        own = self.state
        own.clock[...], own.count[...] = state.clock, state.count
        advance, target = self.run.method.advance, end
        while True:
            status = advance(self.arrays, self.scratch, own, out, self.settings, target, STEPS_AT_ONCE)
            own = self.state
            self.ready.packed.specials.check()
            if progress is not None:
                progress((own.clock[TIME] - start) / (end - start))
            if status == run_state.REACHED:
                state.y[...], state.clock[...], state.count[...] = out.y[-1], own.clock, own.count
                state.clock[TIME], state.clock[WORK], state.count[STARTED] = end, out.work[-1], 0
                return
            if status == run_state.PAUSED:
                continue
            if (
                status != run_state.CHOOSE
                and own.count[NEXT] == len(out.t) - 1
                and target < end + BEYOND * (end - start)
            ):
                # the end itself may be unclear: it is an output within a step that goes beyond it
                target = end + max(2.0 * (target - end), 1e-4 * (end - start))
                own.clock[STEP] = own.count[STARTED] = 0
                continue
            self._give(state)
            if status == run_state.CHOOSE and self._choose(state):
                pass
            elif not self._pass(state, out, end):
                return
            own = self.state

    def _give(self, state: run_state.State) -> None:
        """Write where the run stands into a state of reference coordinates."""
        here = run_state.output_for(self.state.clock[TIME : TIME + 1], state.y.shape[1], 0)
        trial = self.state.y.copy()
        write(self.arrays, self.scratch, float(here.t[0]), trial, self.scratch.stages[0], here, 0)
        state.y[...] = here.y[0]
        state.clock[...], state.count[...] = self.state.clock, self.state.count
        state.clock[STEP] = state.count[STARTED] = 0

    def _go_on(self, made: Embedded, state: run_state.State, limit: float) -> None:
        q, v, time = state.y[0], state.y[1], float(state.clock[TIME])
        self._take(made, q, v, time, limit)
        self.state.clock[...], self.state.count[...] = state.clock, state.count
        self.state.clock[STEP] = self.state.count[STARTED] = 0

    def _choose(self, state: run_state.State) -> bool:
        """Take better coordinates if there are any, else keep these until they are worse by far.

        Returns whether those it ends with are good enough.
        """
        now = float(self.scratch.watch[0])
        made = embed(self.ready, state.y[0], state.y[1], float(state.clock[TIME]))
        if made is not None and made.sensitivity < HYSTERESIS * now:
            self._go_on(made, state, max(DOUBLED * made.sensitivity, DOUBLED * GOOD))
            return True
        self.limit = self.scratch.watch[1] = min(DOUBLED * now, POOR)
        return now < POOR

    def _pass(self, state: run_state.State, out: run_state.Output, end: float) -> bool:
        """Take some steps in reference coordinates; returns whether the end is still ahead."""
        while True:
            if self.run.advance(state, out, end, PASSING) == run_state.REACHED:
                return False
            made = embed(self.ready, state.y[0], state.y[1], float(state.clock[TIME]))
            if made is not None:
                self._go_on(made, state, max(DOUBLED * made.sensitivity, DOUBLED * GOOD))
                return True
