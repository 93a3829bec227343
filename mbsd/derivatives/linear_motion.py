"""Linear equations of motion along nodes, y' = A(t) y + B(t), by collocation.

Lobatto IIIA with three stages, of fourth order: a step has its nodes at both ends and in the middle, where A and B are
known already. Five nodes make two steps, which are also one of double length; the difference of both tells the error,
and a fifteenth of it, added, makes the result one of sixth order. Source: Hairer, Wanner, Solving ODEs II, IV.5.
"""

from __future__ import annotations

import numpy as np

NODES = 4
"""Nodes of a double step, without its end."""


def carried(
    t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray, slight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """y (4 d + 1, k, c) at nodes t (s) of d double steps from ``begun`` (k, c), and the error that each adds, (d,).

    a (4 d + 1, k, k), b (4 d + 1, k, c). Errors are parts of the largest y, or of ``slight`` (k, c) if that is more.
    """
    k = a.shape[1]
    inner, ends = _steps(t, a, b)
    coarse = _steps(t[::2], a[::2], b[::2])[1]
    out = np.zeros((len(t), k, begun.shape[1]))
    out[0] = y = begun
    gaps = np.zeros((len(coarse), k, begun.shape[1]))
    for d in range(len(coarse)):
        half = ends[2 * d, :, :k] @ y + ends[2 * d, :, k:]
        fine = ends[2 * d + 1, :, :k] @ half + ends[2 * d + 1, :, k:]
        gaps[d] = (fine - coarse[d, :, :k] @ y - coarse[d, :, k:]) / 15.0
        out[NODES * d + 2] = half + 0.5 * gaps[d]
        out[NODES * d + 4] = y = fine + gaps[d]
    out[1::2] = inner[:, :, :k] @ out[:-2:2] + inner[:, :, k:]
    return out, (np.abs(gaps) / np.maximum(np.abs(out).max(axis=0), slight)).max(axis=(1, 2), initial=0.0)


def _steps(t: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What makes the middle and the end of every step of its start: (s, k, k + c), a matrix and what is added."""
    k = a.shape[1]
    h = (t[2::2] - t[:-2:2])[:, None, None]
    a0, a1, a2 = a[:-2:2], a[1::2], a[2::2]
    b0, b1, b2 = b[:-2:2], b[1::2], b[2::2]
    eye = np.broadcast_to(np.eye(k), a0.shape)
    rows = (
        np.concatenate([eye - h / 3 * a1, h / 24 * a2], axis=2),
        np.concatenate([-2 * h / 3 * a1, eye - h / 6 * a2], axis=2),
    )
    sides = (
        np.concatenate([eye + 5 * h / 24 * a0, 5 * h / 24 * b0 + h / 3 * b1 - h / 24 * b2], axis=2),
        np.concatenate([eye + h / 6 * a0, h / 6 * b0 + 2 * h / 3 * b1 + h / 6 * b2], axis=2),
    )
    solved = np.linalg.solve(np.concatenate(rows, axis=1), np.concatenate(sides, axis=1))
    return solved[:, :k], solved[:, k:]
