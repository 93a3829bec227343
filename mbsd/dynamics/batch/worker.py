"""The work of one thread: simulations in chunks, each in the compiled loop or by ``simulate``, and their measures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.arguments import described
from mbsd.base.errors import MechanismError
from mbsd.base.running import stops_when
from mbsd.dynamics.batch.block import content
from mbsd.dynamics.batch.designs import Built
from mbsd.dynamics.batch.loop import MOST_STEPS, Loop, Work
from mbsd.dynamics.batch.outputs import MotionsOf, Outputs, Reactions
from mbsd.dynamics.batch.patches import NotPatched, Patches, agrees
from mbsd.dynamics.batch.rows import NEARLY_SINGULAR, STOPPED, Numbers
from mbsd.dynamics.batch.single_run import Base, NotCompiled, SingleRun, has_cylinders, single_run
from mbsd.dynamics.events.loop import NOT_SOLVED
from mbsd.dynamics.measures.columns import Done, columns_of, failed, joined, numbers_of
from mbsd.dynamics.measures.quantities import Motions
from mbsd.dynamics.simulate import refuse_impossible, simulated
from mbsd.dynamics.state import CHOOSE, NO_CONVERGENCE, NOT_FINITE, PAUSED, REACHED, UNCLEAR

TRIED = 64
"""Rows of which the first that can be prepared is what others go by."""
COMPARED = 6
"""Rows that are prepared for comparison, beside those with the least and the largest of each number."""
GRAMS_AT_ONCE = 1_000_000
"""Products of rows of J, where joints repeat others, that prepared rows hold together: a third of 24 MB."""
NEAR = 1e-9
"""Part of the size, and rad, by which a start may differ from what it is."""
OTHER, FAILED, NO_ROOM, NO_START = -2, -4, -10, -11
"""Status of rows that the loop is not made for, of those beside which a function of the user failed, of those whose
gas or oil cannot be as it was found, and of those that cannot start as is given."""
LEFT = {
    OTHER: "its start is that of another branch",
    NO_START: "its start cannot be all that is given",
    NO_ROOM: "its gas or oil has no room or pressure somewhere",
    FAILED: "a function of the user failed in one of them",
    NOT_SOLVED: "what happened at an event there is decided by single simulations",
    NEARLY_SINGULAR: "it came near a singular pose",
    CHOOSE: "other coordinates became better on the way",
    UNCLEAR: "an output fell on a pose that coordinates do not tell clearly",
    NOT_FINITE: "its numbers were no longer finite",
    NO_CONVERGENCE: "the equations of a step had no solution",
    PAUSED: f"it takes more than {MOST_STEPS} steps",
}
"""Why a row left the loop, by its status."""
STOP, SMALL = "stopped", "its steps became too small"


class Worker:
    """One thread's own mechanism and block."""

    def __init__(self, work: Work) -> None:
        self.work, self.designs = work, work.designs
        self.models = work.designs.row_by_row()
        self.base: Base | None = None
        self.patches: Patches | None = None
        self.loop: Loop | None = None
        self.reactions: Reactions | None = None

    def __call__(self, rows: range) -> Done:
        """Simulate some rows."""
        if self.work.why is not None:
            return joined([self._single(row, self.work.why) for row in rows])
        return self._compiled(rows)

    # -- in the compiled loop ------------------------------------------------------------------------------------

    def _compiled(self, rows: range) -> Done:
        if not self.work.looked:
            self.work.patches, self.work.looked = self._patches(), True
        if self.work.patches is None:
            return self._prepared(rows)
        if self.patches is None:
            self.base = self._first_base()
            assert self.base is not None
            self.patches = self.work.patches.of_thread(self.base)
        return self._patched(rows)

    def _first_base(self) -> Base | None:
        """The first row that can be prepared."""
        for row in range(min(self.designs.count, TRIED)):
            try:
                return Base(self._run_of(row))
            except Exception:
                continue
        return None

    def _run_of(self, row: int) -> SingleRun:
        return single_run(self.models(row), self.work.asked, self.work.reactive)

    def _patches(self) -> Patches | None:
        """Numbers of rows that need not be prepared, if none need; some are prepared for comparison."""
        if isinstance(self.designs, Built):
            self.work.note = f"each is prepared anew: {self.designs.why}"
            return None
        base, count = self._first_base(), self.designs.count
        if base is None:
            return None
        if self.designs.starts and base.run.counts_turns:
            self.work.note = "each is prepared anew: limits of angles are counted from the turn of its start"
            return None
        try:
            patches = Patches(self.designs, base)
        except NotPatched as why:
            self.work.note = f"each is prepared anew: {why}"
            return None
        even = np.linspace(0, count - 1, COMPARED, dtype=int).tolist()
        for row in sorted({0, count - 1, *even, *self.designs.extremes()}):
            try:
                run = self._run_of(row)
            except Exception:
                continue
            same = run.kind == base.run.kind
            if not same or not agrees(patches, row, base.fresh[0], partial(content, run.parts)):
                self.work.note = "each is prepared anew: more than what varies depends on it"
                return None
        return patches

    def _patched(self, rows: range) -> Done:
        """Rows by their numbers alone."""
        assert self.base is not None
        assert self.patches is not None
        value, q, reasons = self.patches(rows)
        mass = None if self.patches.mass is None else self.patches.mass[rows.start : rows.stop]
        inertia = None if self.patches.inertia is None else self.patches.inertia[rows.start : rows.stop]
        runs, times = [self.base.run], self.work.asked.times
        motions = MotionsOf(runs, mass, inertia)
        out = self._run(self.base.with_values(self.patches.place, value), motions, runs)
        if q is not None:  # closed forms may stand on another branch than the start does
            odd = np.abs(out.y[:, 0, 0] - q).max(axis=1) > NEAR * self.base.run.ready.packed.size
            out.status[odd] = OTHER
        out.status[[reason is not None for reason in reasons]] = NO_START
        reacting = self._reactions(self.patches).of_rows(rows, out, times) if self.work.reactive else None
        return self._measured(rows, lambda which: motions(out, which, reacting), out)

    def _prepared(self, rows: range) -> Done:
        """Rows whose arrays are those that a single simulation prepares; those of one kind at once."""
        alike: dict[Any, dict[int, SingleRun]] = {}
        done: dict[int, Done] = {}
        for row in rows:
            if self.work.unwanted():
                done[row] = failed(STOP)
                continue
            try:
                run = self._run_of(row)
                same = alike.setdefault(run.kind, {})
                same[row] = run
                if len(same) * run.contacts.repeated.gram.size > GRAMS_AT_ONCE:
                    done |= self._of_kind(run.kind, alike.pop(run.kind))
            except NotCompiled as why:
                done[row] = self._single(row, str(why))
            except Exception as error:
                done[row] = failed(described(error))
        for kind, runs in alike.items():
            done |= self._of_kind(kind, runs)
        return joined([done[row] for row in rows])

    def _of_kind(self, kind: tuple[Any, ...], runs: Mapping[int, SingleRun]) -> dict[int, Done]:
        """Rows that share a block, by their numbers."""
        if self.base is None or self.base.run.kind != kind:
            self.base, self.reactions = Base(next(iter(runs.values()))), None
        own, times = list(runs.values()), self.work.asked.times
        motions = MotionsOf(own, None, None)
        out = self._run(self.base.alike(own), motions, own)
        reacting = self._reactions(None).of_runs(own, out, times) if self.work.reactive else None
        together = self._measured(list(runs), lambda which: motions(out, which, reacting), out)
        return {row: together.row(k) for k, row in enumerate(runs)}

    def _reactions(self, patches: Patches | None) -> Reactions:
        if self.reactions is None:
            assert self.base is not None
            wanted = sorted({q.joint for q in self.work.quantities.values() if q.joint is not None})
            self.reactions = Reactions(self.base.run, patches, np.array(wanted, np.int64))
        return self.reactions

    def _run(self, numbers: Numbers, motions: MotionsOf, runs: Sequence[SingleRun]) -> Outputs:
        """Rows to their end, or as far as there is something to measure; they are those of ``runs``, or like it."""
        assert self.base is not None
        if self.loop is None or self.loop.base is not self.base:
            self.loop = Loop(self.base, self.work, None if self.loop is None else self.loop.room)
        run, packed = self.base.run, self.base.run.ready.packed
        run.forget_failures()
        out, written = self.loop(numbers, motions)
        if run.failed:  # in some row, or in a trial step that was not taken: single simulations can tell
            out.status[out.status == REACHED] = FAILED
            run.forget_failures()
        if has_cylinders(packed):
            for k in np.flatnonzero(out.status == REACHED).tolist():
                own, end = runs[min(k, len(runs) - 1)].ready.packed, written[k]
                if not is_possible(own, np.minimum(out.t[:end], out.over[k]), out.y[k, :end]):
                    out.status[k] = NO_ROOM
        return out

    def _measured(self, rows: Sequence[int], motions: Callable[[np.ndarray], Motions], out: Outputs) -> Done:
        """Measure rows that came to their end, and give the others to ``simulate``."""
        count, good = len(rows), np.flatnonzero(out.status == REACHED)
        reasons: list[str | None] = [None] * count
        alone: list[str | None] = [None] * count
        columns: dict[str, np.ndarray] = {}

        def write_part(part: dict[str, np.ndarray], at: Any) -> None:
            for name, values in part.items():
                if name not in columns:
                    columns[name] = np.full((count, *values.shape[1:]), np.nan)
                columns[name][at] = values

        if len(good):
            write_part(self._columns(motions(good)), good)
        for k in np.flatnonzero(out.status != REACHED).tolist():
            status = int(out.status[k])
            done = failed(STOP) if status == STOPPED else self._single(rows[k], LEFT.get(status, SMALL))
            write_part(done.columns, [k])
            reasons[k], alone[k] = done.reasons[0], done.alone[0]
        return Done(columns, reasons, alone)

    def _columns(self, motions: Motions) -> dict[str, np.ndarray]:
        assert isinstance(self.work.measures, Mapping)
        along = {}
        for name, quantity in self.work.quantities.items():
            assert quantity.of_motions is not None
            along[name] = quantity.of_motions(motions)
        return columns_of(self.work.measures, motions.t, along)

    # -- by simulate ---------------------------------------------------------------------------------------------

    def _single(self, row: int, why: str) -> Done:
        if self.work.unwanted():
            return failed(STOP, why)
        try:
            with stops_when(self.work.unwanted):
                columns = self._simulated(row)
        except Exception as error:
            return failed(described(error), why)
        return Done(columns, [None], [why])

    def _simulated(self, row: int) -> dict[str, np.ndarray]:
        measures = self.work.measures
        sol = simulated(self.models(row), self.work.asked)
        if not isinstance(measures, Mapping):
            return {name: np.array([value]) for name, value in numbers_of(sol.mechanism.name, measures(sol)).items()}
        along = {name: quantity.of_solution(sol)[None] for name, quantity in self.work.quantities.items()}
        return columns_of(measures, sol.t, along)


def is_possible(packed: Packed, t: np.ndarray, y: np.ndarray) -> bool:
    """Return True if ``simulate`` takes y (T, 2, 3 nb) at times (T,) (s): cylinders have room and pressure."""
    try:
        refuse_impossible(packed, t, y)
    except MechanismError:
        return False
    return True
