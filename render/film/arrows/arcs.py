"""Curved arrows of a film: how far each reaches round its pivot, and its line in the legend."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.arrows import HEAD, POINT, SHAFT
from render.film.arrows.scales import LONGEST, TINY, scales_of
from render.film.arrows.torques import UNIT, Torque
from render.film.arrows.vectors import at_time
from render.film.scene import ArcSpec, LegendRow, Point
from shared.contract.quantity import written
from shared.contract.signals import SIGNALS, rgb

Array = NDArray[np.float64]
FULL_TURN = 1.25 * math.pi
"""Sweep (rad) of the largest torque."""
RADIUS, APART = 0.066, 0.022
"""Radius of an arc, and how much wider each further one about the same point is, as parts of the size."""
WORDS = {"forces": "torques", "reactions": "torques of joints"}
SIGNAL = {"forces": "torques", "reactions": "reactions"}
"""Whose colour they have."""
STOUT = 1.3
"""Thickness of an arc in that of an arrow: it stands on parts, not beside them."""


class Arcs:
    """The curved arrows of one film, ``size`` (m) being that of its swept motion; ``least`` (N m) is rounding."""

    def __init__(self, time: Array, torques: Sequence[Torque], size: float, least: float = 0.0) -> None:
        self.time, self.size = time, size
        self.scale = scales_of(torques, {UNIT: least}).get(UNIT)
        self.torques = [torque for torque in torques if abs(self._sweeps(torque)).max() >= TINY * FULL_TURN]
        """Those that are seen at some time."""

    def specs(self) -> list[ArcSpec]:
        """Their looks, in the order of ``torques``; those about one point lie around each other."""
        return [
            ArcSpec(
                name=f"{torque.quantity} {torque.name}",
                colour=rgb(SIGNALS[SIGNAL[torque.quantity]].dark),
                radius=self._radius(k),
                shaft=STOUT * SHAFT * self.size,
                head=STOUT * HEAD * self.size,
                point=POINT * self.size,
            )
            for k, torque in enumerate(self.torques)
        ]

    def legend(self) -> list[LegendRow]:
        """A row for each quantity, with an arc that reaches as far as that torque's does in the picture."""
        scale = self.scale
        if scale is None:
            return []
        return [
            LegendRow(
                number=written(scale.reference, scale.unit),
                words=f"{WORDS[quantity]}, peaks cut" if scale.cut else WORDS[quantity],
                colour=rgb(SIGNALS[SIGNAL[quantity]].dark),
                sweep=FULL_TURN * scale.reference / scale.largest,
            )
            for quantity in dict.fromkeys(torque.quantity for torque in self.torques)
        ]

    def at(self, t: float, heights: Sequence[float]) -> list[tuple[Point, float]]:
        """Centre and sweep (rad, positive counter-clockwise) of each at time ``t``, ``heights`` (m) over the base."""
        out = []
        for torque, z in zip(self.torques, heights, strict=True):
            x, y, value = (float(k) for k in at_time(self.time, np.column_stack([torque.place, torque.value]), t))
            sweep = float(self._sweep(np.array([value]))[0])
            out.append(((x, y, z), sweep if abs(sweep) >= TINY * FULL_TURN else 0.0))
        return out

    def rims(self, heights: Sequence[float], way: Array | None = None) -> list[Array]:
        """Points (8 T, 3) around each over the whole motion (m), as seen from a ``way`` (T, 3)."""
        turn = math.tau * np.arange(8) / 8
        out = []
        for k, (torque, z) in enumerate(zip(self.torques, heights, strict=True)):
            reach = self._radius(k) + STOUT * HEAD * self.size
            rim = torque.place[:, None] + reach * np.stack([np.cos(turn), np.sin(turn)], axis=1)
            ring = np.column_stack([rim.reshape(-1, 2), np.full(8 * len(torque.place), z)])
            out.append(ring - (0.0 if way is None else np.repeat(way, 8, axis=0)))
        return out

    def _radius(self, k: int) -> float:
        """Radius of arc number ``k`` (m): wider than those before it about the same point."""
        mine = self.torques[k].place
        inside = sum(bool(np.abs(torque.place - mine).max() < RADIUS * self.size / 4) for torque in self.torques[:k])
        return (RADIUS + APART * inside) * self.size

    def _sweeps(self, torque: Torque) -> Array:
        return self._sweep(torque.value)

    def _sweep(self, values: Array) -> Array:
        """(T,) rad of torques (T,) in N m."""
        if self.scale is None:
            return np.zeros(len(values))
        return FULL_TURN * np.clip(values / self.scale.largest, -LONGEST, LONGEST)
