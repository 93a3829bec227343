"""How far a result strays as the dimensions of a mechanism do.

    t = tolerances(m, {"crank": 5e-5, "coupler": 5e-5, "B": Clearance(2e-5)}, largest("P.y"), limits=(0.0694, 0.0696))
    print(t)                                     # mean, spread, worst case, yield, what to tighten
    t.plot().save("tolerances.svg")

Sources: Garrett, Hall, Effect of tolerance and clearance in linkage design, J. Eng. for Industry 91, 1969 (bands of a
linkage that strays); Shigley's Mechanical Engineering Design, section 1-13 (stack-ups, worst case and statistical).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.arguments import checked, finite_number, users_progress, whole_number
from mbsd.base.errors import ModelError
from mbsd.model.mechanism import Model
from mbsd.model.output_times import check_memory
from mbsd.tolerancing.dimensions.dimension import Dimension
from mbsd.tolerancing.machines.one_by_one import Machines
from mbsd.tolerancing.machines.results import named_after
from mbsd.tolerancing.machines.tasks import Task, function_task, task_of
from mbsd.tolerancing.outcome import Tolerances
from mbsd.tolerancing.statistics import (
    curved,
    drawn,
    halving,
    limits_given,
    linear_variances,
    linear_worst,
    middles,
    parts,
    shares_of,
    slopes,
    sobol_indices,
    solved_again,
    vertex_worst,
    within,
)

NO_NUMBER = "the result is no number"
MOST = 100_000_000
"""Machines of one call."""
MOST_CORNERS = 16
"""Dimensions whose corners may be solved."""
FEWEST_SOBOL = 3
"""Power of 2 of the machines in a set at least."""


@checked
def tolerances(
    machine: Any,
    sizes: Any,
    result: Any = None,
    limits: Any = None,
    *,
    n: int = 10_000,
    seed: int = 0,
    duration: float | None = None,
    steps: int = 360,
    way: str = "auto",
    sobol: bool = False,
    corners: bool | None = None,
    confidence: float = 0.95,
    threads: int | None = None,
    progress: Any = None,
) -> Tolerances:
    """Let the dimensions of a mechanism stray, and return the spread of its ``result``.

    It comes from n mechanisms, with worst case and yield. ``sizes`` names what strays, by the words of
    :meth:`Mechanism.batch` and :meth:`Mechanism.change`: a bar or rod by its length, a joint or traced point by its
    place (m; ``{"D": {"x": 1e-5}}`` for one coordinate), any number by ``{"spring": {"stiffness": 4.0}}``, also of a
    law, ``{"motor": {"rate": 0.1}}``, a pin by :class:`Clearance`, or by ``{"B": {"x": 1e-5, "play":
    Clearance(2e-5)}}`` with its place. A tolerance is a number t (+-t, normal with 3 standard deviations), a pair
    (lower, upper), a class of ISO 2768-1 ("m") or a grade of ISO 286-1 ("IT7") by size, or ``Normal``, ``Uniform``,
    ``Triangular`` of these. A class alone in place of names is that of all bars and rods.

    ``result``: a measure of :mod:`mbsd.measures` that gives a number, such as ``samples("P.y", [0.25])``,
    ``largest("rocker.theta")``; or a function: of a :class:`Batch` of some of the machines at a time (a number of
    each), or of a single Solution where they are solved one by one. ``limits`` (lowest, highest) are those within which
    it is good.

    ``way``: "batch" sweeps linkages all at once, "sweep" one by one, "simulate" integrates ``duration`` s in one
    compiled loop; "auto" takes the first that can. Times are ``steps`` equal steps, by default over a period.

    ``machine`` may be a function of numbers by name, its nominal values as defaults: it gives the result, or what
    ``result`` takes it from, a mechanism to be swept included.

    ``sobol`` adds Sobol's indices, from the largest power of 2 up to n in each of d + 2 sets. ``corners``: whether the
    worst case is also sought at the 2^d corners of all tolerances; by default where they are no more than n.
    ``confidence`` is that of the yield's interval. Equal arguments give equal bytes. ``progress`` is called with the
    part of all machines that is done, those of corners, Sobol's indices and halved tolerances included. Raises
    ModelError for names that do not exist, tolerances that pass 0, limits the wrong way, results that
    are no number, and what the machine as given raises.
    """
    options = {"n": n, "seed": seed, "duration": duration, "steps": steps, "way": way, "sobol": sobol}
    options |= {"corners": corners, "confidence": confidence, "threads": threads, "progress": progress}
    return request_of(machine, sizes, result, limits, **options)()


@checked
def request_of(
    machine: Any,
    sizes: Any,
    result: Any = None,
    limits: Any = None,
    *,
    n: int = 10_000,
    seed: int = 0,
    duration: float | None = None,
    steps: int = 360,
    way: str = "auto",
    sobol: bool = False,
    corners: bool | None = None,
    confidence: float = 0.95,
    threads: int | None = None,
    progress: Any = None,
) -> Callable[[], Tolerances]:
    """Check a request, solve the given mechanism, and return the function that does the rest.

    See :func:`tolerances`.
    """
    task = function_task(machine, sizes, result, duration, steps) if not isinstance(machine, Model) else None
    owner = task.owner if task else machine.name
    n = whole_number(f"{owner}: tolerances: n", n, 2)
    if n > MOST:
        raise ModelError(f"{owner}: tolerances: n is {n}; take {MOST} at most")
    seed = whole_number(f"{owner}: tolerances: seed", seed, 0)
    within_limits = limits_given(owner, limits)
    if not 0.0 < finite_number(f"{owner}: tolerances: confidence", confidence) < 1.0:
        raise ModelError(f"{owner}: tolerances: confidence is {confidence:g}; it must be between 0 and 1, such as 0.95")
    progress = users_progress(f"{owner}: tolerances: progress", progress, "the part done")
    if task is None:
        task = task_of(machine, sizes, result, duration, steps, way, threads)
    _refuse_corners(owner, corners, len(task.dimensions))
    width = sum(len(dimension.columns) for dimension in task.dimensions)
    numbers = 5 * n * (1 + width) + sobol * 2 ** _power(n) * (5 * width + 2 + len(task.dimensions))
    check_memory(f"{owner}: tolerances: {n} machines", numbers, "Take fewer")
    quantity = named_after(machine if result is None else result)
    return partial(_carried_out, task, quantity, n, seed, within_limits, sobol, corners, confidence, progress)


def _carried_out(
    task: Task,
    quantity: str,
    n: int,
    seed: int,
    limits: Any,
    sobol: bool,
    corners: bool | None,
    confidence: float,
    progress: Any,
) -> Tolerances:
    dimensions = task.dimensions
    with_corners = corners if corners is not None else 2 ** len(dimensions) <= n
    of_sobol = sobol * (len(dimensions) + 2) * 2 ** _power(n)
    done = Progress(progress, with_corners * 2 ** len(dimensions) + 2 * n + of_sobol)  # halves may take as many again
    run = _Run(task.machines)
    at = middles(dimensions)
    middle = float(run(at[None])[0])
    slope = slopes(run, dimensions)
    if not np.isfinite([middle, *slope]).all():
        raise ModelError(
            f"{task.owner}: tolerances: mechanisms {_where(dimensions, middle, slope)} fail "
            f"({', '.join(run.failures)}). The tolerances are too wide for derivatives, or the motion passes a dead "
            "centre. Narrow them, or sweep a part of the motion (duration=...). Where joints repeat others or gears "
            "mesh, only exact lengths close: leave those out"
        )
    corner, corners_failed = None, 0
    if with_corners:
        corner, corners_failed = vertex_worst(_Run(task.machines, done), middle, slope, dimensions)
    x = drawn(dimensions, n, seed)
    run = _Run(task.machines, done)
    values = run(x)
    if np.isfinite(values).sum() < 2:
        raise ModelError(
            f"{task.owner}: tolerances: of {n} machines {int(np.isfinite(values).sum())} can be solved "
            f"({', '.join(run.failures)}); narrow the tolerances"
        )
    failures = dict(run.failures)
    indices = None
    if sobol:
        indices = sobol_indices(_Run(task.machines, done), dimensions, _power(n), seed)
    variances = linear_variances(slope, dimensions)
    linear_std = float(np.sqrt(variances.sum()))
    again = solved_again(values, curved(values, linear_std), len(dimensions))
    done.last(int(again.sum()) * len(dimensions))
    halves = halving(
        _Run(task.machines, done), dimensions, x, values, slope, again,
        lambda results: np.nan if limits is None else float(within(results, limits).mean()),
    )  # fmt: skip
    done.end()
    return Tolerances(
        values, x, tuple(_title(column) for d in dimensions for column in d.columns), task.nominal,
        linear_std, linear_worst(middle, slope, dimensions), corner, corners_failed, limits,
        confidence, failures, halves, indices, "; ".join([task.machines.way, *task.notes]), task.owner,
        tuple(dimensions), slope, shares_of(variances), quantity,
    )  # fmt: skip


def _power(n: int) -> int:
    """Power of 2 of the machines in a set for Sobol's indices."""
    return max(FEWEST_SOBOL, int(np.log2(n)))


class _Run:
    """Evaluates rows in parts that fit into memory."""

    def __init__(self, machines: Machines, progress: Progress | None = None) -> None:
        self._machines, self._progress = machines, progress
        self.failures: Counter[str] = Counter()

    def __call__(self, x: np.ndarray) -> np.ndarray:
        out = np.empty(len(x))
        for first in range(0, len(x), self._machines.at_once):
            part = slice(first, first + self._machines.at_once)
            answers = self._machines(x[part])
            out[part] = np.where(np.isfinite(answers.values), answers.values, np.nan)
            nameless = int(np.isnan(out[part]).sum()) - answers.failures.total()
            self.failures += answers.failures + Counter({NO_NUMBER: nameless})
            if self._progress is not None:
                self._progress.more(len(x[part]))
        return out


def _where(dimensions: Sequence[Dimension], middle: float, slope: np.ndarray) -> str:
    """Where machines fail about the middle, in words."""
    if not np.isfinite(middle):
        return "in the middle of the tolerances"
    own = zip(dimensions, parts(dimensions), strict=True)
    failing = [f"'{dimension.label}'" for dimension, part in own if not np.isfinite(slope[part]).all()]
    return f"a standard deviation of {' or '.join(failing)} beside the middle of the tolerances"


def _title(column: Any) -> str:
    part = {"bore": f".{column.key} in its bore", "reaction": ", half of its play", "length": ""}
    return column.name + part.get(column.kind, f".{column.key}" if column.key else "")


def _refuse_corners(owner: str, corners: bool | None, count: int) -> None:
    if corners and count > MOST_CORNERS:
        raise ModelError(
            f"{owner}: tolerances: {count} dimensions have 2^{count} corners; they are solved of {MOST_CORNERS} "
            "at most. The worst case by derivatives is there for any number"
        )


class Progress:
    """Gives a function of the user the part done, 0 .. 1, which never falls; it is 1 at the end alone."""

    def __init__(self, function: Callable[[float], object] | None, expected: int) -> None:
        self._function = function
        self._begun, self._share, self._rows, self._done = 0.0, 1.0, max(expected, 1), 0
        """The part before the rows that are counted now, what they are of the whole, how many they are, and how
        many of them are done."""

    def more(self, rows: int) -> None:
        """So many rows have been evaluated. What the function raises goes on."""
        self._done = min(self._done + rows, self._rows)
        if self._function is not None and self._part < 1.0:
            self._function(self._part)

    def last(self, rows: int) -> None:
        """The rest are so many rows, as is known by now."""
        self._begun, self._share = self._part, 1.0 - self._part
        self._rows, self._done = max(rows, 1), 0

    def end(self) -> None:
        """All is done."""
        if self._function is not None:
            self._function(1.0)

    @property
    def _part(self) -> float:
        return self._begun + self._share * self._done / self._rows
