"""Ramps of time and space: eased moves, and pieces lifted one after another."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from render.film.pieces import Lift

# Time ramps: how time of the motion passes while the film runs, and how fast at each moment.

Array = NDArray[np.float64]
SHOWN = 1.0
"""Seconds that a rate holds at least if it is written."""
Segment = tuple[float, float, float]
"""Seconds of film, and the rates (seconds of the motion in a second of film) at its begin and its end."""


def eased(part: float) -> float:
    """Return 0 .. 1 for 0 .. 1, with rest at both ends."""
    u = min(max(part, 0.0), 1.0)
    return u * u * (3 - 2 * u)


@dataclass(frozen=True)
class Ramp:
    """Rates that change softly, segment after segment; time of the motion never runs backwards."""

    start: float
    """Time of the motion (s) at film second 0."""
    segments: tuple[Segment, ...]

    @property
    def seconds(self) -> float:
        """Seconds of film."""
        return sum(seconds for seconds, _, _ in self.segments)

    def time_at(self, s: float) -> float:
        """Return the time of the motion (s) at film second ``s``; held at both ends."""
        time = self.start
        for seconds, low, high in self.segments:
            u = min(max(s / seconds, 0.0), 1.0) if seconds > 0 else 1.0
            time += seconds * (low * u + (high - low) * (u**3 - u**4 / 2))
            s -= seconds
            if s <= 0:
                break
        return time

    def rate(self, s: float) -> float:
        """Return seconds of the motion in a second of film, at film second ``s``."""
        for seconds, low, high in self.segments:
            if s < seconds:
                return low + (high - low) * eased(s / seconds)
            s -= seconds
        return self.segments[-1][2] if self.segments else 0.0

    def shown_rate(self, s: float) -> float | None:
        """Return the rate that is written at film second ``s``; None while it changes or is too short."""
        begins = 0.0
        for seconds, low, high in self.segments:
            if s < begins + seconds:
                return low if low == high and seconds >= SHOWN else None
            begins += seconds
        return None


def into(event: float, earliest: float, rate: float, seconds: float, slowing: float) -> Ramp:
    """Return a ramp at ``rate`` for some ``seconds`` that slows down and stops at an ``event``.

    It begins at ``earliest`` (s) at the earliest; what is left until the event then goes slower.
    """
    needed = rate * (seconds + slowing / 2)
    left = max(event - earliest, 0.0)
    rate = rate if needed <= left else rate * left / needed
    start = event - rate * (seconds + slowing / 2)
    return Ramp(start, ((seconds, rate, rate), (slowing, rate, 0.0)))


@dataclass(frozen=True)
class Warp:
    """A motion that goes slowly where much happens and fast through dull stretches: a table of times."""

    film: tuple[float, ...]
    """Rising seconds of film, from 0 on."""
    motion: tuple[float, ...]
    """Rising times of the motion (s)."""

    @property
    def seconds(self) -> float:
        """Seconds of film."""
        return self.film[-1]

    def time_at(self, s: float) -> float:
        """Return the time of the motion (s) at film second ``s``."""
        return float(np.interp(s, self.film, self.motion))

    def rate(self, s: float) -> float:
        """Return seconds of the motion in a second of film, at film second ``s``."""
        h = 0.02 * self.seconds
        low, high = max(s - h, 0.0), min(s + h, self.seconds)
        return (self.time_at(high) - self.time_at(low)) / max(high - low, 1e-12)

    def shown_rate(self, s: float) -> float | None:
        """Return the rate that is written at film second ``s``, in steps; None while no step holds long enough."""
        return next((rate for begin, end, rate in self._held if begin <= s < end), None)

    @cached_property
    def _held(self) -> list[tuple[float, float, float]]:
        """Begin, end (s) and step of each stretch in which a step of the rate holds."""
        seconds = np.linspace(0.0, self.seconds, ROWS)
        steps = [stepped(self.rate(float(s))) for s in seconds]
        changes = [0, *(k for k in range(1, ROWS) if steps[k] != steps[k - 1]), ROWS - 1]
        stretches = [(float(seconds[a]), float(seconds[b]), steps[a]) for a, b in pairwise(changes)]
        return [stretch for stretch in stretches if stretch[1] - stretch[0] >= SHOWN]


def stepped(rate: float) -> float:
    """Return the nearest of 1, 2, 5, 10, 20 and so on times real time, or of these parts of it."""
    power = math.floor(math.log10(rate)) if rate > 0 else 0
    steps = [step * 10.0**power for step in (1, 2, 5, 10)]
    return min(steps, key=lambda step: abs(math.log(step / rate))) if rate > 0 else 0.0


LEAST, SOFT = 0.35, 0.04
"""Weight of a stretch in which nothing happens beside that of a lively one, and the softness of changes, in parts."""
ROWS = 400


def warped(time: Sequence[float], happens: Array, start: float, end: float, seconds: float) -> Warp:
    """Return a warp over ``start`` .. ``end`` (s) of so many ``seconds``.

    ``happens`` (T,) >= 0 is how much happens at ``time``.
    """
    times = np.linspace(start, end, ROWS)
    lively = np.interp(times, np.asarray(time), happens)
    top = float(np.quantile(lively, 0.95)) or 1.0
    weight = LEAST + (1 - LEAST) * np.clip(lively / top, 0.0, 1.0)
    reach = max(1, round(3 * SOFT * ROWS))
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / (SOFT * ROWS)) ** 2)
    weight = np.convolve(np.pad(weight, reach, mode="edge"), bell / bell.sum(), mode="valid")
    passed = np.concatenate([[0.0], np.cumsum((weight[1:] + weight[:-1]) / 2)])
    return Warp(tuple((seconds * passed / passed[-1]).tolist()), tuple(times.tolist()))


# How far each piece is lifted while a machine comes apart: what came last goes first, and comes back last.

EACH = 0.45
"""Part of the time of coming apart that each layer takes."""


def lifted(lifts: Sequence[Lift], part: float) -> list[float]:
    """Return heights (m) of all pieces over their place, in a machine that is apart by a ``part`` 0 .. 1."""
    last, first = lifts[-1].order, min((lift.order for lift in lifts if lift.distance), default=0)
    layers, each = last - first, EACH if last > first else 1.0
    delays = [min((last - lift.order) / max(layers, 1), 1.0) * (1 - each) for lift in lifts]
    return [lift.distance * eased((part - delay) / each) for lift, delay in zip(lifts, delays, strict=True)]
