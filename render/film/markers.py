"""Markers of bodies along a motion."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from shared.contract import BodyMotion, Motion

Array = NDArray[np.float64]


def moved(motion: Motion, body: str, marker: tuple[float, float, float]) -> tuple[Array, Array]:
    """Where a marker (x, y, angle) of a body is (T, 2), and its angle (T,), at the times of data.json (m, rad)."""
    x, y, turn = marker
    count = len(motion.time)
    if body not in motion.bodies:
        return np.tile([x, y], (count, 1)), np.full(count, turn)
    frame = motion.bodies[body]
    theta = np.asarray(frame.theta)
    c, s = np.cos(theta), np.sin(theta)
    return np.stack([np.asarray(frame.x) + c * x - s * y, np.asarray(frame.y) + s * x + c * y], axis=1), theta + turn


def local_place(body: BodyMotion, x: float, y: float) -> tuple[float, float]:
    """A place of the world at the first time, in the body's frame (m)."""
    dx, dy, c, s = x - body.x[0], y - body.y[0], math.cos(body.theta[0]), math.sin(body.theta[0])
    return c * dx + s * dy, c * dy - s * dx
