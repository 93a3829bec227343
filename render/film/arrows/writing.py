"""What is written over the picture: the legend, a title, the rate of time, a number that follows the motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from render.film.arrows.vectors import at_time
from render.film.clock import Clock
from render.film.framing import CameraPose, project
from render.film.scene import EDGE, LEGEND, LINE, SIZES, LegendRow
from render.presets import ASPECT
from shared.contract import Motion
from shared.contract.loads import ACTUATORS
from shared.contract.shot import Shot

Array = NDArray[np.float64]
CARD = 0.38, 0.24
"""Width and height of the place that a legend has at least, as parts of the picture."""
LETTER = 0.6
"""Width of a letter, in its height."""
ABOVE = 0.04, 0.08, 0.12, 0.16, 0.2, 0.24
"""Parts of the picture's height that are kept empty for what is written, the first that suffices."""


def card(rows: Sequence[LegendRow], title: tuple[float, float]) -> dict[str, tuple[float, float, float, float]]:
    """The corners in which a legend may be: left, upper, right and lower edge of its place, as parts of the picture.

    Beside a ``title`` of that width and height there may be no room at the upper right.
    """
    size = LEGEND / ASPECT
    letters = max((len(row.number) for row in rows), default=0) + max((len(row.words) for row in rows), default=0)
    arrow = max((row.length for row in rows), default=0.0)
    wide = max(CARD[0], EDGE + arrow + (3.0 + LETTER * letters) * size)
    high = max(CARD[1], EDGE * ASPECT + (1.1 + 1.5 * len(rows)) * LEGEND)
    places = {
        "lower left": (0.0, 1 - high, wide, 1.0),
        "lower right": (1 - wide, 1 - high, 1.0, 1.0),
        "upper right": (1 - wide, 0.0, 1.0, high),
    }
    return {name: place for name, place in places.items() if name != "upper right" or title[0] + wide < 1.0}


def held(camera: CameraPose, points: Array, place: tuple[float, float, float, float]) -> int:
    """How many of ``points`` (n, 3) are in a place of the picture."""
    left, upper, right, lower = place
    x, y = (project(camera, points, 1600, round(1600 / ASPECT)) / (1600, 1600 / ASPECT)).T
    return int(((x >= left) & (x <= right) & (y >= upper) & (y <= lower)).sum())


def emptiest(
    camera: CameraPose, moving: Array, standing: Array, places: Mapping[str, tuple[float, float, float, float]]
) -> str:
    """The corner of the picture that holds the fewest points of what moves (n, 3), then of what stands (m, 3)."""
    return min(
        places, key=lambda corner: (held(camera, moving, places[corner]), held(camera, standing, places[corner]))
    )


def extent(lines: Sequence[str]) -> tuple[float, float]:
    """How far the words at the upper left reach to the right and down: title, number and rate."""
    said = [(words, size) for words, size in zip(lines, SIZES, strict=True) if words]
    if not said:
        return 0.0, 0.0
    wide = EDGE + max(LETTER * size * len(words) for words, size in said) / ASPECT
    return wide, EDGE * ASPECT + sum(LINE * size for _, size in said)


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
    return f"{1 / clock.rate:.3g} times slower" if clock.rate < 1 else f"{clock.rate:.3g} times faster"


def number(motion: Motion, shot: Shot) -> Callable[[float], str]:
    """The number that lives, as a function of time; as many decimals as its largest value needs, so it stands still."""
    name = shot.title.number if shot.title is not None else ""
    if name is None:
        name = _told(motion)
    if not name:
        return lambda t: ""
    time = np.asarray(motion.time)
    if name in motion.points:
        point = motion.points[name]
        speeds = np.hypot(point.vx, point.vy)[:, None]
        slow, fast = _decimals(speeds), _decimals(3.6 * speeds)

        def speed(t: float) -> str:
            v = float(at_time(time, speeds, t)[0])
            return f"{name}  {v:.{slow}f} m/s   {3.6 * v:.{fast}f} km/h"

        return speed
    one = motion.drivers.get(name) or motion.forces[name]
    turning = "angle" in one.kind or getattr(one, "measures", None) == "angle"
    efforts = np.asarray(one.effort if one.effort is not None else np.zeros(len(time)), float)[:, None]
    digits = _decimals(efforts)

    def effort(t: float) -> str:
        value = round(float(at_time(time, efforts, t)[0]), digits) + 0.0
        return f"{name}  {f'{value:.{digits}f}'.replace('-', '−')} {'N m' if turning else 'N'}"

    return effort


def _told(motion: Motion) -> str:
    """The first of the drivers that give something; of those that act in their place; of the traced points."""
    drivers = [name for name, driver in motion.drivers.items() if any(driver.effort)]
    acting = [
        name
        for name, force in motion.forces.items()
        if motion.drivers and force.kind in ACTUATORS and force.effort is not None and any(force.effort)
    ]
    return next(iter((*drivers, *acting, *motion.drivers, *motion.points)), "")


def _decimals(values: Array) -> int:
    """Three figures of the largest one, at most four decimals."""
    top = float(np.abs(values).max())
    return min(max(2 - math.floor(math.log10(top)), 0), 4) if top > 0 else 0
