"""A story: its shots in order, and the curves that it draws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import msgspec
import numpy as np
from numpy.typing import NDArray

from render.film.clock import TimeMap
from render.film.story.frame import Caption, Over, Picture, Shot
from render.insights import Insight
from render.insights.stops import carried
from render.magnitudes import NOISE, effort_floor, force_scale, without_noise
from shared.contract import Motion
from shared.contract.signals import SIGNALS

# The curves of the strip under a story: one to three quantities over the motion, as numbers.

Array = NDArray[np.float64]
MOST = 3
FLAT = 1e-6
"""Curves that change by less than this part of their largest are not worth a strip."""


@dataclass(frozen=True)
class Curve:
    """One curve."""

    name: str
    unit: str
    colour: str
    """``#rrggbb`` on dark paper."""
    time: Array
    """(T,) s"""
    values: Array
    """(T,) in its unit."""


def curve_of(motion: Motion, name: str) -> Curve | None:
    """Return the curve of a joint (reaction), driver or force (effort) or point (speed); None of no such."""
    time = np.asarray(motion.time)
    if name in motion.joints:
        joint = motion.joints[name]
        size = np.hypot(joint.fx, joint.fy)
        return Curve(name, "N", SIGNALS["reactions"].dark, time, without_noise(size, NOISE * force_scale(motion)))
    if name in motion.contacts:
        contact = motion.contacts[name]
        values = np.asarray(contact.normal, float)
        return Curve(name, contact.effort_unit, SIGNALS["reactions"].dark, time, values)
    load = motion.drivers.get(name) or motion.forces.get(name)
    if load is not None and load.effort is not None:
        colour = SIGNALS["forces" if load.effort_unit == "N" else "torques"].dark
        floor = effort_floor(motion, load.effort_unit == "N")
        return Curve(name, load.effort_unit, colour, time, without_noise(np.asarray(load.effort, float), floor))
    if name in motion.points:
        point = motion.points[name]
        return Curve(name, "m/s", SIGNALS["velocities"].dark, time, np.hypot(point.vx, point.vy))
    if name in motion.bodies:
        body = motion.bodies[name]
        slides = np.ptp(body.theta) < 1e-9
        values = np.hypot(body.vx, body.vy) if slides else np.asarray(body.omega, float)
        return Curve(name, "m/s" if slides else "rad/s", SIGNALS["velocities"].dark, time, values)
    return None


def curves_of(motion: Motion, wished: Sequence[str] | None, reasons: Sequence[Insight]) -> list[Curve]:
    """Return the curves of ``wished`` names, or of the first reason, the drive and the fastest body.

    The latter are shown without a wish.
    """
    if wished is not None:
        return [curve for name in wished if (curve := curve_of(motion, name)) is not None]
    stop = reasons[0] if reasons else None
    first = [*stop.joints, *stop.bodies[::-1], carried(motion, stop.start)[0]] if stop is not None else []
    fast = [name for reason in reasons if reason.kind == "speed" for name in reason.joints]
    names = dict.fromkeys([*first, *motion.drivers, *fast, *motion.points, *motion.bodies])
    curves = [curve for name in names if name and (curve := curve_of(motion, name)) is not None]
    lively = [curve for curve in curves if _is_lively(curve)]
    by_unit: dict[str, Curve] = {}
    for curve in lively:  # a curve of each unit says more than three of one
        by_unit.setdefault(curve.unit, curve)
    return list(by_unit.values())[:MOST]


def _is_lively(curve: Curve) -> bool:
    top = float(np.abs(curve.values).max(initial=0.0))
    return bool(np.isfinite(curve.values).all()) and float(np.ptp(curve.values)) > FLAT * top > 0.0


# A story: shots one after the other, what each of its frames shows, and which time of the motion it is.


@dataclass(frozen=True)
class Placed:
    """A shot on the clock of the film: frames ``first`` .. ``end`` - 1."""

    shot: Shot
    first: int
    end: int


@dataclass(frozen=True)
class Story:
    """Shots one after the other."""

    mechanism: str
    fps: int
    step: int
    """Frames for which a picture that moves stands."""
    shots: Sequence[Shot]
    curves: Sequence[Curve] = ()
    """Curves of the strip."""
    at_side: bool = False
    """True if the strip stands beside the machine."""

    @cached_property
    def placed(self) -> list[Placed]:
        """The shots with their frames."""
        out, at = [], 0
        for shot in self.shots:
            count = max(1, round(shot.seconds * self.fps))
            out.append(Placed(shot, at, at + count))
            at += count
        return out

    @property
    def total(self) -> int:
        """Frames of the film."""
        return self.placed[-1].end

    @property
    def seconds(self) -> float:
        """Seconds of the film."""
        return self.total / self.fps

    def placed_at(self, frame: int) -> Placed:
        """Return the shot of a frame."""
        return next(placed for placed in self.placed if frame < placed.end)

    def picture(self, frame: int) -> Picture:
        """Return the picture that Blender makes for a frame."""
        placed = self.placed_at(frame)
        return placed.shot.picture(self._second(placed, frame, self.step))

    def around(self, frame: int) -> tuple[Picture, Picture, Picture]:
        """Return the pictures that a shutter sees before, at and after a frame, within its shot."""
        placed = self.placed_at(frame)
        here = placed.first + (frame - placed.first) // self.step * self.step
        near = (max(here - 1, placed.first), here, min(here + 1, placed.end - 1))
        before, now, after = (placed.shot.picture(self._second(placed, k, 1)) for k in near)
        return before, now, after

    def over(self, frame: int) -> Over:
        """Return the overlay of a frame; words go on ones, and the playhead with the picture."""
        placed = self.placed_at(frame)
        over = placed.shot.over(self._second(placed, frame, 1))
        still = placed.shot.over(self._second(placed, frame, self.step))
        return msgspec.structs.replace(over, now=still.now, rate=still.rate)

    def model_time(self, s: float) -> float:
        """Return the time of the motion (s) at film second ``s``, 0 <= ``s`` <= ``seconds``.

        It is monotone within a shot, jumps at cuts, and goes on beyond a period that begins anew.
        """
        frame = min(max(int(s * self.fps), 0), self.total - 1)
        placed = self.placed_at(frame)
        return placed.shot.model(s - placed.first / self.fps)

    def time_map(self, start: float, end: float, anew: bool = True) -> TimeMap:
        """Return the time map for sound, a piece a frame long.

        It is of a motion from ``start`` to ``end`` (s) that begins anew, or stands at its end if it does not.
        """
        seconds, moments = [0.0], [self.model_time(0.0)]
        for placed in self.placed:
            for k in range(placed.end - placed.first + 1):
                seconds.append((placed.first + k) / self.fps)
                moments.append(placed.shot.model(k / self.fps))
        if not anew:
            return TimeMap.from_moments(*_held(seconds, moments, start, end), closes=False)
        return TimeMap.from_moments(*_folded(seconds, moments, start, end), closes=False)

    @cached_property
    def pictures(self) -> list[Picture]:
        """All different pictures."""
        return list(dict.fromkeys(self.picture(frame) for frame in range(self.total)))

    @property
    def captions(self) -> list[Caption]:
        """Captions on the film's clock."""
        return [
            Caption(placed.first / self.fps + caption.start, placed.first / self.fps + caption.end, caption.text)
            for placed in self.placed
            for caption in placed.shot.captions
        ]

    @property
    def chapters(self) -> list[tuple[float, float, str]]:
        """Start and end (s) of each shot, and its name for players."""
        return [(p.first / self.fps, p.end / self.fps, p.shot.chapter) for p in self.placed]

    def _second(self, placed: Placed, frame: int, step: int) -> float:
        return (frame - placed.first) // step * step / self.fps


def _held(seconds: list[float], moments: list[float], start: float, end: float) -> tuple[list[float], list[float]]:
    """Return moments held within ``start`` .. ``end``, as in the picture.

    Where a shot begins the motion anew, the film cuts.
    """
    out_seconds, out_moments = [], []
    for k, (second, moment) in enumerate(zip(seconds, moments, strict=True)):
        moment = min(max(moment, start), end)
        if k and second > seconds[k - 1] and moment < out_moments[-1]:
            out_seconds.append(second)
            out_moments.append(out_moments[-1])
        out_seconds.append(second)
        out_moments.append(moment)
    return out_seconds, out_moments


def _folded(seconds: list[float], moments: list[float], start: float, end: float) -> tuple[list[float], list[float]]:
    """Return moments brought back into ``start`` .. ``end``.

    Where a piece passes the end, the film cuts to the start.
    """
    whole = end - start
    out_seconds, out_moments = [], []
    for k, (second, moment) in enumerate(zip(seconds, moments, strict=True)):
        turn = math.floor((moment - start) / whole + 1e-12)
        if k and second > seconds[k - 1]:
            before = math.floor((moments[k - 1] - start) / whole + 1e-12)
            if turn > before:
                edge = start + turn * whole
                part = (edge - moments[k - 1]) / (moment - moments[k - 1])
                at = seconds[k - 1] + part * (second - seconds[k - 1])
                out_seconds += [at, at]
                out_moments += [end, start]
        out_seconds.append(second)
        out_moments.append(moment - turn * whole)
    return out_seconds, out_moments
