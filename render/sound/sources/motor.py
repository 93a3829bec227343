"""Motors: drivers, and the forces that drive in their place, as far as they give more than they take.

A driver says a speed and a torque, not which motor and gearbox give them. Here it is a motor with twelve slots behind a
gearbox with the ratio of the series 1, 1.6, 2.5, 4, 6.3, 10 ... with which its rotor makes some 40 turns a second of
the film where the driver is as fast as it gets. The ratio holds for the whole film, so speed and slow motion are heard:

    rotor    f = i |q'| / 2 pi       harmonics 1, 2, 3 of unbalance, 12 and 24 of slots, louder with load
    level    P = (|Q| + Q_0) (|q'| + q'_max / 10),   of which 1e-6 leaves as sound     Q: torque or force, Q_0 when idle

A motor of a way (m) drives a screw, one turn of which takes a hundredth of its whole way. Source of the part that is
sound: Bies, Hansen, Engineering Noise Control, 2009, chapter 11.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from render.sound.desk import Desk
from render.sound.ringing import of_power
from render.sound.setting import Setting

Array = NDArray[np.float64]
NAME = "motors"
ROTOR = 40.0
"""Turns of the rotor in a second of film, about (1/s)."""
EFFICIENCY = 1e-6
SLOTS = 12
UNBALANCE = (0.3, 0.25, 0.15)
"""Weights of the harmonics of unbalance, beside those of the slots under load."""
SERIES = 10.0 ** (np.arange(0, 41) / 5)
"""Ratios of gearboxes, R5."""
TAKEN = 0.01
"""A load below this part of the work that goes in and out is none."""
IDLE = 0.005
"""Torque of a motor without load: this part of the machine's weight, at the arm of its size."""
REST = 0.1
"""Part of the greatest speed at which a motor that holds still is as loud."""


def play(setting: Setting, desk: Desk) -> None:
    """Play the motors of drivers, and of forces that drive."""
    for _, driver in setting.heard(setting.motion.drivers):
        bodies = driver.bodies or ("ground", "ground")
        if not _takes(setting, driver.power):
            _motor(setting, desk, np.asarray(driver.value), np.asarray(driver.effort), driver.unit == "rad", bodies)
    for _, force in setting.heard(setting.motion.forces):
        if not force.drives or force.value is None or force.effort is None or not force.actions:
            continue
        if not _takes(setting, force.power):
            bodies = (force.actions[0].body, force.actions[-1].body)
            _motor(setting, desk, np.asarray(force.value), np.asarray(force.effort), force.unit == "rad", bodies)


def _takes(setting: Setting, power: list[float]) -> bool:
    """Return True if it takes more work than it gives, as a load or a speed governor does."""
    given, all_of_it = (float(np.trapezoid(values, setting.time)) for values in (power, np.abs(power)))
    return given < -TAKEN * all_of_it


def _speed(time: Array, value: Array) -> Array:
    """Return (T,) the size of the rate of a value; where it jumps, that before and after."""
    steps = np.diff(time)
    rate = np.abs(np.diff(value)) / np.where(steps > 0, steps, np.inf)
    return np.maximum(np.append(rate, rate[-1]), np.insert(rate, 0, rate[0]))


def _motor(setting: Setting, desk: Desk, value: Array, effort: Array, turns: bool, bodies: tuple[str, str]) -> None:
    screw = math.tau if turns else max(float(np.ptp(value)) / 100, 1e-9)
    way = setting.continued(setting.series(value) / screw)
    speed = np.abs(np.gradient(way, setting.at))
    fastest = float(np.quantile(speed, 0.98))
    if fastest < 1e-9:
        return
    ratio = float(SERIES[np.abs(np.log(SERIES * fastest / ROTOR)).argmin()])
    moves = setting.rate > 0
    own = setting.series(_speed(setting.time, value)) * moves  # as the machine goes
    weight = 9.81 * sum(body.mass for body in setting.motion.bodies.values())
    load = np.abs(setting.series(effort)) + IDLE * weight * (setting.film.size if turns else 1.0)
    level = of_power(load * (own + REST * float(np.quantile(own, 0.98)) * moves), EFFICIENCY)
    side = setting.side_of(bodies[1] if bodies[1] != "ground" else bodies[0])
    phase = setting.closed(ratio * way)
    desk.tone(NAME, phase, level, UNBALANCE, side)
    loaded = level * (0.3 + 0.7 * load / max(float(load.max()), 1e-12))
    desk.tone(NAME, SLOTS * phase, loaded, (1.0, 0.3), side)
