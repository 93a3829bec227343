"""Rows of one kind through the compiled loop: window by window, and on to their end with the few outputs left over."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.compiling.jit import Often
from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.early import STEPS, Known, Plan, all_outputs, window
from mbsd.dynamics.batch.outputs import MotionsOf, Outputs, room_for
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.rows import KNOWN, UNDERWAY, WAITING, Course, Numbers, Target, run_rows
from mbsd.dynamics.batch.single_run import Base
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Quantity
from mbsd.dynamics.runs.run import Request
from mbsd.dynamics.state import NEXT, REACHED

Measures = Mapping[str, Measure] | Callable[[Any], Any]


@dataclass
class Work:
    """The work that all threads share."""

    designs: Designs
    asked: Request
    measures: Measures
    quantities: Mapping[str, Quantity]
    why: str | None
    """Why none goes in the compiled loop, if so."""
    stop: np.ndarray
    """(1,) not zero where all is to stop."""
    plan: Plan
    """Outputs that are made; see early.py."""
    reactive: bool = False
    """True if any measure reads reactions."""
    looked: bool = False
    """True once it is known if rows must be prepared."""
    patches: Patches | None = None
    """Numbers of rows that need not be."""
    note: str | None = None
    """Why not, if so."""

    def unwanted(self) -> bool:
        """Return True if all is to stop."""
        return bool(self.stop[0])


MOST_STEPS = 200_000
"""Steps after which a simulation is left to ``simulate``, which knows what to say of it."""
NOTHING = np.zeros((0, 4))
"""No threshold."""
LATER = -7
"""Status of rows that wait to be gone on with when the windows have passed."""


class Loop:
    """Called with numbers of rows that share a base, it simulates them in this thread."""

    def __init__(self, base: Base, work: Work, room: Outputs | None = None) -> None:
        """``room``: outputs of another loop, which are used again where they fit."""
        self.base, self.work, self.room = base, work, room
        self._run_rows = Often(run_rows)
        run, times = base.run, work.asked.times
        thin = work.plan.few is not None and run.outputs_alone
        self.plan = work.plan if thin or work.plan.few is None else all_outputs(len(times))
        self.passed = np.array(
            [
                (
                    threshold.part,
                    3 * run.ready.packed.body_names.index(threshold.body) + 2,
                    threshold.value,
                    threshold.below,
                )
                for threshold in self.plan.passed
            ]
        ).reshape(-1, 4)
        forces = run.outputs_count or any(quantity.forces for quantity in work.quantities.values())
        self._shape = len(run.ready.initial.q), len(run.ready.packed.ws.phi), forces, len(run.events)

    def __call__(self, numbers: Numbers, motions: MotionsOf) -> tuple[Outputs, np.ndarray]:
        """Rows to their end, or as far as there is something to measure, and how many outputs of each were made.

        Where few outputs are read from the start, those alone are there.
        """
        plan, times = self.plan, self.work.asked.times
        alone = plan.few is not None and not plan.windows
        out = self._outputs(max(len(numbers.fresh), len(numbers.value)), times[plan.few] if alone else times)
        count, whole = len(out.status), len(out.t)
        waiting = count if plan.passed or len(plan.windows) > 1 else 0
        kept = np.zeros((waiting, len(self.base.block) + 1))
        counts = np.zeros((waiting, len(self.base.run.state.count)), np.int64)
        target, written = Target(whole, self.passed, plan.least, kept, counts), np.full(count, whole)
        ended = REACHED if plan.few is None else LATER
        if alone or plan.passed:
            self._run(numbers, out, target)
            known = np.flatnonzero(out.status == KNOWN)
            out.status[known], written[known] = ended, counts[known, NEXT]
        else:
            self._look_at_windows(numbers, out, target, motions, written)
        if plan.few is not None and not alone:
            self._go_on(numbers, out, plan.few, written, target)
        return out, written

    def _look_at_windows(
        self, numbers: Numbers, out: Outputs, target: Target, motions: MotionsOf, written: np.ndarray
    ) -> None:
        """Go on window by window, and end rows of which all measures are known."""
        plan, t = self.plan, self.work.asked.times
        measures = self.work.measures if isinstance(self.work.measures, Mapping) else {}
        known = Known(measures, self.work.quantities, len(out.status), plan.few is not None)
        for begin, upto in zip([0, *plan.windows], plan.windows, strict=False):
            self._run(numbers, out, target._replace(upto=upto))
            underway = np.flatnonzero(out.status == UNDERWAY)
            if not len(underway):
                break
            seen = slice(max(begin - 1, 0), upto)
            looked = window(out, seen.start, upto)
            ended = known.look(underway, t[seen], lambda rows, looked=looked: motions(looked, rows))
            out.status[ended], written[ended] = REACHED if plan.few is None else LATER, upto  # none behind are read

    def _outputs(self, count: int, times: np.ndarray) -> Outputs:
        """Room for outputs of rows that have not begun."""
        room = self.room
        if room is None or len(room.status) < count or room.shape != self._shape or room.y.shape[1] != len(times):
            room = self.room = room_for(count, times, *self._shape)
        out = Outputs(times, *(array[:count] for array in room[1:]))
        out.status[:] = WAITING
        out.over[:] = out.released[:] = np.inf
        return out

    def _run(self, numbers: Numbers, out: Outputs, target: Target) -> None:
        """Go on to the target."""
        base, run, stops = self.base, self.base.run, self.base.run.ready.stops
        at_once = run.steps_at_once
        # where a jump is passed decides how far a run goes back: steps are counted as those of a single simulation
        if (target.upto < len(out.t) or len(target.passed)) and not len(run.genevas.body):
            at_once = min(at_once, STEPS)
        course = Course(
            number_of(self.work.asked.integrator) or 0, stops.before, stops.after, at_once, MOST_STEPS, run.near,
            self.work.stop,
        )  # fmt: skip
        self._run_rows(*base.parts, numbers, course, target, out)

    def _go_on(self, numbers: Numbers, out: Outputs, few: np.ndarray, written: np.ndarray, target: Target) -> None:
        """Simulate rows that wait to their end, with these outputs (k,) alone of those that are not made yet."""
        later, counts = np.flatnonzero(out.status == LATER), target.counts
        if not len(later):
            return
        rest = room_for(len(out.status), out.t[few], *self._shape)
        rest = rest._replace(status=out.status, steps=out.steps, over=out.over, released=out.released)
        following = counts[later, NEXT]  # the last step may have gone beyond the window
        counts[later, NEXT] = np.searchsorted(few, following)
        out.status[later] = UNDERWAY
        self._run(numbers, rest, target._replace(upto=len(few), passed=NOTHING))
        rows, at = np.nonzero(few >= following[:, None])
        rows = later[rows]
        for whole, part in zip(out[1:6], rest[1:6], strict=True):
            if part.shape[1]:
                whole[rows, few[at]] = part[rows, at]
        written[later] = len(out.t)
