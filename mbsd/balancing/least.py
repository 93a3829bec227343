"""Plane vectors u_k that minimise b + sum_k C_k (u_x, u_y, |u|)_k, each no longer than its bound.

Least in the mean square: by linear least squares where lengths play no part and no bound is reached, else by SLSQP on
the normal equations. Least at its peak: the least t with |row_i|^2 <= t^2 at every time i, by SLSQP from there.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy.optimize import minimize

CLOSE = 1e-12
"""Part of the largest number that is nothing."""
TURNS = 8
"""Directions in which a search starts for each vector, beside the solution without lengths."""
MOST_STARTS = 12


def least_mean_square(b: np.ndarray, columns: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """(K, 2) u for rows b (n,), columns (n, K, 3) and bounds (K,) on the lengths."""
    linear, lengths = columns[:, :, :2].reshape(len(b), -1), columns[:, :, 2]
    scale = np.abs(linear).max(initial=0.0)
    free = np.linalg.lstsq(linear, -b, rcond=None)[0].reshape(-1, 2)
    inside = (np.hypot(*free.T) <= bounds).all()
    if inside and np.abs(lengths).max(initial=0.0) <= CLOSE * scale:
        return free
    gram, pull = _normal(columns, b)
    size = _sizes(free, bounds)
    best, least = np.zeros_like(free), np.inf
    for start in _starts(free, bounds):
        minimum = minimize(
            lambda x: _square(x.reshape(-1, 2) * size, gram, pull),
            (start / size).ravel(),
            jac=lambda x: _slope(x.reshape(-1, 2) * size, gram, pull, size),
            constraints=_within(bounds, size),
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 200},
        )
        if minimum.fun < least:
            best, least = minimum.x.reshape(-1, 2) * size, minimum.fun
    return best


def least_peak(
    b: np.ndarray, columns: np.ndarray, bounds: np.ndarray, width: np.ndarray, start: np.ndarray
) -> np.ndarray:
    """Return the vectors that minimise the largest of the groups of rows.

    ``width`` (n,) numbers their groups; the rest is as in :func:`least_mean_square`.
    """
    size = _sizes(start, bounds)
    groups = int(width.max()) + 1

    def rows(x: np.ndarray) -> np.ndarray:
        return b + np.einsum("nkc,kc->n", columns, _with_lengths(x[:-1].reshape(-1, 2) * size))

    def margin(x: np.ndarray) -> np.ndarray:
        return x[-1] ** 2 - np.bincount(width, rows(x) ** 2, groups)

    def margin_slope(x: np.ndarray) -> np.ndarray:
        u = x[:-1].reshape(-1, 2) * size
        by_u = _by_u(columns, u) * size[:, :1]
        each = 2.0 * rows(x)[:, None] * by_u.reshape(len(b), -1)
        out = np.zeros((groups, each.shape[1] + 1))
        np.add.at(out[:, :-1], width, -each)
        out[:, -1] = 2.0 * x[-1]
        return out

    first = np.append((start / size).ravel(), 0.0)
    first[-1] = np.sqrt(np.bincount(width, rows(first) ** 2, groups).max())
    limits = [
        {
            "type": "ineq",
            "fun": lambda x, bound=bound: bound["fun"](x[:-1]),
            "jac": lambda x, bound=bound: np.append(bound["jac"](x[:-1]), 0.0),
        }
        for bound in _within(bounds, size)
    ]
    minimum = minimize(
        lambda x: x[-1], first, jac=lambda x: np.append(np.zeros(len(x) - 1), 1.0),
        constraints=[{"type": "ineq", "fun": margin, "jac": margin_slope}, *limits],
        method="SLSQP", options={"ftol": 1e-12, "maxiter": 500},
    )  # fmt: skip
    u = minimum.x[:-1].reshape(-1, 2) * size
    peaks = [np.bincount(width, rows(np.append((v / size).ravel(), 0.0)) ** 2, groups).max() for v in (u, start)]
    inside = (np.hypot(*u.T) <= bounds * (1 + 1e-9)).all()
    return u if inside and peaks[0] <= peaks[1] else start


def _with_lengths(u: np.ndarray) -> np.ndarray:
    return np.concatenate([u, np.hypot(*u.T)[:, None]], axis=1)


def _directions(u: np.ndarray) -> np.ndarray:
    """(K, 2) d|u|/du; 0 at u = 0."""
    length = np.hypot(*u.T)[:, None]
    return np.divide(u, length, out=np.zeros_like(u), where=length > 0)


def _by_u(columns: np.ndarray, u: np.ndarray) -> np.ndarray:
    """(n, K, 2) derivatives of the rows."""
    return columns[:, :, :2] + columns[:, :, 2:] * _directions(u)


def _normal(columns: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    flat = columns.reshape(len(b), -1)
    scale = max(float(b @ b), np.finfo(float).tiny)
    return flat.T @ flat / scale, flat.T @ b / scale


def _square(u: np.ndarray, gram: np.ndarray, pull: np.ndarray) -> float:
    w = _with_lengths(u).ravel()
    return float(w @ gram @ w + 2.0 * pull @ w)


def _slope(u: np.ndarray, gram: np.ndarray, pull: np.ndarray, size: np.ndarray) -> np.ndarray:
    by_w = (2.0 * (gram @ _with_lengths(u).ravel() + pull)).reshape(-1, 3)
    return ((by_w[:, :2] + by_w[:, 2:] * _directions(u)) * size).ravel()


def _sizes(u: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """(K, 1) what each vector is measured in, so that all unknowns are near 1."""
    length = np.hypot(*u.T)
    usual = float(length.max()) or 1.0
    return np.where(length > CLOSE * usual, np.minimum(length, bounds), np.minimum(usual, bounds))[:, None]


def _starts(free: np.ndarray, bounds: np.ndarray) -> list[np.ndarray]:
    """Return starts: the solution without lengths, cut to the bounds, and its sizes in other directions."""
    length = np.hypot(*free.T)
    clipped = free * np.minimum(1.0, bounds / np.maximum(length, np.finfo(float).tiny))[:, None]
    around = [np.array([np.cos(a), np.sin(a)]) for a in 2 * np.pi * np.arange(TURNS) / TURNS]
    size = _sizes(free, bounds)
    choices = itertools.islice(
        itertools.product(around, repeat=len(free)), 0, None, max(1, TURNS ** len(free) // MOST_STARTS)
    )
    return [clipped, *(0.5 * size * np.array(choice) for choice in choices)]


def _within(bounds: np.ndarray, size: np.ndarray) -> list[dict]:
    """No vector is longer than its bound."""
    out = []
    for k, bound in enumerate(bounds):
        if np.isfinite(bound):
            limit = (bound / size[k, 0]) ** 2

            def slope(x: np.ndarray, k: int = k) -> np.ndarray:
                full = np.zeros_like(x)
                full[2 * k : 2 * k + 2] = -2.0 * x[2 * k : 2 * k + 2]
                return full

            out.append({
                "type": "ineq", "jac": slope,
                "fun": lambda x, k=k, limit=limit: limit - x[2 * k] ** 2 - x[2 * k + 1] ** 2,
            })  # fmt: skip
    return out
