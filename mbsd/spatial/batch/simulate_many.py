"""Many simulations of a mechanism in space, in the compiled loop where numbers alone differ, else one by one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.arguments import described, users_progress
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.running import cores
from mbsd.base.warning import quiet
from mbsd.dynamics.batch.simulate_many import (
    NUMBERS_OF_A_BODY,
    WRONGLY_WRITTEN,
    Simulations,
    checked_measures,
    empty_columns,
    in_chunks,
    refuse_threads,
)
from mbsd.dynamics.batch.worker import LEFT, SMALL
from mbsd.dynamics.measures.columns import Done, columns_of, failed, joined
from mbsd.dynamics.simulate import PART
from mbsd.dynamics.state import CHOOSE, REACHED
from mbsd.spatial.batch.designs import Designs
from mbsd.spatial.batch.quantities import Quantity, quantity_named
from mbsd.spatial.batch.rows import Block, NotPatched, Patches
from mbsd.spatial.dynamics.simulate import Run

WHY = {**LEFT, CHOOSE: "other rows of joints became better on the way"}
BODIES = 3
"""A body in space has so many times the numbers of one in the plane."""


@dataclass
class Work:
    """The work that all threads share."""

    designs: Designs
    asked: Mapping[str, Any]
    """Arguments of a Run but the mechanism."""
    measures: Any
    quantities: Mapping[str, Quantity]
    times: np.ndarray
    """Output times (T,) (s) that measures read."""
    patches: Patches | None
    why: str | None
    """Why simulations are made one by one; None where they are not."""
    stop: np.ndarray

    def run(self, m: Any) -> Run:
        """Return a prepared simulation of all outputs."""
        return Run(m, **self.asked)


def simulations(
    designs: Designs, measure: Any, asked: Mapping[str, Any], threads: int | None,
    progress: Callable[[float], None] | None,
) -> Simulations:  # fmt: skip
    """Return measures; see :meth:`mbsd.spatial.mechanism.Mechanism.simulate_many`."""
    m, grid = designs.m, asked["grid"]
    refuse_threads(m.name, threads)
    progress = users_progress(f"{m.name}: progress", progress, PART)
    measures = checked_measures(m, measure, grid)
    every = [] if callable(measures) else list(measures.values())
    few = bool(every) and all(each.reads_few for each in every)
    read = [each.needed(grid) for each in every] if few else [np.arange(len(grid))]
    quantities = {name: quantity_named(m, name) for each in every for name in each.quantities}
    times = grid[np.unique(np.concatenate([[0, len(grid) - 1], *read]).astype(np.int64))]
    work = Work(designs, asked, measures, quantities, times, None, None, np.zeros(1, np.int64))
    with quiet():
        try:
            work.patches = _patches(work)
        except NotPatched as why:
            work.why = str(why)
        numbers = len(times) * BODIES * NUMBERS_OF_A_BODY * len(m.bodies)
        most = min(threads or cores(), designs.count)
        done = in_chunks(
            lambda: Worker(work), designs.count, numbers, most, work.why is None, work.stop, progress
        )  # fmt: skip
    table = done.columns if callable(measures) else empty_columns(measures, designs.count) | done.columns
    return Simulations(table, done.reasons, done.alone, None)


def _patches(work: Work) -> Patches:
    """Return how rows differ. Raises NotPatched where they must be made one by one."""
    if callable(work.measures):
        raise NotPatched("measure is a function of a solution")
    single = [name for name, quantity in work.quantities.items() if not quantity.many]
    if single:
        raise NotPatched(f"'{single[0]}' is that of a single solution")
    own = work.designs.copied()
    try:
        return Patches(work.designs, lambda numbers: work.run(work.designs.set_numbers(own, numbers)))
    except MechanismError as error:
        raise NotPatched(f"some cannot be prepared: {error}") from error


class Worker:
    """One thread's own block and mechanism."""

    def __init__(self, work: Work) -> None:
        self.work, self.own = work, work.designs.copied()
        self.block = None if work.patches is None else Block(work.patches, work.times)

    def __call__(self, rows: range) -> Done:
        """Simulate some rows."""
        if self.block is None:
            return joined([self._single(row, self.work.why) for row in rows])
        out = self.block(self.work.designs.numbers[rows.start : rows.stop], self.work.stop)
        good, columns = np.flatnonzero(out.status == REACHED), dict[str, np.ndarray]()
        parts = self._measured(rows, out, good) if len(good) else {}
        for name, values in parts.items():
            columns[name] = np.full((len(rows), *values.shape[1:]), np.nan)
            columns[name][good] = values
        reasons: list[str | None] = [None] * len(rows)
        alone = list(reasons)
        for k in np.flatnonzero(out.status != REACHED).tolist():
            single = self._single(rows[k], WHY.get(int(out.status[k]), SMALL))
            reasons[k], alone[k] = single.reasons[0], single.alone[0]
            for name, values in single.columns.items():
                columns.setdefault(name, np.full((len(rows), *values.shape[1:]), np.nan))[k] = values[0]
        return Done(columns, reasons, alone)

    def _measured(self, rows: range, out: Any, good: np.ndarray) -> dict[str, np.ndarray]:
        """Return columns of rows that came to their end, by one solution of all their motions (T, R, ...)."""
        assert self.work.patches is not None
        joints, starts = self.work.designs.m.joints, {}
        for column in self.work.designs.columns:
            if column.given == "start":
                values = column.values[rows.start : rows.stop][good]
                starts[column.name] = np.radians(values) if joints[column.name].kind.turns else values
        sol = self.work.patches.run.joined(self.work.times, out.y[good], out.a[good], starts)
        along = {name: quantity.of_solution(sol).T for name, quantity in self.work.quantities.items()}
        return columns_of(self.work.measures, self.work.times, along)

    def _single(self, row: int, why: str | None) -> Done:
        if self.work.stop[0]:
            return failed("stopped", why)
        designs, measures = self.work.designs, self.work.measures
        try:
            sol = self.work.run(designs.set_numbers(self.own, designs.numbers[row])).followed()
        except Exception as error:
            return failed(described(error), why)
        try:
            if callable(measures):
                columns = {name: np.asarray(number, float)[None] for name, number in measures(sol).items()}
            else:
                along = {name: quantity.of_solution(sol)[None] for name, quantity in self.work.quantities.items()}
                columns = columns_of(measures, sol.t, along)
        except Exception as error:
            if row == 0 and isinstance(error, WRONGLY_WRITTEN):
                raise ModelError(f"{designs.m.name}: measure fails for the first: {described(error)}") from error
            return failed(described(error), why)
        return Done(columns, [None], [why])
