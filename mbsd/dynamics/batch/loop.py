"""Rows of one kind through the compiled loop: window by window, and on to their end with the few outputs left over.

Rows end where all their measures are known, and what nobody reads is left out.

Where what decides is an angle or its rate, the loop itself compares every output with what it is to pass. All else is
looked at window by window. What a measure says of a window is what it says of all outputs up to its end, if
it knew nothing of those before: each window begins with the last output of the one before, as straight lines between
outputs do. Behind the last that needs all outputs a row goes on to its end with the few that the others read.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.compiling.jit import Often
from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.outputs import MotionsOf, Outputs, room_for
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.rows import KNOWN, UNDERWAY, WAITING, Course, Numbers, Target, run_rows
from mbsd.dynamics.batch.single_run import Base
from mbsd.dynamics.integrators.advance import number_of
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Motions, Quantity
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


MOST, LEAST = 10, 24
"""Windows, and outputs of a window: looking costs as much as some steps of a row."""
MOSTLY = 4
"""Where more than one part in so many of all rows is underway, all are looked at."""
MOST_PASSED = 32
"""Thresholds that the loop compares, a bit each."""
STEPS = 2
"""Steps between two looks at how far a row came."""


@dataclass(frozen=True)
class Passed:
    """A threshold of an angle or of an angular velocity."""

    body: str
    part: int
    """0: angle (rad), 1: angular velocity (rad/s)."""
    value: float
    below: bool


@dataclass(frozen=True)
class Plan:
    """Outputs of a row that are made."""

    windows: list[int]
    """Numbers of outputs at which rows are looked at, the last of them that of all; none where few are made at once."""
    few: np.ndarray | None = None
    """Rows of the output times that are made behind the windows, the first and the last among them; None: rows end."""
    passed: tuple[Passed, ...] = ()
    """Thresholds that decide all, if the loop can compare them itself: there are no windows then."""
    least: int = 0
    """Outputs that a row has at least, then."""


def all_outputs(times: int) -> Plan:
    """Return the plan that makes every output."""
    return Plan([times])


def plan_of(t: np.ndarray, measures: Mapping[str, Measure], quantities: Mapping[str, Quantity]) -> Plan:
    """Return the plan of output times t (T,) (s)."""
    every, times = list(measures.values()), len(t)
    if any(quantity.reactive for quantity in quantities.values()):
        return all_outputs(times)
    if not all(measure.ends or measure.reads_few for measure in every):
        return all_outputs(times)
    size = max(LEAST, math.ceil(times / MOST))
    windows = [*range(size, times, size), times]
    passed = _passed([measure for measure in every if not measure.reads_few], quantities)
    if all(measure.ends for measure in every):
        read = [measure.needed(t).max() for measure in every if measure.reads_few]
        return Plan([times], None, passed, 1 + max(read, default=-1)) if passed else Plan(windows)
    few = np.unique(np.concatenate([[0, times - 1], *(m.needed(t) for m in every if m.reads_few)]))
    alone = all(measure.reads_few for measure in every)
    return Plan([] if alone else [times] if passed else windows, few.astype(np.int64), passed)


def _passed(measures: Sequence[Measure], quantities: Mapping[str, Quantity]) -> tuple[Passed, ...]:
    """Return the thresholds of measures; nothing if they are too many, or the loop cannot compare one of them."""
    out = []
    for measure in measures:
        threshold, turn = measure.threshold, quantities[measure.quantity].turn
        if threshold is None or turn is None:
            return ()
        out.append(Passed(*turn, *threshold))
    return tuple(out) if len(out) <= MOST_PASSED else ()


class Known:
    """Tracks which measures of rows are final, window by window; ``few`` leaves out those that read few outputs."""

    def __init__(
        self, measures: Mapping[str, Measure], quantities: Mapping[str, Quantity], rows: int, few: bool = False
    ) -> None:
        self.measures = [measure for measure in measures.values() if not (few and measure.reads_few)]
        read = {measure.quantity for measure in self.measures}
        self.finds = {name: quantities[name].of_motions for name in quantities if name in read}
        self.known = np.zeros((len(self.measures), rows), bool)

    def look(self, rows: np.ndarray, t: np.ndarray, motions_of: Callable[[np.ndarray], Motions]) -> np.ndarray:
        """Return the ``rows`` with nothing left to measure; ``motions_of`` gives motions of some in a window (n, T)."""
        all_rows = np.arange(self.known.shape[1])
        seen = all_rows if MOSTLY * len(rows) > len(all_rows) else rows  # of all rows they are not copied
        motions = motions_of(seen)
        along = {name: find(motions) for name, find in self.finds.items() if find is not None}
        for known, measure in zip(self.known, self.measures, strict=True):
            there = measure.known(t, along)
            known[rows] |= there[rows] if seen is all_rows else there
        return rows[self.known[:, rows].all(axis=0)]


def window(out: Outputs, begin: int, end: int) -> Outputs:
    """Outputs ``begin`` to ``end`` (left out) of all rows."""
    y, a, lam, work, margin = (part[:, begin:end] for part in (out.y, out.a, out.lam, out.work, out.margin))
    return out._replace(t=out.t[begin:end], y=y, a=a, lam=lam, work=work, margin=margin)
