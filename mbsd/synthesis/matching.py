"""How far a path is from given points: the nearest places on it, coarsely for many paths, exactly for few.

A path is sampled at equal times. Between the samples it is a chord for the search, and the polynomial of degree six
through seven samples for the final fit.
"""

from __future__ import annotations

import numpy as np

STENCIL = np.arange(-3, 4)
"""Samples about the nearest one, through which the polynomial runs."""
_POWERS = np.linalg.inv(STENCIL[:, None].astype(float) ** np.arange(7))
"""(7, 7) from samples to coefficients by rising powers."""
NEWTON_STEPS = 12


def nearest_on_chords(paths: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Squared distances (n, N) of points (N, 2) from paths (n, T, 2) of chords, and where: (n, N) as sample numbers."""
    ends = np.diff(paths, axis=1)[:, None]  # (n, 1, T - 1, 2)
    away = points[None, :, None] - paths[:, None, :-1]  # (n, N, T - 1, 2)
    square = np.maximum((ends**2).sum(-1), 1e-300)
    ahead = np.clip((away * ends).sum(-1) / square, 0.0, 1.0)
    distance = ((away - ahead[..., None] * ends) ** 2).sum(-1)
    best = distance.argmin(axis=2)
    take = best[..., None]
    return np.take_along_axis(distance, take, 2)[..., 0], best + np.take_along_axis(ahead, take, 2)[..., 0]


def at(path: np.ndarray, where: np.ndarray, closed: bool, order: int = 0) -> np.ndarray:
    """(N, 2) places of a path (T, 2), or derivatives per sample, at sample numbers ``where`` (N,), not whole."""
    middle, coefficients = _pieces(path, where, closed)
    return _value(coefficients, where - middle, order)


def feet(path: np.ndarray, points: np.ndarray, closed: bool) -> np.ndarray:
    """(N,) sample numbers at which a path (T, 2), closed or not, is nearest to points (N, 2)."""
    where = nearest_on_chords(path[None], points)[1][0]
    middle, coefficients = _pieces(path, where, closed)
    last = len(path) - 1.0
    for _ in range(NEWTON_STEPS):
        u = where - middle
        gap = _value(coefficients, u, 0) - points
        rate, bend = _value(coefficients, u, 1), _value(coefficients, u, 2)
        speed = (rate**2).sum(-1)
        slope = speed + (gap * bend).sum(-1)
        slope = np.where(slope > 0.1 * speed, slope, speed)
        step = np.clip((gap * rate).sum(-1) / np.maximum(slope, 1e-300), -1.0, 1.0)
        where = np.clip(where - step, middle - 2.0, middle + 2.0)
        if not closed:
            where = np.clip(where, 0.0, last)
    return where


def resampled(points: np.ndarray, closed: bool, count: int) -> np.ndarray:
    """(count, 2) points at equal distances along a polygon (N, 2)."""
    ring = np.vstack([points, points[:1]]) if closed else points
    length = np.append(0.0, np.cumsum(np.hypot(*np.diff(ring, axis=0).T)))
    at_lengths = np.linspace(0.0, length[-1], count, endpoint=not closed)
    return np.column_stack([np.interp(at_lengths, length, ring[:, axis]) for axis in (0, 1)])


def _pieces(path: np.ndarray, where: np.ndarray, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """The middle sample (N,) of each polynomial, and its coefficients (N, 7, 2)."""
    count = len(path) - 1
    middle = np.rint(where).astype(int)
    if closed:  # the last sample is the first again
        rows = (middle[:, None] + STENCIL) % count
    else:
        middle = np.clip(middle, 3, count - 3)
        rows = middle[:, None] + STENCIL
    return middle, np.einsum("ps,nsc->npc", _POWERS, path[rows])


def _value(coefficients: np.ndarray, u: np.ndarray, order: int) -> np.ndarray:
    powers = np.arange(7)
    factor = np.ones(7)
    for k in range(order):
        factor = factor * np.maximum(powers - k, 0)
    terms = factor * u[:, None] ** np.maximum(powers - order, 0)
    return np.einsum("np,npc->nc", terms, coefficients)
