"""Rows end where all their measures are known: outputs are looked at window by window.

What a measure says of a window is what it says of all outputs up to its end, if it knew nothing of those before: each
window begins with the last output of the one before, as straight lines between outputs do.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from mbsd.dynamics.many.measures import Measure
from mbsd.dynamics.many.outputs import Outputs
from mbsd.dynamics.many.quantities import Motions, Quantity

MOST, LEAST = 10, 24
"""Windows, and outputs of a window: looking costs as much as some steps of a row."""
STEPS = 4
"""Steps between two looks at how far a row came."""


def windows_of(times: int, measures: Mapping[str, Measure], quantities: Mapping[str, Quantity]) -> list[int]:
    """Numbers of outputs at which rows are looked at, the last of them ``times``: that alone where none ends early."""
    known_early = all(measure.ends for measure in measures.values())
    if not known_early or any(quantity.reactive for quantity in quantities.values()):
        return [times]
    size = max(LEAST, math.ceil(times / MOST))
    return [*range(size, times, size), times]


class Known:
    """Which measures of which rows are known, as windows pass."""

    def __init__(self, measures: Mapping[str, Measure], quantities: Mapping[str, Quantity], rows: int) -> None:
        self.measures, self.quantities = measures, quantities
        self.known = np.zeros((len(measures), rows), bool)

    def look(self, rows: np.ndarray, t: np.ndarray, motions: Motions) -> np.ndarray:
        """Which of ``rows``, whose motions in a window (n, T) these are, have nothing left to measure."""
        along = {
            name: quantity.of_motions(motions)
            for name, quantity in self.quantities.items()
            if quantity.of_motions is not None
        }
        for known, measure in zip(self.known, self.measures.values(), strict=True):
            known[rows] |= measure.known(t, along)
        return rows[self.known[:, rows].all(axis=0)]


def window(out: Outputs, begin: int, end: int) -> Outputs:
    """Outputs ``begin`` to ``end`` (left out) of all rows."""
    y, a, lam, work, margin = (part[:, begin:end] for part in (out.y, out.a, out.lam, out.work, out.margin))
    return Outputs(out.t[begin:end], y, a, lam, work, margin, out.status, out.steps, out.over)
