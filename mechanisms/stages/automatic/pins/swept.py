"""Discs that moving things sweep, in cells of the plane, so that of millions a ray looks at few."""

from __future__ import annotations

import numpy as np

FEW = 300_000
"""So many are looked at one by one."""
CELL = 8.0
"""Side of a cell (rmm)."""
LOOSE = 1e-6
"""Added to what is compared, well above rounding (rmm)."""


class Swept:
    """Discs (n, 3): x, y, radius (rmm)."""

    def __init__(self, discs: np.ndarray, few: int = FEW) -> None:
        self._discs, self._is_few = discs, len(discs) <= few
        if self._is_few:
            return
        cells = np.floor(discs[:, :2] / CELL).astype(np.int64)
        cells -= cells.min(axis=0)
        keys = cells[:, 0] * (cells[:, 1].max() + 1) + cells[:, 1]
        order = np.argsort(keys, kind="stable")
        self._discs = discs[order]
        self._starts = np.flatnonzero(np.diff(keys[order], prepend=-1))
        self._ends = np.append(self._starts[1:], len(discs))
        self._centres = (np.floor(self._discs[self._starts, :2] / CELL) + 0.5) * CELL
        self._least = np.minimum.reduceat(self._discs[:, 2], self._starts)
        self._most = np.maximum.reduceat(self._discs[:, 2], self._starts)

    def outermost(self, at: np.ndarray, way: np.ndarray) -> np.ndarray:
        """(m, 3): some of the discs, with the one among them that a ray from ``at`` along ``way`` leaves last."""
        if self._is_few:
            return self._discs
        seen, half = self._centres - at, CELL / np.sqrt(2.0) + LOOSE
        along, aside = seen @ way, np.abs(seen @ np.array([-way[1], way[0]]))
        surely = along[aside + half < self._least] - half
        may = (aside - half < self._most) & (along + half + self._most >= surely.max(initial=-np.inf))
        return np.concatenate(
            [self._discs[:0], *(self._discs[self._starts[k] : self._ends[k]] for k in may.nonzero()[0])]
        )
