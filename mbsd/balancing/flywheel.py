"""The flywheel that keeps a crank's speed even.

    dE = max - min over a cycle of the integral of (T - mean T) dphi           fluctuation of energy (J)
    I  = dE / (delta omega^2),   delta = (omega_max - omega_min) / omega       wanted, omega the mean speed

T is the effort that the driver gives at constant speed; the load takes its mean. Source: Norton, Design of Machinery,
ch. 11 (controlling input torque: flywheels).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import cumulative_simpson

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting


@dataclass(frozen=True)
class Flywheel(Suggesting):
    """Inertia that a crank needs besides its own."""

    inertia: float
    """kg m^2 on the driven body."""
    energy: float
    """Fluctuation of energy over the cycle (J)."""
    speed: float
    """Mean (rad/s)."""


def flywheel(sol: Any, driver: str, fluctuation: float) -> Flywheel:
    """The flywheel with which the speed of ``driver`` fluctuates by the part ``fluctuation`` of its mean.

    ``sol`` is a sweep over whole cycles at constant speed. Raises ModelError for a driver that does not turn evenly,
    and for a fluctuation that is not above 0.
    """
    name = sol.mechanism.name
    part = finite_number(f"{name}: flywheel: fluctuation", fluctuation)
    if part <= 0:
        raise ModelError(f"{name}: flywheel: fluctuation is {part:g}; it must be above 0, such as 0.02")
    view = sol.driver(driver)
    speed = float(view.rate.mean())
    if not view.angular or speed == 0.0 or np.ptp(view.rate) > 1e-6 * abs(speed):
        raise ModelError(
            f"{name}: flywheel: the driver '{driver}' must turn at a constant rate; sweep with constant_rate(...)"
        )
    spun = np.abs(view.value - view.value[0])
    effort = np.sign(speed) * view.effort
    mean = np.trapezoid(effort, spun) / spun[-1]
    swing = float(np.ptp(_integral(effort - mean, spun)))
    return Flywheel(swing / (part * speed**2), swing, abs(speed))


def _integral(values: np.ndarray, x: np.ndarray) -> np.ndarray:
    """(T,) from the start on, by Simpson's rule between jumps, where two rows share their x."""
    out = np.zeros(len(x))
    bounds = [0, *(np.flatnonzero(np.diff(x) <= 0) + 1), len(x)]
    for low, high in pairwise(bounds):
        before = out[low - 1] if low else 0.0
        out[low:high] = before + cumulative_simpson(values[low:high], x=x[low:high], initial=0.0)
    return out
