"""Machines with gears, a Geneva, a cam and a stiff contact: what they are, and their exact motion.

Sweeps are of 1000 poses, errors the largest difference of an angle from the exact one (rad). The contact: a ball falls
on a floor that pushes back with k times its depth; error: its height at the end (m).
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.calls import exact as four_bar
from benchmarks.calls import worst as worst

STEPS = 1000
PLANETARY, GENEVA, CAM, CONTACT = (
    "planetary gear with four-bar, sweep of 1000 angles",
    "Geneva, 1000 angles of an index",
    "cam with rocker, sweep of 1000 angles",
    "stiff contact, three bounces",
)
PROBLEMS = (PLANETARY, GENEVA, CAM, CONTACT)
CODES = ("mbsd", "exudyn", "mujoco")
WATCHED = {PLANETARY: ("coupler", "rocker"), GENEVA: ("wheel",), CAM: ("arm",)}
"""Bodies whose angles count."""
BAR = 10.0
"""How many times the time of mbsd the quickest peer takes at least."""
LIMITS = {PLANETARY: 1e-5, GENEVA: 1e-5, CAM: 1e-5, CONTACT: 1e-4}
"""Limits of the error; wide enough that MuJoCo's soft loops are peers."""
SUN, PLANET = 0.5, 0.5
"""Pitch radii (m): the carrier is the crank of the four-bar sweep's linkage and goes a quarter of the sun's way."""
RATIO = SUN / (2 * SUN + 2 * PLANET)
SLOTS, DISTANCE = 4, 1.0
RADIUS = DISTANCE * math.sin(math.pi / SLOTS)
INDEX = 0.78
"""The crank goes from this far before the line of centres to as far behind it (rad), its pin in the slot."""
ECCENTRIC, DISC, ARM, PIVOT = 0.3, 1.0, 1.5, 2.0
"""A disc turns about a point off its centre; the roller's centre on an arm stays at DISC from it (m)."""
STIFFNESS, HEIGHT, GRAVITY, DURATION = 1e8, 1.0, 10.0, 3.0
"""Stiffness, height of fall, gravity and duration of a ball of 1 kg that falls (N/m, m, m/s^2, s)."""

SPAN = {PLANETARY: (0.0, 2 * math.pi / RATIO), GENEVA: (-INDEX, INDEX), CAM: (0.0, 2 * math.pi)}


def angles(problem: str) -> np.ndarray:
    """(1000,) of the driven shaft (rad)."""
    first, last = SPAN[problem]
    return first + (last - first) * np.arange(STEPS) / STEPS


def exact(problem: str, phi: np.ndarray) -> np.ndarray:
    """(T, k) angles that count (rad) at angles phi of the driven shaft."""
    if problem == PLANETARY:
        return np.stack(four_bar(RATIO * phi), axis=1)
    if problem == GENEVA:
        return np.arctan2(RADIUS * np.sin(phi), RADIUS * np.cos(phi) - DISTANCE)[:, None]
    x, y = ECCENTRIC * np.cos(phi) - PIVOT, ECCENTRIC * np.sin(phi)
    reach = np.hypot(x, y)
    bend = np.arccos((reach**2 + ARM**2 - DISC**2) / (2 * reach * ARM))
    return (np.arctan2(y, x) - bend)[:, None]


def height(time: float) -> float:
    """Height of the ball above the untouched floor (m): falls and half swings of the floor without loss."""
    speed, omega = math.sqrt(2 * GRAVITY * HEIGHT), math.sqrt(STIFFNESS)
    sag = GRAVITY / STIFFNESS
    touch = 2 * (math.pi - math.atan2(speed / omega, sag)) / omega
    fall = speed / GRAVITY
    rest = (time - fall) % (touch + 2 * fall) if time > fall else -1.0
    if rest < 0:
        return HEIGHT - 0.5 * GRAVITY * time**2
    if rest < touch:
        return -sag + sag * math.cos(omega * rest) - speed / omega * math.sin(omega * rest)
    rest -= touch
    return speed * rest - 0.5 * GRAVITY * rest**2
