"""How much of a picture the machine fills, and how much of what stands around it is worth a smaller machine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.framing import Empty, axes, fit, half_field
from render.presets import ASPECT

Array = NDArray[np.float64]
FILLED = 0.8
"""Part of the picture's width, or of the height that titles leave, that the machine fills at least."""
AIM = 0.81
"""The same as it is composed, for what a search leaves open."""
DRAWN = 0.88
"""Arrows count as if they were so near to the machine: their tips may come into the margins, which stay theirs."""
WAYS = 256
"""Directions in which points count while the part of the surroundings is looked for."""
STEPS = 12


@dataclass(frozen=True)
class View:
    """From where one looks, and at a picture of which shape. Angles in rad, lens in mm."""

    azimuth: float
    elevation: float
    lens: float
    margin: float
    empty: Empty = (0.0, 0.0)
    aspect: float = ASPECT
    aside: float = 0.0
    """Part of the width that stays empty at the right."""

    def stand(self, points: Array) -> tuple[Array, float]:
        """The closest place (3,) of a camera that holds points (n, 3), and its distance (m) to their middle."""
        return fit(points, self.azimuth, self.elevation, self.lens, self.margin, self.empty, self.aspect, self.aside)

    def filled(self, points: Array, position: Array) -> tuple[float, float]:
        """Parts of the picture's width and height that points (n, 3) take, seen from ``position`` (3,)."""
        u, v, w = ((points - position) @ axes(self.azimuth, self.elevation).T).T
        half = half_field(self.lens, self.aspect)
        across, up = (float(np.ptp(part / w)) / (2 * side) for part, side in zip((u, v), half, strict=True))
        return across, up


def held(view: View, machine: Array, around: Array, drawn: Array, few: Array | None = None) -> Array:
    """Points (n, 3) that a picture holds: all of the ``machine`` (m, 3), arrows that are ``drawn`` (k, 3) about it, and
    what stands ``around`` (l, 3) as far as the machine then fills :data:`FILLED`; beyond that, it may leave the frame.
    ``few`` are the :func:`outermost` of the machine, where they are known.
    """
    middle = (machine.min(axis=0) + machine.max(axis=0)) / 2
    drawn = middle + DRAWN * (drawn - middle)
    if not len(around):
        return np.concatenate([machine, drawn])
    few, rest = outermost(machine) if few is None else few, outermost(around)
    arrows = outermost(drawn)
    most, room = min(AIM, 0.99 * (1 - 2 * view.margin)), 1 - 2 * view.margin
    left = 1 - sum(min(part / room, 1 / 3) for part in view.empty)  # of the height, by what is written

    def suffices(part: float) -> bool:
        position, _ = view.stand(np.concatenate([few, arrows, middle + part * (rest - middle)]))
        across, up = view.filled(few, position)
        return max(across / (1 - view.aside), up / left) >= most

    low, high = 0.0, 1.0
    if suffices(high):
        low = high
    else:
        for _ in range(STEPS):
            half = (low + high) / 2
            low, high = (half, high) if suffices(half) else (low, half)
    return np.concatenate([machine, drawn, middle + low * (around - middle)])


def outermost(points: Array) -> Array:
    """Those of points (n, 3) that are farthest in some direction of a sphere; few where there are many."""
    if len(points) <= WAYS:
        return points
    k = np.arange(WAYS) + 0.5
    up, turn = 1 - 2 * k / WAYS, np.pi * (1 + 5**0.5) * k
    flat = np.sqrt(1 - up**2)
    ways = np.stack([flat * np.cos(turn), flat * np.sin(turn), up], axis=1)
    best = np.full(WAYS, -np.inf)
    chosen = np.zeros(WAYS, int)
    for first in range(0, len(points), 100_000):  # of a chain there are millions
        reach = ways @ points[first : first + 100_000].T
        at = reach.argmax(axis=1)
        top = reach[np.arange(WAYS), at]
        better = top > best
        chosen[better] = first + at[better]
        best = np.maximum(best, top)
    return points[np.unique(chosen)]
