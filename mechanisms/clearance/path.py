"""The motion between the samples of data.json, and how far a piece travels relative to another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shared.contract import Motion
from shared.shapes.units import mm

SUBSTEPS = 4
"""Points per interval of data.json at which travel is measured."""
TRAVEL_MARGIN = 1.01
"""Covers that the path between two of these points is longer than the straight line."""


@dataclass(frozen=True)
class BodyPath:
    """Pose of one body over time: (n, 3) x, y (mm), theta (rad), and its rates (per s)."""

    time: np.ndarray
    pose: np.ndarray
    rate: np.ndarray

    def at(self, time: np.ndarray) -> np.ndarray:
        """(m, 3) poses at any times: the cubic through the samples and their rates (Hermite)."""
        return _hermite(self.time, self.pose, self.rate, time)

    def interpolation_error(self, reach: float) -> float:
        """Estimate (mm) of the cubic's error at ``reach`` mm from the origin.

        Every second sample is left out and predicted from its neighbours; the error falls with the fourth power of
        the interval, so that of the full set is a sixteenth.
        """
        if len(self.time) < 3:
            return float("inf")
        keep = slice(None, None, 2)
        last = len(self.time) - 1 - (len(self.time) - 1) % 2
        skipped = np.arange(1, last, 2)
        guess = _hermite(self.time[keep], self.pose[keep], self.rate[keep], self.time[skipped])
        error = np.abs(guess - self.pose[skipped])
        return float((np.hypot(error[:, 0], error[:, 1]) + reach * error[:, 2]).max() / 16)


def paths(motion: Motion) -> dict[str, BodyPath]:
    """The path of every body, ``ground`` included."""
    time = np.array(motion.time)
    still = np.zeros((len(time), 3))
    found = {"ground": BodyPath(time, still, still)}
    for name, body in motion.bodies.items():
        pose = np.column_stack([np.array(body.x) * mm(1), np.array(body.y) * mm(1), body.theta])
        rate = np.column_stack([np.array(body.vx) * mm(1), np.array(body.vy) * mm(1), body.omega])
        found[name] = BodyPath(time, pose, rate)
    return found


def relative(pose: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(m, 3): poses seen from the frame of ``reference``."""
    c, s = np.cos(reference[:, 2]), np.sin(reference[:, 2])
    dx, dy = pose[:, 0] - reference[:, 0], pose[:, 1] - reference[:, 1]
    return np.column_stack([c * dx + s * dy, c * dy - s * dx, pose[:, 2] - reference[:, 2]])


def points(pose: np.ndarray, point: np.ndarray) -> np.ndarray:
    """(m, 2): where a point (2,) of a body is, at each pose."""
    c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
    x, y = point
    return np.column_stack([pose[:, 0] + c * x - s * y, pose[:, 1] + s * x + c * y])


def dense_times(time: np.ndarray) -> np.ndarray:
    """The samples, and points between them at which travel is measured."""
    return np.interp(np.arange(0, (len(time) - 1) * SUBSTEPS + 1) / SUBSTEPS, np.arange(len(time)), time)


def travelled(pose: np.ndarray, centre: np.ndarray, radius: float) -> np.ndarray:
    """(m,): from the first pose on, how far (mm) any point within ``radius`` of ``centre`` can have moved."""
    moved = np.linalg.norm(np.diff(points(pose, centre), axis=0), axis=1)
    turned = np.abs(np.diff(pose[:, 2]))
    return TRAVEL_MARGIN * np.concatenate([[0.0], np.cumsum(moved + radius * turned)])


def _hermite(time: np.ndarray, value: np.ndarray, rate: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    k = np.clip(np.searchsorted(time, wanted, side="right") - 1, 0, len(time) - 2)
    h = (time[k + 1] - time[k])[:, None]
    u = (wanted[:, None] - time[k][:, None]) / h
    return (
        (1 + 2 * u) * (1 - u) ** 2 * value[k]
        + u * (1 - u) ** 2 * h * rate[k]
        + u * u * (3 - 2 * u) * value[k + 1]
        + u * u * (u - 1) * h * rate[k + 1]
    )
