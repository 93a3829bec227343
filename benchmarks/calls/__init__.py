"""Calls as users make them, over and over on a model made once: the whole call is timed, from names to results.

A crank-rocker (that of ``benchmarks.four_bar``) at 360 steps of one turn, again, and after a change of the motor's
speed; error: the worst angle of the rocker (rad). A rod of 1 m and 1 kg, released from the horizontal, for 10 s with
its motion at 1000 times or more; error: the largest drift of its energy (J).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.four_bar import exact, worst

SWEEP = "call of a sweep, four-bar, 360 steps, again"
CHANGED = "call of a sweep, four-bar, 360 steps, after a change of the motor"
SIMULATION = "call of a simulation, pendulum, 10 s, again"
BARS = {SWEEP: 2e-3, CHANGED: 1e-3, SIMULATION: 1e-3}
"""s that our calls take at most."""
STEPS = 360
LENGTH, MASS, GRAVITY, DURATION, OUTPUTS = 1.0, 1.0, 9.81, 10.0, 1000


@dataclass(frozen=True)
class Call:
    """``call`` is timed; ``error`` of what it returned is not."""

    problem: str
    settings: str
    call: Callable[[], Any]
    error: Callable[[Any], float]


def rocker_error(crank: np.ndarray, rocker: np.ndarray) -> float:
    """The worst of the rocker's angles (rad) at these angles of the crank (rad)."""
    return worst(rocker, exact(crank)[1])


def energy_drift(angle: np.ndarray, speed: np.ndarray) -> float:
    """J, against that of the start, which is 0; the angle (rad) is that of the rod from the horizontal."""
    inertia = MASS * LENGTH**2 / 3
    energy = 0.5 * inertia * speed**2 + MASS * GRAVITY * LENGTH / 2 * np.sin(angle)
    return float(np.abs(energy).max())
