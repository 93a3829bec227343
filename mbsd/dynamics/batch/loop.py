"""Rows of one kind through the compiled loop: window by window, and on to their end with the few outputs left over."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.compiling.jit import Often
from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.early import STEPS, Known, Plan, all_outputs, window
from mbsd.dynamics.batch.outputs import MotionsOf, Outputs, room_for
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.rows import KNOWN, UNDERWAY, WAITING, run_rows
from mbsd.dynamics.batch.single_run import Asked, Base
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Quantity
from mbsd.dynamics.state import NEXT, REACHED

Measures = Mapping[str, Measure] | Callable[[Any], Any]


@dataclass
class Work:
    """What all threads share."""

    designs: Designs
    asked: Asked
    measures: Measures
    quantities: Mapping[str, Quantity]
    why: str | None
    """Why none goes in the compiled loop, if so."""
    stop: np.ndarray
    """(1,) not zero where all is to stop."""
    plan: Plan
    """Which outputs are made; see early.py."""
    reactive: bool = False
    """Whether any measure reads reactions."""
    looked: bool = False
    """Whether it is known if rows must be prepared."""
    patches: Patches | None = None
    """Numbers of rows that need not be."""
    note: str | None = None
    """Why not, if so."""

    def unwanted(self) -> bool:
        """Whether all is to stop."""
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

    def __call__(
        self, fresh: np.ndarray, place: np.ndarray, value: np.ndarray, motions: MotionsOf
    ) -> tuple[Outputs, np.ndarray]:
        """Rows to their end, or as far as there is something to measure, and how many outputs of each were made.

        Where few outputs are read from the start, those alone are there.
        """
        numbers, plan, times = (fresh, place, value), self.plan, self.work.asked.times
        alone = plan.few is not None and not plan.windows
        out = self._outputs(max(len(fresh), len(value)), times[plan.few] if alone else times)
        count, whole = len(out.status), len(out.t)
        early, written = alone or bool(plan.passed) or len(plan.windows) > 1, np.full(count, whole)
        kept = np.zeros((count if early and not alone else 0, len(self.base.block) + 1))
        counts = np.zeros((len(kept), len(self.base.run.state.count)), np.int64)
        if alone:
            self._run(numbers, out, whole, kept, counts)
            return out, written
        measures = self.work.measures if isinstance(self.work.measures, Mapping) else {}
        if plan.passed:
            self._run(numbers, out, whole, kept, counts, self.passed)
            done = np.flatnonzero(out.status == KNOWN)
            out.status[done], written[done] = REACHED if plan.few is None else LATER, counts[done, NEXT]
            if plan.few is not None:
                self._go_on(numbers, out, plan.few, written, kept, counts)
            return out, written
        known = Known(measures, self.work.quantities, count, plan.few is not None)
        for begin, upto in zip([0, *plan.windows], plan.windows, strict=False):
            self._run(numbers, out, upto, kept, counts)
            underway = np.flatnonzero(out.status == UNDERWAY)
            if not len(underway):
                break
            seen = slice(max(begin - 1, 0), upto)
            looked = window(out, seen.start, upto)
            done = known.look(underway, times[seen], lambda rows, looked=looked: motions(looked, rows))
            out.status[done], written[done] = REACHED if plan.few is None else LATER, upto  # none behind are read
        if plan.few is not None:
            self._go_on(numbers, out, plan.few, written, kept, counts)
        return out, written

    def _outputs(self, count: int, times: np.ndarray) -> Outputs:
        """Room for outputs of rows that have not begun."""
        room = self.room
        if room is None or len(room.status) < count or room.shape != self._shape or room.y.shape[1] != len(times):
            room = self.room = room_for(count, times, *self._shape)
        out = Outputs(times, *(array[:count] for array in room.arrays))
        out.status[:] = WAITING
        out.over[:] = out.released[:] = np.inf
        return out

    def _run(
        self,
        numbers: tuple[np.ndarray, np.ndarray, np.ndarray],
        out: Outputs,
        upto: int,
        kept: np.ndarray,
        counts: np.ndarray,
        passed: np.ndarray = NOTHING,
    ) -> None:
        """Go on to so many outputs."""
        base, run, stops = self.base, self.base.run, self.base.run.ready.stops
        at_once = run.steps_at_once
        # where a jump is passed decides how far a run goes back: steps are counted as those of a single simulation
        if (upto < len(out.t) or len(passed)) and not len(run.genevas.body):
            at_once = min(at_once, STEPS)
        self._run_rows(
            *base.arguments, number_of(self.work.asked.integrator), base.block, *numbers, out.t, stops.before,
            stops.after, at_once, MOST_STEPS, run.near, self.work.stop, upto, passed, self.plan.least, kept,
            counts, *out.arrays,
        )  # fmt: skip

    def _go_on(
        self,
        numbers: tuple[np.ndarray, np.ndarray, np.ndarray],
        out: Outputs,
        few: np.ndarray,
        written: np.ndarray,
        kept: np.ndarray,
        counts: np.ndarray,
    ) -> None:
        """Rows that wait to their end, with these outputs (k,) alone of those that are not made yet."""
        later = np.flatnonzero(out.status == LATER)
        if not len(later):
            return
        rest = room_for(len(out.status), out.t[few], *self._shape)
        rest = replace(rest, status=out.status, steps=out.steps, over=out.over, released=out.released)
        made = counts[later, NEXT]  # the last step may have gone beyond the window
        counts[later, NEXT] = np.searchsorted(few, made)
        out.status[later] = UNDERWAY
        self._run(numbers, rest, len(few), kept, counts)
        rows, at = np.nonzero(few >= made[:, None])
        rows = later[rows]
        for whole, part in zip(out.arrays[:5], rest.arrays[:5], strict=True):
            if part.shape[1]:
                whole[rows, few[at]] = part[rows, at]
        written[later] = len(out.t)
