"""How near the relative motion of two bodies is to ideal rolling: a circle of centres, turning in a fixed ratio."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mechanisms.stages.clearance.path import RelativePath

PARTS = 8
"""Each interval of data.json is looked at so many times."""


@dataclass(frozen=True)
class Rolling:
    """Seen from the first body, the centre of the second is at ``distance`` (mm) from a point of it in the direction
    phi (rad), and the second is turned by ``turn + ratio phi``. No point of it is farther from there than ``off`` (mm).
    """

    distance: float
    turn: float
    off: float
    times: np.ndarray
    angles: np.ndarray
    """(n,): phi at these times (s), not wrapped."""

    @property
    def start(self) -> float:
        """The first phi."""
        return float(self.angles[0])

    @property
    def span(self) -> float:
        """How far phi goes."""
        return float(np.ptp(self.angles))

    def time_of(self, angle: float, pitch: float) -> float:
        """The first time at which phi is ``angle`` or a number of pitches from it."""
        passed = np.floor((self.angles - angle) / pitch)
        k = int(np.flatnonzero(np.diff(passed) != 0)[0])
        low, high = self.angles[k], self.angles[k + 1]
        there = angle + pitch * max(passed[k], passed[k + 1])
        part = min(max((there - low) / (high - low), 0.0), 1.0)
        return float(self.times[k] + part * (self.times[k + 1] - self.times[k]))


def rolling(path: RelativePath, about: np.ndarray, ratio: float, reach: float) -> Rolling | None:
    """Ideal rolling about the point ``about`` (mm, frame of the first body) with that ratio, next to the motion.

    ``off`` holds for points within ``reach`` (mm) of the second body's centre and for all time: at PARTS times in
    each interval it is looked at, and between them a function is within h^2 / 8 max |f''| of the larger of its ends.
    None where the centre passes through ``about``, or samples jump.
    """
    mover = path.mover
    if len(mover.first) + 1 != len(mover.time):
        return None
    count = len(mover.first)
    k = np.repeat(np.arange(count), PARTS)
    time = np.append((mover.start[:, None] + mover.width[:, None] * np.arange(PARTS) / PARTS).ravel(), mover.time[-1])
    pose = path.place(np.append(k, count - 1), time)
    seen = pose[:, :2] - about
    distance = np.hypot(*seen.T)
    if distance.min() < 0.01 * distance.max():
        return None
    angle = np.unwrap(np.arctan2(seen[:, 1], seen[:, 0]))
    left = pose[:, 2] - ratio * angle
    middle, turn = (float(x.min() + x.max()) / 2 for x in (distance, left))
    h, push, spin = np.diff(time), path.push[k], path.spin[k]
    speed = np.hypot(*np.diff(seen, axis=0).T) / h + h / 2 * push
    least = np.minimum(distance[1:], distance[:-1]) - speed * h
    if least.min() <= 0:
        return None
    bend_distance = push + speed**2 / least
    bend_angle = push / least + 2 * speed**2 / least**2
    off = np.maximum(np.abs(distance[1:] - middle), np.abs(distance[:-1] - middle)) + h**2 / 8 * bend_distance
    turned = np.maximum(np.abs(left[1:] - turn), np.abs(left[:-1] - turn)) + h**2 / 8 * (spin + abs(ratio) * bend_angle)
    return Rolling(middle, turn, float((off + reach * turned).max()), time, angle)
