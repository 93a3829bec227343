"""Packs rectangles on as few plates as trimesh's packing finds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

ORDERS = 20
"""In which rectangles are tried, for each plate."""
DISTINCT = 1e-7
"""Rectangles get sizes that differ by this (mm): how equal ones are sorted would depend on the processor."""


@dataclass(frozen=True)
class Place:
    """Where a rectangle lies: its corner of least x and y on its plate (mm), and whether it is turned by 90 degrees."""

    plate: int
    x: float
    y: float
    turned: bool


def packed(rectangles: Sequence[tuple[float, float]], bed: tuple[float, float], gap: float) -> list[Place]:
    """A place for each rectangle (x, y in mm), at least ``gap`` apart.

    Raises ValueError if one is larger than the bed.
    """
    room = np.array(bed) + gap + len(rectangles) * DISTINCT
    sizes = np.array(rectangles, dtype=float).reshape(-1, 2) + gap
    sizes += DISTINCT * np.arange(len(sizes))[::-1, None]
    places: dict[int, Place] = {}
    waiting, plate = np.arange(len(sizes)), 0
    while len(waiting):
        bounds, taken = _fullest(sizes[waiting], room)
        if not taken.any():
            x, y = rectangles[int(waiting[0])]
            raise ValueError(f"a rectangle of {x:g} x {y:g} mm is larger than the bed of {bed[0]:g} x {bed[1]:g} mm")
        for index, ((x0, y0), (x1, y1)) in zip(waiting[taken].tolist(), bounds.tolist(), strict=True):
            as_it_is, across = sizes[index], np.array([x1 - x0, y1 - y0])
            turned = float(np.abs(across - as_it_is).max()) > float(np.abs(across - as_it_is[::-1]).max())
            places[index] = Place(plate, x0, y0, turned)
        waiting, plate = waiting[~taken], plate + 1
    return [places[index] for index in range(len(sizes))]


def _fullest(sizes: np.ndarray, room: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bounds (m, 2, 2) of the rectangles that the fullest of several orders puts on a plate, and which these are."""
    from trimesh.path.packing import rectangles_single

    random, areas = np.random.default_rng(0), np.prod(sizes, axis=1)
    best = rectangles_single(sizes, size=room)
    for _ in range(ORDERS):
        if best[1].all():
            break
        other = rectangles_single(sizes, size=room, shuffle=True, random=random)
        best = max(best, other, key=lambda choice: float(areas[choice[1]].sum()))
    return best
