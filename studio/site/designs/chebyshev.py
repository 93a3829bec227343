"""Interpolation on a tensor grid of Chebyshev points.

With nodes x_j = cos(pi j / n), j = 0..n, of each axis, the barycentric form

    w_j = (-1)^j, halved at both ends;    p(x) = sum_j [w_j / (x - x_j)] f_j / sum_j [w_j / (x - x_j)]

is the polynomial of degree n through all f_j; its error falls geometrically with n where f is smooth (Berrut and
Trefethen, SIAM Review 46, 2004, eq. 4.2 and 5.4). The page has the same lines (page/src/designs/chebyshev.js).
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np


def nodes(low: float, high: float, count: int) -> np.ndarray:
    """Return the points between two ends, (count,), rising. ``count`` is at least 2."""
    cosines = np.cos(np.pi * np.arange(count - 1, -1, -1) / (count - 1))
    points = 0.5 * (low + high) + 0.5 * (high - low) * cosines
    points[[0, -1]] = low, high
    return points


def weights(x: float, points: np.ndarray) -> np.ndarray:
    """Return the weight of each node at ``x``, (count,); their sum is 1."""
    away = x - points
    if (hit := np.flatnonzero(away == 0)).size:
        return np.eye(len(points))[hit[0]]
    signs = (-1.0) ** np.arange(len(points))
    signs[[0, -1]] *= 0.5
    raw = signs / away
    return raw / raw.sum()


def tensor_weights(place: Sequence[float], axes: Sequence[np.ndarray]) -> np.ndarray:
    """Return the weight of each design of the grid, (product of counts,), the last axis fastest."""
    out = np.ones(1)
    for x, points in zip(place, axes, strict=True):
        out = np.multiply.outer(out, weights(x, points)).ravel()
    return out


def grid(axes: Sequence[np.ndarray]) -> list[tuple[float, ...]]:
    """Return all designs, the last axis running fastest."""
    return [tuple(map(float, place)) for place in itertools.product(*axes)]
