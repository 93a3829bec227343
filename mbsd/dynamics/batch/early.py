"""Outputs that are made: rows end where all their measures are known, and what nobody reads is left out.

Where what decides is an angle or its rate, the loop itself compares every output with what it is to pass. All else is
looked at window by window. What a measure says of a window is what it says of all outputs up to its end, if
it knew nothing of those before: each window begins with the last output of the one before, as straight lines between
outputs do. Behind the last that needs all outputs a row goes on to its end with the few that the others read.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.dynamics.batch.outputs import Outputs
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Motions, Quantity

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
