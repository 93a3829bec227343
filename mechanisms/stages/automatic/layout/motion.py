"""The poses of all bodies over the motion, close enough to each other to look for collisions in the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd import Solution

POSES = 1000
"""About so many poses are looked at."""


def poses_of(solution: Solution, to_length: float) -> dict[str, np.ndarray]:
    """(T, 3) x, y (m times ``to_length``) and theta (rad) of every body's frame, ground included.

    Between outputs they follow the cubic through places and velocities, except where a jump makes two times equal.
    """
    t = solution.t
    parts = max(1, round(POSES / max(len(t), 1)))
    found = {}
    for name in solution.mechanism.bodies:
        if name == "ground":
            continue
        body = solution.body(name)
        pose = np.column_stack([body.x, body.y, body.theta])
        rate = np.column_stack([body.vx, body.vy, body.omega])
        fine = _between(t, pose, rate, parts)
        fine[:, :2] *= to_length
        found[name] = fine
    count = len(next(iter(found.values()))) if found else 1
    found["ground"] = np.zeros((count, 3))
    return found


def times_of(solution: Solution) -> np.ndarray:
    """(T,) the times (s) of :func:`poses_of`."""
    t = solution.t
    parts = max(1, round(POSES / max(len(t), 1)))
    return _between(t, t[:, None], np.ones((len(t), 1)), parts)[:, 0]


def _between(t: np.ndarray, value: np.ndarray, rate: np.ndarray, parts: int) -> np.ndarray:
    """Hermite's cubic at ``parts`` places of every step, and the last value."""
    if len(t) < 2 or parts == 1:
        return value.astype(float).copy()
    u = (np.arange(parts) / parts)[None, :, None]
    step = np.diff(t)[:, None, None]
    p, q, v, w = value[:-1, None], value[1:, None], rate[:-1, None] * step, rate[1:, None] * step
    shape = (2 * u**3 - 3 * u**2 + 1) * p + (u**3 - 2 * u**2 + u) * v + (3 * u**2 - 2 * u**3) * q + (u**3 - u**2) * w
    return np.concatenate([shape.reshape(-1, value.shape[1]), value[-1:]])
