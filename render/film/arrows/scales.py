"""How long arrows are and how far arcs reach: one scale for the whole clip and for each unit, and its round number."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
USUAL, PEAK, LONGEST = 97.0, 1.7, 1.35
"""Peaks up to PEAK times this percentile of the largest at each time set the scale themselves; higher ones are cut at
so many full lengths."""
MOSTLY, BLOW = 90.0, 4.0
"""This percentile counts instead where it is so many times smaller: blows that return would leave nothing of the rest.
"""
NEVER = 0.02
"""Fraction of the largest: what is smaller than this at nearly all times is a motion at rest."""
TINY = 0.025
"""Fraction of the full length: shorter arrows are left out."""


@dataclass(frozen=True)
class Scale:
    """Scale of one unit: what is drawn at full length, a round number below it, and whether longer arrows are cut."""

    unit: str
    largest: float
    reference: float
    cut: bool


class Sized(Protocol):
    """Something with a size over time (T,) in a unit."""

    @property
    def size(self) -> Array:
        """(T,)"""
        ...

    @property
    def unit(self) -> str:
        """Unit of the size."""
        ...


def scales_of(things: Sequence[Sized], least: Mapping[str, float] | None = None) -> dict[str, Scale]:
    """By unit, for those that are more than ``least`` of their unit, or than nothing."""
    by_unit: dict[str, list[Array]] = {}
    for thing in things:
        by_unit.setdefault(thing.unit, []).append(thing.size)
    out = {}
    for unit, sizes in by_unit.items():
        peaks = np.max(sizes, axis=0)
        top = float(peaks.max())
        mostly, usual = (float(part) for part in np.percentile(peaks, (MOSTLY, USUAL)))
        if not math.isfinite(top) or top <= (least or {}).get(unit, 0.0):
            continue
        if BLOW * mostly < usual and mostly > NEVER * top:
            usual = mostly
        usual = usual if usual > NEVER * top else 0.5 * top  # a short pulse in a motion that is else at rest
        largest = top if top <= PEAK * usual else usual
        out[unit] = Scale(unit, largest, round_below(0.9 * largest), top > LONGEST * largest * (1 + 1e-9))
    return out


def round_below(value: float) -> float:
    """The largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above ``value`` > 0."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(step for step in (5.0, 2.0, 1.0, 0.5) if step * power <= value * (1 + 1e-9)) * power
