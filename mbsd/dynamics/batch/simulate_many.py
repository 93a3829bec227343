"""Many simulations of one mechanism on all cores: what is asked, chunks of it in threads, and a table of results."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from copy import copy
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import described, refuse_other_arguments, users_progress, whole_number
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import Suggesting, no_such, shown
from mbsd.base.running import cores
from mbsd.base.warning import quiet
from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.loop import Measures, Work, all_outputs, plan_of
from mbsd.dynamics.batch.single_run import NotCompiled, single_run
from mbsd.dynamics.batch.worker import TRIED, Worker
from mbsd.dynamics.integrators.advance import PAUSED_ANYWHERE
from mbsd.dynamics.measures.columns import Done, joined, numbers_of
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Quantity, quantity_named
from mbsd.dynamics.runs.run import Request
from mbsd.dynamics.simulate import PART, simulate, simulated
from mbsd.model.mechanism import Model
from mbsd.model.output_times import check_memory
from mbsd.results.columns import columns

if TYPE_CHECKING:
    import pandas

MOST_THREADS = 1024
AT_ONCE, MOST_AT_ONCE = 64, 256
"""Simulations of a chunk; as many as the latter where each thread has CHUNKS of them and more."""
CHUNKS = 16
NUMBERS_AT_ONCE = 1_600_000
"""Numbers of a chunk's outputs."""
NUMBERS_OF_A_BODY = 12
"""Numbers of an output of a body and its joints."""
NUMBERS_OF_A_ROW = 12
"""Numbers' room that a simulation takes beside its columns: what varies, its reasons, its part of a chunk."""
LOOK = 0.2
"""s between two looks at the keyboard."""
REASON = "reason"
WRONGLY_WRITTEN = (NameError, AttributeError, TypeError, KeyError, ImportError, ModelError)
"""Errors of a function that is wrong for any simulation."""


@dataclass(frozen=True, eq=False)
class Simulations(Suggesting):
    """Measures of n simulations, in the order of the values that were given."""

    columns: dict[str, np.ndarray]
    """(n,), or (n, k), by name; NaN where there is a reason."""
    reason: list[str | None]
    """(n,) why a simulation failed; None where it did not."""
    alone: list[str | None]
    """(n,) why a simulation was made by itself; None of those in the compiled loop."""
    note: str | None
    """Why those in the loop were prepared one by one, if they were."""

    def __getitem__(self, name: str) -> np.ndarray:
        """A column. Raises ModelError for one that there is not."""
        if name not in self.columns:
            raise ModelError(f"simulations: {no_such('column', name, self.columns)}")
        return self.columns[name]

    def __len__(self) -> int:
        return len(self.reason)

    @property
    def good(self) -> np.ndarray:
        """(n,) which did not fail."""
        return np.array([reason is None for reason in self.reason])

    @property
    def way(self) -> str:
        """How they were simulated, in words."""
        whys = Counter(why for why in self.alone if why is not None)
        count, outside = len(self), sum(whys.values())
        parts = [f"{number} one by one ({why})" for why, number in whys.most_common()]
        if outside < count:
            prepared = f" ({self.note})" if self.note else ""
            parts.insert(0, f"{'all' if not outside else count - outside} of {count} in the compiled loop{prepared}")
        return ", ".join(parts)

    def table(self) -> pandas.DataFrame:
        """As a pandas DataFrame, a row a simulation. Needs the extra ``pandas``."""
        try:
            import pandas
        except ImportError as error:
            raise ModelError("table needs pandas: install mbsd[pandas]") from error
        return pandas.DataFrame(self.flat() | {REASON: self.reason})

    def flat(self) -> dict[str, Any]:
        """(n,) columns alone: one of k numbers a row is k columns, ``name_0`` and so on."""
        out: dict[str, Any] = {}
        for name, column in self.columns.items():
            wide = column.reshape(len(column), -1)
            out |= {name if column.ndim == 1 else f"{name}_{k}": wide[:, k] for k in range(wide.shape[1])}
        return out

    def __repr__(self) -> str:
        bad = len(self) - int(self.good.sum())
        return f"<Simulations: {self.way}; {bad} failed; {', '.join(self.columns)}>"


def simulations(
    designs: Designs, measure: Any, asked: Request, threads: int | None, progress: Callable[[float], None] | None
) -> Simulations:
    """Measures of all designs; see :meth:`mbsd.mechanism.Mechanism.simulate_many`."""
    m, grid = designs.m, asked.times
    refuse_threads(m.name, threads)
    progress = users_progress(f"{m.name}: progress", progress, PART)
    measures = checked_measures(m, measure, grid)
    quantities = {} if callable(measures) else quantities_of(designs, measures)
    why = _why_single(designs, asked, measures, quantities)
    width = 1 if callable(measures) else sum(column[0].size for column in empty_columns(measures, 1).values())
    numbers = (3 * width + NUMBERS_OF_A_ROW) * designs.count
    check_memory(f"{m.name}: {designs.count} simulations", numbers, "Take fewer at once")
    if callable(measures):
        _refuse_no_numbers(designs, asked, measures)
    pausing = asked.integrator in PAUSED_ANYWHERE
    work = Work(
        designs,
        asked,
        measures,
        quantities,
        why,
        np.zeros(1, np.int64),
        all_outputs(len(grid)) if callable(measures) or not pausing else plan_of(grid, measures, quantities),
        any(quantity.reactive for quantity in quantities.values()),
    )
    with quiet():  # here, as threads share what is shown
        numbers = len(grid) * NUMBERS_OF_A_BODY * len(m.bodies)
        most = min(threads or cores(), designs.count)
        done = in_chunks(lambda: Worker(work), designs.count, numbers, most, why is None, work.stop, progress)
    table = done.columns if callable(measures) else empty_columns(measures, designs.count) | done.columns
    return Simulations(table, done.reasons, done.alone, work.note)


def refuse_threads(name: str, threads: int | None) -> None:
    """Raise ModelError for what is no number of threads."""
    if threads is not None and whole_number(f"{name}: threads", threads) > MOST_THREADS:
        raise ModelError(f"{name}: threads is {shown(threads)}; it must be {MOST_THREADS} at most")


def empty_columns(measures: Mapping[str, Measure], count: int) -> dict[str, np.ndarray]:
    """All columns, without numbers."""
    shapes = {column: each.shape for name, each in measures.items() for column in each.columns(name)}
    return {column: np.full((count, *shape), np.nan) for column, shape in shapes.items()}


def checked_measures(m: Model, measure: Any, grid: np.ndarray) -> Measures:
    """As given, checked."""
    if callable(measure):
        refuse_other_arguments(f"{m.name}: measure", measure, "a solution")
        return measure
    if not isinstance(measure, Mapping) or not measure:
        raise ModelError(
            f"{m.name}: measure is {shown(measure)}; give names and measures, {{'angle': final('door.theta')}}, or a "
            "function of a solution that gives names and numbers"
        )
    names: set[str] = set()
    for name, each in measure.items():
        if not isinstance(name, str) or not isinstance(each, Measure):
            raise ModelError(
                f"{m.name}: measure: {shown(name)} is {shown(each)}; it must be a measure under a name, such as "
                "final('door.theta') of mbsd.measures"
            )
        for column in each.columns(name):
            if column in names or column == REASON:
                raise ModelError(f"{m.name}: measure: there are two columns '{column}'; take another name")
            names.add(column)
        each.check(f"{m.name}: measure '{name}'", grid)
    return dict(measure)


def quantities_of(designs: Designs, measures: Mapping[str, Measure]) -> dict[str, Quantity]:
    """By name, all that the measures read. Raises ModelError for one that there is not."""
    names = list(dict.fromkeys(name for each in measures.values() for name in each.quantities))
    known = _column_names(designs)
    return {name: quantity_named(designs.m, name, known) for name in names}


def _refuse_no_numbers(designs: Designs, asked: Request, measure: Callable[[Any], Any]) -> None:
    """Raise ModelError if ``measure`` gives anything but numbers of the first simulation, or is written wrongly.

    Else what it raises is the reason of that row.
    """
    with quiet():
        try:
            sol = simulated(designs.row_by_row()(0), asked)
        except Exception:
            return
        try:
            given = measure(sol)
        except WRONGLY_WRITTEN as error:
            raise ModelError(f"{designs.m.name}: measure fails for the first simulation: {described(error)}") from error
        except Exception:
            return
    numbers_of(designs.m.name, given)


def _column_names(designs: Designs) -> list[str]:
    """Names of the columns of their solutions, from one of an instant: the mechanism itself, or a row that starts."""
    models, first = designs.row_by_row(), None
    for row in range(-1, min(designs.count, TRIED)):
        try:
            own = copy(models(row) if row >= 0 else designs.m)
            own.events = {}  # none belongs to this instant
            return list(columns(simulate(own, 1e-9, 1, None, "dop853", 1e-6, None, _unseen, {})))
        except MechanismError as error:
            first = first or error
    assert first is not None
    raise first


def _unseen(part: float) -> None:
    """The progress of an instant, which may compile for a while and would say how far it is."""


def _why_single(designs: Designs, asked: Request, measures: Any, quantities: Mapping[str, Quantity]) -> str | None:
    if callable(measures):
        return "measure is a function of a solution"
    slow = [name for name, quantity in quantities.items() if quantity.of_motions is None]
    if slow:
        return f"'{slow[0]}' is that of a single solution"
    models, reactive = designs.row_by_row(), any(quantity.reactive for quantity in quantities.values())
    for row in {0, designs.count // 2, designs.count - 1}:
        try:
            single_run(models(row), asked, reactive)
        except NotCompiled as why:
            return str(why)
        except Exception:
            continue  # a row may fail
        return None
    return None


def in_chunks(
    worker: Callable[[], Callable[[range], Done]], count: int, numbers: int, threads: int, at_once: bool,
    stop: np.ndarray, progress: Callable[[float], None] | None,
) -> Done:  # fmt: skip
    """Return all rows in order, chunk by chunk, each thread with a worker of its own; not ``at_once``: in one thread.

    ``numbers``: those of a row's outputs. ``stop`` (1,) is set where an error ends it. This thread does no chunk, so
    that it hears Ctrl-C at once.
    """
    most = min(max(AT_ONCE, count // (CHUNKS * threads)), MOST_AT_ONCE)
    size = max(1, min(most, NUMBERS_AT_ONCE // numbers, -(-count // threads)))
    chunks = [range(1), *(range(first, min(first + size, count)) for first in range(1, count, size))]
    own = threading.local()

    def part(rows: range) -> Done:
        if not hasattr(own, "worker"):
            own.worker = worker()
        return own.worker(rows)

    finished, ended = 0, SimpleQueue[Future[Done]]()
    with ThreadPoolExecutor(threads if at_once else 1) as pool:
        futures: dict[Future[Done], int] = {}
        try:
            for some in (chunks[:1], chunks[1:]):  # the first compiles what the others need
                for rows in some:
                    future = pool.submit(part, rows)
                    futures[future] = len(rows)
                    future.add_done_callback(ended.put)
                for _ in some:
                    future = _next(ended)
                    future.result()
                    finished += futures[future]
                    if progress is not None:
                        progress(finished / count)
        except BaseException:
            stop[0] = 1
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return joined([future.result() for future in futures])


def _next(ended: SimpleQueue[Future[Done]]) -> Future[Done]:
    """The next that ends; Ctrl-C is heard meanwhile."""
    while True:
        try:
            return ended.get(timeout=LOOK)
        except Empty:
            continue
