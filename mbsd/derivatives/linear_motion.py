"""Linear equations of motion along nodes, y' = A(t) y + B(t), by collocation.

Lobatto IIIA with three stages, of fourth order: a step has its nodes at both ends and in the middle, where A and B are
known already. Two steps are also one step of double length, whose nodes are known as well; the difference of both tells
the error, and a fifteenth of it makes the sixth-order result. Source: Hairer, Wanner, Solving ODEs II, IV.5.
"""

from __future__ import annotations

import numpy as np


def carried(t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray) -> tuple[np.ndarray, float]:
    """y (N, k, c) at nodes t (N,) (s), N odd, from ``begun`` (k, c), and the largest error as part of the largest y.

    a (N, k, k), b (N, k, c); every second node is the middle of a step.
    """
    fine = _steps(t, a, b, begun)
    steps = np.diff(t[::2])
    paired = len(steps) % 2 == 0 and len(steps) >= 2 and np.allclose(steps[::2], steps[1::2], rtol=1e-6)
    if not paired:
        return fine, 0.0
    coarse = _steps(t[::2], a[::2], b[::2], begun)
    gap = (fine[::4] - coarse[::2]) / 15.0
    largest = np.abs(fine).max(axis=0)
    error = float((np.abs(gap).max(axis=0) / np.where(largest > 0.0, largest, 1.0)).max(initial=0.0))
    at, inner = t[::4], fine.copy()
    for row in np.ndindex(fine.shape[1:]):
        inner[(slice(None), *row)] += np.interp(t, at, gap[(slice(None), *row)])
    return inner, error


def _steps(t: np.ndarray, a: np.ndarray, b: np.ndarray, begun: np.ndarray) -> np.ndarray:
    """The same without error."""
    k = a.shape[1]
    h = (t[2::2] - t[:-2:2])[:, None, None]
    a0, a1, a2 = a[:-2:2], a[1::2], a[2::2]
    b0, b1, b2 = b[:-2:2], b[1::2], b[2::2]
    one = np.broadcast_to(np.eye(k), a0.shape)
    matrix = np.concatenate(
        [
            np.concatenate([one - h / 3 * a1, h / 24 * a2], axis=2),
            np.concatenate([-2 * h / 3 * a1, one - h / 6 * a2], axis=2),
        ],
        axis=1,
    )
    right = np.concatenate(
        [
            np.concatenate([one + 5 * h / 24 * a0, 5 * h / 24 * b0 + h / 3 * b1 - h / 24 * b2], axis=2),
            np.concatenate([one + h / 6 * a0, h / 6 * b0 + 2 * h / 3 * b1 + h / 6 * b2], axis=2),
        ],
        axis=1,
    )
    solved = np.linalg.solve(matrix, right)
    out = np.zeros((len(t), k, begun.shape[1]))
    out[0] = begun
    for step in range(len(h)):
        out[2 * step + 2] = solved[step, k:, :k] @ out[2 * step] + solved[step, k:, k:]
    out[1::2] = solved[:, :k, :k] @ out[:-2:2] + solved[:, :k, k:]
    return out
