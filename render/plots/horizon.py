"""The horizontal axis: the driver's angle where one angle drives the mechanism one way, time otherwise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes

from render.plots.measures import dress_axis
from shared.contract import Motion
from shared.contract.quantity import written

TICKS = 9


@dataclass(frozen=True)
class Horizon:
    """Values of the horizontal axis, rising, and what they are called."""

    values: np.ndarray
    words: str
    unit: str
    """s or °"""
    note: str = ""
    """After the label."""
    margin: np.ndarray | None = None
    """(T,) how far each pose is from a singular one."""

    @property
    def degrees(self) -> bool:
        """Whether it is an angle."""
        return self.unit == "°"

    def dress(self, axes: Axes) -> None:
        """Set limits, ticks and the label of the lowest axes."""
        axes.set_xlim(self.values[0], self.values[-1])
        dress_axis(axes.xaxis, self.words, self.unit, TICKS)
        axes.set_xlabel(axes.get_xlabel() + self.note)


def horizon(motion: Motion) -> Horizon:
    """The driver's angle in degrees if there is one driver, it is an angle and it never turns back; else time in s.

    A driver that turns clockwise has its angle counted that way, so that what comes later is always at the right.
    """
    margin = np.asarray(motion.diagnostics.singularity_margin)
    if len(motion.drivers) == 1:
        ((name, driver),) = motion.drivers.items()
        angle = np.degrees(driver.value)
        moves = np.diff(angle)[np.diff(motion.time) > 0]  # both rows of an event have the same angle
        if driver.unit == "rad" and (np.all(moves > 0) or np.all(moves < 0)):
            clockwise = bool(np.all(moves < 0))
            angle = -angle if clockwise else angle
            angle = angle - 360.0 * round(float(angle[0]) / 360.0)
            words = f"{name} angle, clockwise" if clockwise else f"{name} angle"
            return Horizon(angle, words.replace("_", " "), "°", _pace(motion, angle), margin)
    return Horizon(np.asarray(motion.time), "time", "s", "", margin)


def _pace(motion: Motion, angle: np.ndarray) -> str:
    """How long a turn takes, of a driver that turns evenly."""
    even = np.interp(motion.time, [motion.time[0], motion.time[-1]], [angle[0], angle[-1]])
    if np.abs(angle - even).max() > 1e-6 * np.ptp(angle):
        return ""
    return f"; a turn takes {written(float(360 * (motion.time[-1] - motion.time[0]) / np.ptp(angle)), 's', 4)}"
