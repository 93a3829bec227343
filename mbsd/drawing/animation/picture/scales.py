"""How long an arrow is drawn: one scale for the whole clip and for all quantities of one unit in a picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.quantities.arrows import Arc, Arrow
from mbsd.drawing.animation.words import QUANTITIES, round_below

USUAL = 97.0
"""Percentile of the largest at each time that sets the scale."""
PEAK = 1.7
"""Peaks up to so many times the usual set it themselves; higher ones are cut."""
LONGEST = 1.35
"""Length of an arrow that is cut, in lengths of the usual largest one."""
FULL_TURN = 1.5 * math.pi
"""Sweep of the largest arc."""
NOTHING = 1e-9
"""Fraction of the largest of all pictures of this unit, or of what is usual: less is rounding and not drawn."""


@dataclass(frozen=True)
class Scale:
    """Scale of one unit in one picture."""

    unit: str
    largest: float
    """What is drawn at full length (in ``unit``)."""
    reference: float
    """A round number below, for the legend."""
    cut: bool
    """Whether some arrow is longer than it is drawn."""

    def part(self, size: np.ndarray | float) -> np.ndarray:
        """Fraction of the full length, at most LONGEST."""
        return np.minimum(np.asarray(size) / self.largest, LONGEST)


def scales_of(marks: Sequence[Arrow | Arc], floor: dict[str, float]) -> dict[str, Scale]:
    """By unit, for those that are more than rounding: ``floor`` says what counts as nothing."""
    out = {}
    by_unit: dict[str, list[np.ndarray]] = {}
    for mark in marks:
        by_unit.setdefault(unit_of(mark), []).append(mark.size)
    for unit, sizes in by_unit.items():
        peaks = np.max(sizes, axis=0)
        top, usual = float(peaks.max()), float(np.percentile(peaks, USUAL))
        if not np.isfinite(top) or top <= floor.get(unit, 0.0):
            continue
        usual = usual if usual > 0.02 * top else 0.5 * top  # a short pulse in a motion that is else at rest
        largest = top if top <= PEAK * usual else usual
        out[unit] = Scale(unit, largest, round_below(0.9 * largest), top > LONGEST * largest * (1 + 1e-9))
    return out


def unit_of(mark: Arrow | Arc) -> str:
    """Unit of an arrow or an arc."""
    quantity = QUANTITIES[mark.quantity]
    return quantity.turning if isinstance(mark, Arc) else quantity.unit
