"""The horizontal axis: the driver's angle where one angle drives the mechanism one way, time otherwise."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

from shared.contract import Motion


@dataclass(frozen=True)
class Horizon:
    """Values of the horizontal axis and what they are called."""

    values: np.ndarray
    label: str
    degrees: bool

    def dress(self, axes: Axes) -> None:
        """Set limits, ticks and the label of the lowest axes."""
        axes.set_xlim(self.values[0], self.values[-1])
        axes.set_xlabel(self.label)
        if self.degrees:
            span = abs(float(self.values[-1] - self.values[0]))
            axes.xaxis.set_major_locator(MultipleLocator(_step(span)))


def horizon(motion: Motion) -> Horizon:
    """The driver's angle in degrees if there is one driver, it is an angle and it never turns back; else time in s.

    A driver that turns clockwise has angles that fall from left to right: what comes later is always at the right.
    """
    if len(motion.drivers) == 1:
        ((name, driver),) = motion.drivers.items()
        angle = np.degrees(driver.value)
        moves = np.diff(angle)[np.diff(motion.time) > 0]  # both rows of an event have the same angle
        if "angle" in driver.kind and (np.all(moves > 0) or np.all(moves < 0)):
            return Horizon(angle, f"{name} angle (deg{_pace(motion, angle)})", True)
    return Horizon(np.asarray(motion.time), "time (s)", False)


def _pace(motion: Motion, angle: np.ndarray) -> str:
    """How long a turn takes, of a driver that turns evenly."""
    even = np.interp(motion.time, [motion.time[0], motion.time[-1]], [angle[0], angle[-1]])
    if np.abs(angle - even).max() > 1e-6 * np.ptp(angle):
        return ""
    return f"; a turn takes {360 * (motion.time[-1] - motion.time[0]) / np.ptp(angle):.4g} s"


def _step(span: float) -> float:
    """Ticks in parts and multiples of a right angle, twelve at most."""
    for step in (5, 10, 15, 30, 45, 90, 180, 360):
        if span / step <= 12:
            return step
    return 360.0 * math.ceil(span / 360 / 12)
