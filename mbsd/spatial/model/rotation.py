"""Rotations: Euler parameters (w, x, y, z) and matrices from body to world, frames from axes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

PARALLEL = 1e-6
"""Sine of the angle below which two directions count as parallel."""


def rotation_matrix(e: Sequence[float] | np.ndarray) -> np.ndarray:
    """Return (..., 3, 3) rotations of Euler parameters (..., 4) of any length."""
    w, x, y, z = np.moveaxis(np.asarray(e, float), -1, 0)
    n = w * w + x * x + y * y + z * z
    rows = [
        [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2) / n[..., None, None]


def euler_parameters(rotation: np.ndarray) -> np.ndarray:
    """Return unit (4,) of a rotation (3, 3), with a positive largest entry."""
    m = rotation
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    squares = np.array([trace, m[0, 0], m[1, 1], m[2, 2]])
    k = int(np.argmax(squares))
    if k == 0:
        out = np.array([1 + trace, m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    else:
        i, j, n = k - 1, k % 3, (k + 1) % 3
        out = np.zeros(4)
        out[0] = m[n, j] - m[j, n]
        out[1 + i] = 1 + 2 * m[i, i] - trace
        out[1 + j] = m[j, i] + m[i, j]
        out[1 + n] = m[n, i] + m[i, n]
    return out / np.linalg.norm(out)


def product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the products (..., 4) of Euler parameters: first the rotation b, then a."""
    aw, av, bw, bv = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    vector = aw * bv + bw * av + np.cross(av, bv)
    return np.concatenate([aw * bw - (av * bv).sum(axis=-1, keepdims=True), vector], axis=-1)


def across(axis: np.ndarray) -> np.ndarray:
    """Return a unit vector (3,) normal to a unit ``axis``: a world axis as far as it goes."""
    start = np.eye(3)[int(np.argmin(np.abs(np.round(axis, 9))))]
    normal = start - (start @ axis) * axis
    return normal / np.linalg.norm(normal)


def frame(axis: np.ndarray, x: np.ndarray | None = None) -> np.ndarray:
    """Return axes (3, 3) by column: z is the unit ``axis``, x is nearest to ``x``."""
    first = across(axis) if x is None else x - (x @ axis) * axis
    first = first / np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])


def carried(axis: np.ndarray, onto: np.ndarray) -> np.ndarray:
    """Return the shortest rotation (3, 3) that turns a unit vector onto another, not opposite one."""
    cross = np.cross(axis, onto)
    skew = np.array([[0, -cross[2], cross[1]], [cross[2], 0, -cross[0]], [-cross[1], cross[0], 0]])
    return np.eye(3) + skew + skew @ skew / (1.0 + axis @ onto)


def angle_between(a: np.ndarray, b: np.ndarray) -> float:
    """Return the angle (rad, 0 .. pi) between two directions (3,)."""
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))
