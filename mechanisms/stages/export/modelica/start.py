"""Where everything is at the first output, and how fast."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mechanisms.stages.export.tree import GROUND

Array = NDArray[np.float64]
STEP = 1e-30
"""Imaginary step (s) of derivatives: they are exact but for rounding (Squire and Trapp 1998)."""


@dataclass(frozen=True)
class Start:
    """Poses and rates of all bodies, ground too: x, y (m), theta (rad), and per second."""

    poses: Mapping[str, Array]
    rates: Mapping[str, Array]

    @classmethod
    def of(cls, solution: Any) -> Start:
        """Those of a solution's first output."""
        poses, rates = {GROUND: np.zeros(3)}, {GROUND: np.zeros(3)}
        for name in solution.mechanism.bodies:
            if name != GROUND:
                view = solution.body(name)
                poses[name] = np.array([view.x[0], view.y[0], view.theta[0]], float)
                rates[name] = np.array([view.vx[0], view.vy[0], view.omega[0]], float)
        return cls(poses, rates)

    def rate(self, value: Any) -> float:
        """How fast an analytic function of the poses changes."""
        return float(
            value({name: pose + 1j * STEP * self.rates[name] for name, pose in self.poses.items()}).imag / STEP
        )


def place(poses: Mapping[str, Array], marker: Any) -> Array:
    """(2,) where a marker is."""
    x, y, theta = poses[marker.body.name]
    c, s = np.cos(theta), np.sin(theta)
    return np.array([x + c * marker.x - s * marker.y, y + s * marker.x + c * marker.y])


def angle(poses: Mapping[str, Array], joint: Any) -> Any:
    """Angle of the second body against the first."""
    return poses[joint.j.body.name][2] - poses[joint.i.body.name][2]


def along(poses: Mapping[str, Array], joint: Any) -> Array:
    """(2,) the second marker in the axes of the first."""
    dx, dy = place(poses, joint.j) - place(poses, joint.i)
    turn = poses[joint.i.body.name][2] + joint.i.angle
    c, s = np.cos(turn), np.sin(turn)
    return np.array([c * dx + s * dy, c * dy - s * dx])
