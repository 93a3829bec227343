"""What is written over the picture: a title, the rate of time, a number that follows the motion."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.vectors import at_time
from render.film.clock import Clock
from shared.contract import Motion
from shared.contract.quantity import figures, live
from shared.contract.shot import Shot

Array = NDArray[np.float64]
FIGURES = 3
"""Significant digits."""


def title(motion: Motion, shot: Shot) -> str:
    """The shot's title, or the mechanism's name in words; empty where none is asked for."""
    if shot.title is None:
        return ""
    if shot.title.text is not None:
        return shot.title.text
    words = motion.mechanism.replace("_", " ").replace("-", ": ")
    return words[:1].upper() + words[1:]


def rate(clock: Clock, shot: Shot) -> str:
    """How fast the film goes: with a title, and always where a motion that does not repeat is not in real time."""
    real = abs(clock.rate - 1) < 0.02
    if real:
        return "real time" if shot.title is not None else ""
    if shot.title is None and clock.repeats:
        return ""
    slower = clock.rate < 1
    return f"{figures(1 / clock.rate if slower else clock.rate, FIGURES)} times {'slower' if slower else 'faster'}"


def number(motion: Motion, shot: Shot) -> Callable[[float], str]:
    """The number that lives, as a function of time; it stands still."""
    name = shot.title.number if shot.title is not None else ""
    if name is None:
        name = _told(motion)
    if not name:
        return lambda t: ""
    time = np.asarray(motion.time)
    if name in motion.points:
        point = motion.points[name]
        speeds = np.hypot(point.vx, point.vy)[:, None]
        slow, fast = live(speeds[:, 0].tolist(), "m/s", FIGURES), live((3.6 * speeds[:, 0]).tolist(), "km/h", FIGURES)

        def speed(t: float) -> str:
            v = float(at_time(time, speeds, t)[0])
            return f"{name}  {slow(v)}   {fast(3.6 * v)}"

        return speed
    load = motion.drivers.get(name) or motion.forces[name]
    efforts = np.asarray(load.effort if load.effort is not None else np.zeros(len(time)), float)[:, None]
    write = live(efforts[:, 0].tolist(), load.effort_unit, FIGURES)
    return lambda t: f"{name}  {write(float(at_time(time, efforts, t)[0]))}"


def _told(motion: Motion) -> str:
    """The first of the drivers that give something; of those that act in their place; of the traced points."""
    drivers = [name for name, driver in motion.drivers.items() if any(driver.effort)]
    acting = [
        name
        for name, force in motion.forces.items()
        if motion.drivers and force.drives and force.effort is not None and any(force.effort)
    ]
    return next(iter((*drivers, *acting, *motion.drivers, *motion.points)), "")
