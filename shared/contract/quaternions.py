"""Rotations as unit quaternions (w, x, y, z), from body to world: products, matrices, and quaternions of matrices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def product(a: Array, b: Array) -> Array:
    """Return products (..., 4) of quaternions (w, x, y, z): first the rotation b, then a."""
    aw, av, bw, bv = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    vector = aw * bv + bw * av + np.cross(av, bv)
    return np.concatenate([aw * bw - (av * bv).sum(axis=-1, keepdims=True), vector], axis=-1)


def matrices(q: Array) -> Array:
    """Return rotations (..., 3, 3) of unit quaternions (..., 4), from body to world."""
    w, x, y, z = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def quaternion_of(rotation: Array) -> Array:
    """Return unit quaternions (n, 4) of rotations (n, 3, 3), their signs going on from one to the next."""
    m = rotation
    trace = m[:, 0, 0] + m[:, 1, 1] + m[:, 2, 2]
    squares = np.stack([trace, m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]], axis=1)
    out = np.zeros((len(m), 4))
    for row, k in enumerate(squares.argmax(axis=1)):
        r = m[row]
        if k == 0:
            out[row] = [1 + trace[row], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]
            continue
        i, j, n = k - 1, k % 3, (k + 1) % 3
        out[row, 0], out[row, 1 + i] = r[n, j] - r[j, n], 1 + 2 * r[i, i] - trace[row]
        out[row, 1 + j], out[row, 1 + n] = r[j, i] + r[i, j], r[n, i] + r[i, n]
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    flips = np.where((out[1:] * out[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    return out * np.cumprod(np.concatenate([[1.0], flips]))[:, None]
