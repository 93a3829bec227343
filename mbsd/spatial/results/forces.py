"""Forces along a motion: what each measures, how fast that changes, and how it pushes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.names import Suggesting
from mbsd.spatial.arrays.along import force_rows
from mbsd.spatial.arrays.packing import Packed


@dataclass(frozen=True, eq=False)
class ForceView(Suggesting):
    """A force of one row or more: m and N, or rad and N m."""

    values: np.ndarray
    """(T, rows) lengths, turns or places that it measures."""
    rates: np.ndarray
    """(T, rows) by s."""
    efforts: np.ndarray
    """(T, rows) pushes that make them larger."""

    @property
    def value(self) -> np.ndarray:
        """(T,) measure of the first row."""
        return self.values[:, 0]

    @property
    def rate(self) -> np.ndarray:
        """(T,) its rate, by s."""
        return self.rates[:, 0]

    @property
    def effort(self) -> np.ndarray:
        """(T,) push of the first row."""
        return self.efforts[:, 0]

    @property
    def power(self) -> np.ndarray:
        """(T,) power that it puts into the mechanism (W)."""
        return (self.rates * self.efforts).sum(axis=1)


def force_view(packed: Packed, force: int, motion: Any, wanted: np.ndarray) -> ForceView:
    """Return the view of a force, by its number, at the ``wanted`` steps of a motion with multipliers."""
    values, rates = force_values(packed, force, motion, wanted)
    rows = packed.system.held + _rows_of(packed, force)
    return ForceView(values, rates, -motion.lam[wanted][:, rows])


def force_values(packed: Packed, force: int, motion: Any, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what a force measures (T, rows), and its rates."""
    values, rates = force_rows(packed, *(part[wanted] for part in (motion.drives, motion.q, motion.v, motion.turn)))
    rows = _rows_of(packed, force)
    return values[:, rows], rates[:, rows]


def _rows_of(packed: Packed, force: int) -> np.ndarray:
    """Return the numbers of a force's rows among those of all forces."""
    counts = [len(known.pushes) for known in packed.forces]
    return np.arange(counts[force]) + sum(counts[:force])
