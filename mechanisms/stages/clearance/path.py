"""The motion between the samples of data.json, as the film shows it, with bounds of its rates.

Positions, rates and accelerations at both ends of an interval fix one quintic in each coordinate. As Bezier curves they
lie within the hull of their control points, and so do their derivatives: that bounds speed and acceleration in between.
Two samples at the same time (right before and after an event) bound no interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from shared.contract import Motion
from shared.shapes.units import mm

DIFFERENCE = 0.625
"""Largest value of the two middle Bernstein polynomials of degree five together."""
JUMP = 3.0
"""A jump of velocity inside an interval moves the true path by at most this times the cubic's from the quintic."""


@dataclass(frozen=True)
class BodyPath:
    """One body over time: (n, 3) x, y (mm), theta (rad), their rates and accelerations (per s)."""

    time: np.ndarray
    pose: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray

    @cached_property
    def first(self) -> np.ndarray:
        """(m,): the sample at which each interval begins."""
        return np.flatnonzero(np.diff(self.time) > 0)

    @cached_property
    def start(self) -> np.ndarray:
        """(m,): when each interval begins (s)."""
        return self.time[self.first]

    @cached_property
    def width(self) -> np.ndarray:
        """(m,): how long each interval is (s)."""
        return self.time[self.first + 1] - self.start

    @cached_property
    def control(self) -> np.ndarray:
        """(m, 6, 3): the control points of each interval's quintic."""
        k, h = self.first, self.width[:, None]
        x0, v0, a0 = self.pose[k], self.rate[k] * h, self.acceleration[k] * h**2
        x1, v1, a1 = self.pose[k + 1], self.rate[k + 1] * h, self.acceleration[k + 1] * h**2
        inner = (x0 + v0 / 5, x0 + 0.4 * v0 + a0 / 20, x1 - 0.4 * v1 + a1 / 20, x1 - v1 / 5)
        return np.stack([x0, *inner, x1], axis=1)

    @cached_property
    def turning(self) -> tuple[np.ndarray, np.ndarray]:
        """Bounds (m,) of the angular velocity (rad/s) and acceleration (rad/s^2) in each interval."""
        angle = self.control[:, :, 2:]
        return _largest(angle, self.width, 1), _largest(angle, self.width, 2)

    def interval(self, time: np.ndarray) -> np.ndarray:
        """(m,): the interval in which each time lies; of two that meet there, the later."""
        return np.clip(np.searchsorted(self.start, time, side="right") - 1, 0, len(self.start) - 1)

    def within(self, k: np.ndarray, time: np.ndarray) -> np.ndarray:
        """(m, 3) poses at times that lie in the intervals ``k``."""
        u = ((time - self.start[k]) / self.width[k])[:, None]
        point = self.control[k]
        while point.shape[1] > 1:  # de Casteljau
            point = point[:, :-1] + u[:, :, None] * (point[:, 1:] - point[:, :-1])
        return point[:, 0]

    def at(self, time: np.ndarray) -> np.ndarray:
        """(m, 3) poses at any times."""
        return self.within(self.interval(time), time)

    @cached_property
    def error(self) -> tuple[np.ndarray, np.ndarray]:
        """Estimates (m,) of how far the true motion may be from each quintic: places (mm), angle (rad).

        Three times the difference between the quintic and the cubic that leaves the accelerations out. Smooth motion
        is nearer by orders of magnitude; a jump of velocity inside the interval, which the samples do not show, is
        just covered.
        """
        k, h = self.first, self.width[:, None]
        x0, x1 = self.pose[k], self.pose[k + 1]
        c1, c2 = x0 + self.rate[k] * h / 3, x1 - self.rate[k + 1] * h / 3
        off = np.stack(
            [self.control[:, 2] - (x0 + 6 * c1 + 3 * c2) / 10, self.control[:, 3] - (3 * c1 + 6 * c2 + x1) / 10]
        )
        largest = JUMP * DIFFERENCE * np.stack([np.hypot(*np.moveaxis(off[:, :, :2], -1, 0)), np.abs(off[:, :, 2])])
        return largest[0].max(axis=0), largest[1].max(axis=0)

    def interpolation_error(self, reach: float) -> np.ndarray:
        """(m,): the same for a point ``reach`` mm from the origin (mm)."""
        return self.error[0] + reach * self.error[1]


def paths(motion: Motion) -> dict[str, BodyPath]:
    """The path of every body, ``ground`` included."""
    time = np.array(motion.time)
    still = np.zeros((len(time), 3))
    by_body = {"ground": BodyPath(time, still, still, still)}
    for name, body in motion.bodies.items():
        series = ((body.x, body.y, body.theta), (body.vx, body.vy, body.omega), (body.ax, body.ay, body.alpha))
        columns = [np.column_stack([np.array(x) * mm(1), np.array(y) * mm(1), turn]) for x, y, turn in series]
        by_body[name] = BodyPath(time, *columns)
    return by_body


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


class RelativePath:
    """A body seen from another: its pose at any time, and bounds of the acceleration of its points."""

    def __init__(self, mover: BodyPath, still: BodyPath, centre: np.ndarray, error: np.ndarray) -> None:
        """``centre`` (2,): the point of the mover that it is followed by (mm, the mover's frame).

        ``error`` (m,): how far the motion may be off in each interval (mm).
        """
        self.mover, self.still, self.centre, self.error = mover, still, centre, error
        away = float(np.hypot(*centre))
        gap = mover.control - still.control
        h = mover.width
        turn = (_largest(gap[:, :, 2:], h, 1), _largest(gap[:, :, 2:], h, 2))
        own, frame = mover.turning, still.turning
        speed = _largest(gap[:, :, :2], h, 1) + own[0] * away
        acceleration = _largest(gap[:, :, :2], h, 2) + (own[1] + own[0] ** 2) * away
        ends = [np.hypot(*points(m.pose[m.first + k], centre).T - s.pose[s.first + k, :2].T) for k in (0, 1)
                for m, s in ((mover, still),)]  # fmt: skip
        distance = np.maximum(*ends) + speed * h / 2
        self.push = acceleration + 2 * frame[0] * speed + (frame[1] + frame[0] ** 2) * distance
        """(m,): the centre's acceleration in the other's frame is at most this in each interval (mm/s^2)."""
        self.spin = turn[1] + turn[0] ** 2
        """(m,): every mm between a point and the centre adds this to its acceleration (1/s^2)."""

    def place(self, k: np.ndarray, time: np.ndarray) -> np.ndarray:
        """(n, 3): the centre's place (mm) and the angle (rad) in the other's frame, at times in intervals ``k``."""
        pose = self.mover.within(k, time)
        pose[:, :2] = points(pose, self.centre)
        return relative(pose, self.still.within(k, time))

    def bend(self, radius: float) -> float:
        """How far (mm) points within ``radius`` of the centre stray from straight lines in the intervals, in all."""
        return float((self.mover.width**2 / 8 * (self.push + radius * self.spin)).sum())


def _largest(control: np.ndarray, width: np.ndarray, order: int) -> np.ndarray:
    """(m,): a bound of a derivative's norm in each interval, from control points (m, 6, d)."""
    factor = {1: 5.0, 2: 20.0}[order] / width**order
    return factor * np.linalg.norm(np.diff(control, n=order, axis=1), axis=2).max(axis=1)
