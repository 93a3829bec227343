"""The poses of all bodies over the motion, close enough to each other to look for collisions in the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd import Solution

POSES = 1000
"""About so many poses are looked at."""
TURN, MOST = 0.05, 60
"""And more where a body turns by more than this (rad) from one to the next; at most so many in a step."""


def poses_of(solution: Solution, to_length: float) -> dict[str, np.ndarray]:
    """(T, 3) x, y (m times ``to_length``) and theta (rad) of every body's frame, ground included.

    Between outputs they follow the cubic through places and velocities, except where a jump makes two times equal.
    """
    t, parts = solution.t, _parts(solution)
    poses = {}
    for name in solution.mechanism.bodies:
        if name == "ground":
            continue
        body = solution.body(name)
        pose = np.column_stack([body.x, body.y, body.theta])
        rate = np.column_stack([body.vx, body.vy, body.omega])
        fine = _between(t, pose, rate, parts)
        fine[:, :2] *= to_length
        poses[name] = fine
    count = len(next(iter(poses.values()))) if poses else 1
    poses["ground"] = np.zeros((count, 3))
    return poses


def times_of(solution: Solution) -> np.ndarray:
    """(T,) the times (s) of :func:`poses_of`."""
    t = solution.t
    return _between(t, t[:, None], np.ones((len(t), 1)), _parts(solution))[:, 0]


def _parts(solution: Solution) -> np.ndarray:
    """(n,) how many poses of each step are looked at: more where a body turns far in it."""
    counts = np.full(len(solution.t) - 1, max(1, round(POSES / max(len(solution.t), 1))))
    for name in solution.mechanism.bodies:
        if name != "ground":
            turned = np.abs(np.diff(solution.body(name).theta)) / TURN
            counts = np.maximum(counts, np.minimum(np.ceil(turned), MOST).astype(int))
    return counts


def _between(t: np.ndarray, value: np.ndarray, rate: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Hermite's cubic at ``parts`` places of every step, and the last value."""
    if len(t) < 2 or (parts == 1).all():
        return value.astype(float).copy()
    at = np.repeat(np.arange(len(parts)), parts)
    u = ((np.arange(len(at)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[at])[:, None]
    step = np.diff(t)[:, None]
    p, q, v, w = value[:-1][at], value[1:][at], (rate[:-1] * step)[at], (rate[1:] * step)[at]
    shape = (2 * u**3 - 3 * u**2 + 1) * p + (u**3 - 2 * u**2 + u) * v + (3 * u**2 - 2 * u**3) * q + (u**3 - u**2) * w
    return np.concatenate([shape, value[-1:]])
