"""Open curves go on straight beyond their ends; how far along a curve a point that follows it comes.

The straight continuations begin with the exact tangents of the curve: chords would lead away from the model's lines.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicSpline

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mbsd.model.body import Marker

WINDOW = 3.0
"""A point's foot goes on by so many of its own steps at most, and by as many of the curve's."""
BESIDE = 3.0
"""Branches of a curve this near to a point (steps of the curve, more than the nearest one) may be the one it is on."""


def end_ways(points: Sequence[Sequence[float]], marker: Marker) -> np.ndarray:
    """(2, 2) unit vectors out of the first and out of the last end of the open curve through ``points``, in the axes
    of the marker's body.
    """
    from mbsd.model import plane_curves

    ways = plane_curves.end_ways(*plane_curves.curve_pieces(np.array(points, dtype=float), False))
    c, s = math.cos(marker.angle), math.sin(marker.angle)
    return ways @ np.array([[c, s], [-s, c]])


def continued(path: np.ndarray, ways: np.ndarray, ahead: float, step: float) -> tuple[np.ndarray, int]:
    """A path (n, 2) with straight lines ``ahead`` long beyond both ends, at places every ``step``; and how many places
    lie before it. ``ways``: as of :func:`end_ways`.
    """
    count = int(ahead / step) + 2
    along = step * np.arange(1, count + 1)[:, None]
    return np.vstack([path[0] + along[::-1] * ways[0], path, path[-1] + along * ways[1]]), count


def followed(path: np.ndarray, seen: np.ndarray, closed: bool) -> np.ndarray:
    """(T,) numbers of the places of a path (n, 2) that a point at ``seen`` (T, 2) is nearest to, on the branch that it
    follows. Round a closed path, whose last place is its first, the numbers go on.

    Where a path crosses itself the nearest place may be one of the other branch.
    """
    step = float(np.hypot(*np.diff(path, axis=0).T).max())
    away = np.hypot(*(path - seen[0]).T)
    near = away < away.min() + BESIDE * step
    starts = [int(block[np.argmin(away[block])]) for block in _runs(np.flatnonzero(near))]
    tries = [_followed_from(start, path, seen, closed, step) for start in starts]
    count = len(path) - 1 if closed else len(path)
    off = [float(((path[numbers % count] - seen) ** 2).sum()) for numbers in tries]
    return tries[int(np.argmin(off))]


def evenly(path: np.ndarray, count: int) -> np.ndarray:
    """(count, 2) places on the spline through a path, with nearly the same way from each to the next.

    Chords would take from the pin's clearance where the curve bends.
    """
    steps = np.hypot(*np.diff(path, axis=0).T)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    apart = np.concatenate([[True], steps > 0.0])
    return CubicSpline(way[apart], path[apart])(np.linspace(0.0, way[-1], count))


def _runs(numbers: np.ndarray) -> list[np.ndarray]:
    """Split where neighbours are missing."""
    return np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1)


def _followed_from(start: int, path: np.ndarray, seen: np.ndarray, closed: bool, step: float) -> np.ndarray:
    count = len(path) - 1 if closed else len(path)
    moves = np.hypot(*np.diff(seen, axis=0, prepend=seen[:1]).T)
    at, indices = start, np.zeros(len(seen), dtype=int)
    for k, (place, move) in enumerate(zip(seen, moves, strict=True)):
        reach = min(int(WINDOW * (move / step + 1.0)), count // 2)
        near = np.arange(at - reach, at + reach + 1)
        near = near if closed else near[(near >= 0) & (near < count)]
        at = int(near[np.argmin(((path[near % count] - place) ** 2).sum(axis=1))])
        indices[k] = at
    return indices
