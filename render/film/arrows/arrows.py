"""Arrows of a film: how long each is, and its line in the legend. One scale for the whole clip and for each unit."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.scales import LONGEST, TINY, scales_of
from render.film.arrows.vectors import Vector, at_time
from render.film.scene import ArrowSpec, LegendRow, Point
from shared.contract.quantity import written
from shared.contract.signals import SIGNALS, rgb

Array = NDArray[np.float64]
FULL = 0.25
"""Length of the largest arrow, as a part of the size of the swept motion."""
SHAFT, HEAD, POINT = 0.0042, 0.0125, 0.037
"""Radii of shaft and cone and the cone's length, as parts of the size of the swept motion."""


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
                colour=rgb(SIGNALS[vector.row].dark),
                tip=SIGNALS[vector.row].head,
                shaft=SHAFT * self.size,
                head=HEAD * self.size,
                point=POINT * self.size,
            )
            for vector in self.vectors
        ]

    def legend(self, width: float) -> list[LegendRow]:
        """A row for each quantity, and for weights, in a picture that is ``width`` (m) wide where the machine is."""
        rows = []
        for quantity, unit in dict.fromkeys((vector.row, vector.unit) for vector in self.vectors):
            scale = self.scales[unit]
            length = FULL * self.size * scale.reference / scale.largest / width
            cut = any(
                float(vector.size.max()) > LONGEST * scale.largest * (1 + 1e-9)
                for vector in self.vectors
                if vector.row == quantity
            )
            words = f"{quantity}, peaks cut" if cut else quantity
            rows.append(
                LegendRow(
                    number=written(scale.reference, scale.unit),
                    words=words,
                    colour=rgb(SIGNALS[quantity].dark),
                    tip=SIGNALS[quantity].head,
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
            length = self._length(size, vector.unit)
            if size == 0 or length < TINY * FULL * self.size:
                length, size = 0.0, 1.0
            out.append(((x, y, z), (x + u / size * length, y + v / size * length, z)))
        return out

    def tips(self, heights: Sequence[float], way: Array | None = None) -> list[Array]:
        """Where each tip is (n, 3) over the whole motion (m), wherever there is one, as seen from a ``way`` (T, 3)."""
        out = []
        for vector, z in zip(self.vectors, heights, strict=True):
            length = self._lengths(vector)
            seen = length >= TINY * FULL * self.size
            tip = vector.place[seen] + vector.value[seen] * (length[seen] / vector.size[seen])[:, None]
            out.append(np.column_stack([tip, np.full(len(tip), z)]) - (0.0 if way is None else way[seen]))
        return out

    def _lengths(self, vector: Vector) -> Array:
        unit = vector.unit
        return np.array([self._length(float(size), unit) for size in vector.size])

    def _length(self, size: float, unit: str) -> float:
        scale = self.scales.get(unit)
        return FULL * self.size * min(size / scale.largest, LONGEST) if scale else 0.0
