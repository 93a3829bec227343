"""Arrows of a film: how long each is, and the legend that tells it. One scale for the whole clip and for each unit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.scene import ArrowSpec, Colour, LegendRow, Point
from render.vectors import UNITS, Vector, at_time

Array = NDArray[np.float64]
FULL = 0.25
"""Length of the largest arrow, as a part of the size of the swept motion."""
USUAL, PEAK, LONGEST = 97.0, 1.7, 1.35
"""Peaks up to PEAK times this percentile of the largest at each time set the scale themselves; higher ones are cut at
so many full lengths."""
TINY = 0.025
"""Of the full length: shorter arrows are left out."""
SHAFT, HEAD, POINT = 0.0042, 0.0125, 0.037
"""Radii of shaft and cone and the cone's length, as parts of the size of the swept motion."""
COLOURS: dict[str, Colour] = {
    "velocities": (0.16, 0.86, 0.54),
    "accelerations": (0.72, 0.50, 1.0),
    "forces": (1.0, 0.56, 0.13),
    "reactions": (0.30, 0.66, 1.0),
}
"""sRGB: those of the drawn animations, brighter, for a dark studio."""


PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


@dataclass(frozen=True)
class Scale:
    """Of one unit: what is drawn at full length, a round number below it, and whether longer arrows are cut."""

    unit: str
    largest: float
    reference: float
    cut: bool


class Arrows:
    """The arrows of one film, ``size`` (m) being that of its swept motion."""

    def __init__(self, time: Array, vectors: Sequence[Vector], size: float) -> None:
        self.time, self.size = time, size
        self.scales = scales_of(vectors)
        self.vectors = [v for v in vectors if self._lengths(v).max() >= TINY * FULL * size]
        """Those that are seen at some time."""

    def specs(self) -> list[ArrowSpec]:
        """Their looks, in the order of ``vectors``."""
        return [
            ArrowSpec(
                name=f"{vector.quantity} {vector.name}",
                colour=COLOURS[vector.quantity],
                shaft=SHAFT * self.size,
                head=HEAD * self.size,
                point=POINT * self.size,
            )
            for vector in self.vectors
        ]

    def legend(self, width: float) -> list[LegendRow]:
        """A row for each quantity, in a picture that is ``width`` (m) wide where the machine is."""
        rows = []
        for quantity in dict.fromkeys(vector.quantity for vector in self.vectors):
            scale = self.scales[UNITS[quantity]]
            length = FULL * self.size * scale.reference / scale.largest / width
            words = f"{quantity}, peaks cut" if scale.cut else quantity
            rows.append(
                LegendRow(
                    number=with_unit(scale.reference, scale.unit),
                    words=words,
                    colour=COLOURS[quantity],
                    length=length,
                    point=POINT * self.size / width,
                )
            )
        return rows

    def at(self, t: float, heights: Sequence[float]) -> list[tuple[Point, Point]]:
        """Tail and tip of each at time ``t``, ``heights`` (m) over the base; equal where it is left out."""
        out = []
        for vector, z in zip(self.vectors, heights, strict=True):
            x, y, u, v = (float(k) for k in at_time(self.time, np.hstack([vector.place, vector.value]), t))
            size = math.hypot(u, v)
            length = self._length(size, UNITS[vector.quantity])
            if size == 0 or length < TINY * FULL * self.size:
                length, size = 0.0, 1.0
            out.append(((x, y, z), (x + u / size * length, y + v / size * length, z)))
        return out

    def tips(self, heights: Sequence[float]) -> list[Array]:
        """Where each tip is (T, 3) over the whole motion (m)."""
        out = []
        for vector, z in zip(self.vectors, heights, strict=True):
            size = vector.size
            factor = np.divide(self._lengths(vector), size, out=np.zeros_like(size), where=size > 0)
            tip = vector.place + vector.value * factor[:, None]
            out.append(np.column_stack([tip, np.full(len(tip), z)]))
        return out

    def _lengths(self, vector: Vector) -> Array:
        unit = UNITS[vector.quantity]
        return np.array([self._length(float(size), unit) for size in vector.size])

    def _length(self, size: float, unit: str) -> float:
        scale = self.scales.get(unit)
        return FULL * self.size * min(size / scale.largest, LONGEST) if scale else 0.0


def scales_of(vectors: Sequence[Vector]) -> dict[str, Scale]:
    """By unit, for those that are anything at all."""
    by_unit: dict[str, list[Array]] = {}
    for vector in vectors:
        by_unit.setdefault(UNITS[vector.quantity], []).append(vector.size)
    out = {}
    for unit, sizes in by_unit.items():
        peaks = np.max(sizes, axis=0)
        top, usual = float(peaks.max()), float(np.percentile(peaks, USUAL))
        if not math.isfinite(top) or top <= 0:
            continue
        usual = usual if usual > 0.02 * top else 0.5 * top  # a short pulse in a motion that is else at rest
        largest = top if top <= PEAK * usual else usual
        out[unit] = Scale(unit, largest, round_below(0.9 * largest), top > LONGEST * largest * (1 + 1e-9))
    return out


def round_below(value: float) -> float:
    """The largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... that is not above ``value`` > 0."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(step for step in (5.0, 2.0, 1.0, 0.5) if step * power <= value * (1 + 1e-9)) * power


def with_unit(value: float, unit: str) -> str:
    """``0.5 N``, ``20 mN``, ``5 kN``; a small speed in mm/s."""
    if unit.startswith("m"):
        return f"{value:g} {unit}" if value >= 0.1 else f"{value * 1000:g} m{unit}"
    power = 3 * min(max(math.floor(math.log10(value) / 3 + 1e-9), -3), 3) if value < 0.1 or value >= 1000 else 0
    return f"{float(f'{value / 10.0**power:.6g}'):g} {PREFIXES[power]}{unit}"
