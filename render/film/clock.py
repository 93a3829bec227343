"""The film's clock: which moment of the motion each frame shows.

A motion with a period is shown turn after turn without a seam, so the first period's pictures serve for all. One
without plays forwards at a rate, holds at its end, and begins anew; it never runs backwards.
"""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment
from render.film.time_map import TimeMap
from shared.contract import Motion
from shared.contract.quantity import figures
from shared.contract.shot import Shot

Array = NDArray[np.float64]
TURN = 4.0
"""Film time (s) of a turn of the drivers where the shot says nothing, and of a period that has no turns."""
LONGEST_PERIOD = 12.0
"""Film time (s) of a period of many turns where the shot says nothing."""
SHORTEST, LONGEST = 1.0, 20.0
"""Film time (s) of a motion without a period that plays in real time; otherwise at a round factor within these."""
STEPS = (1.0, 2.0, 5.0)
"""Round factors, times powers of ten."""


class Clock:
    """What the frames of a film show, from its motion and its shot."""

    def __init__(self, motion: Motion, shot: Shot) -> None:
        self.shot, self.repeats = shot, motion.period is not None
        self.start, self.end = motion.time[0], motion.time[-1]
        span = self.end - self.start
        self.turns = turns_of(motion) if self.repeats else 1
        """Number of turns of the drivers in one showing."""
        if shot.rate is not None:
            seconds = span / shot.rate
        elif shot.seconds_per_turn is not None:
            seconds = shot.seconds_per_turn * self.turns
        elif self.repeats:
            seconds = min(TURN * self.turns, max(TURN, LONGEST_PERIOD))
        else:
            seconds = span / natural_rate(span)
        self.moving = max(1, round(seconds * shot.fps))
        """Frames in which a showing moves."""
        self.rate = span * shot.fps / self.moving
        """Seconds of the motion in a second of film."""
        self.frames = self.moving if self.repeats else self.moving + max(1, round(shot.hold * shot.fps))
        """Pictures in one showing: a period, or the motion and the hold at its end."""
        self.showings = max(1, math.ceil(shot.turns / self.turns))

    @cached_property
    def total(self) -> int:
        """Pictures in the whole film."""
        return self.showings * self.frames

    @cached_property
    def time_map(self) -> TimeMap:
        """The same between the frames, for what is no picture."""
        fps = self.shot.fps
        film, model = [0.0, self.moving / fps, self.frames / fps], [self.start, self.end, self.end]
        return TimeMap.through(film, model, closes=self.repeats)

    def moment(self, frame: float) -> Moment:
        """The moment that a frame shows; those beyond one showing, or before frame 0, go on with the loop.

        The same place in a showing gives the same float in every one, so later ones find their pictures made.
        """
        showing, step = divmod(frame, self.frames)
        if self.repeats:
            return Moment(self.start + (self.end - self.start) * (step / self.moving), int(showing))
        return Moment(self.end if step >= self.moving else self.start + (self.end - self.start) * step / self.moving, 0)

    def around(self, frame: int) -> tuple[int, int, int]:
        """The frame between those that a shutter sees before and after: none of another showing, if it begins anew."""
        if self.repeats:
            return frame - 1, frame, frame + 1
        first = frame - frame % self.frames
        return max(first, frame - 1), frame, min(first + self.frames - 1, frame + 1)

    def frame_at(self, part: float) -> int:
        """The frame that shows the motion at a part of it, 0 .. 1."""
        return min(round(part * self.moving), self.frames - 1) if not self.repeats else round(part * self.moving)

    def phase(self, frame: float) -> float:
        """Part of the showing that has passed, 0 .. 1."""
        return (frame % self.frames) / self.frames

    def trail_times(self, frame: float, tail: float, count: int) -> Array:
        """(count,) times of the motion from now back to the end of a trail ``tail`` turns long.

        The trail of a motion that does not repeat grows from its start.
        """
        span = self.end - self.start
        back = tail * np.linspace(0, 1, count)
        if not self.repeats:
            now = self.moment(frame).time
            return now - min(span * tail, now - self.start) * np.linspace(0, 1, count)
        phase = (frame % self.frames) / self.frames - back / self.turns
        return self.start + span * (phase - np.floor(phase))

    def said(self) -> str:
        """How fast it plays and how often it is shown, for people."""
        seconds = self.moving / self.shot.fps
        if self.repeats:
            turns = "turn" if self.turns == 1 else f"{self.turns} turns"
            return f"{self.showings} x {seconds:.3g} s ({turns} each), {speed(self.rate)}"
        hold = (self.frames - self.moving) / self.shot.fps
        return f"{self.showings} x {seconds:.3g} s and {hold:.2g} s held at the end, {speed(self.rate)}"


def turns_of(motion: Motion) -> int:
    """Whole turns of the slowest driver that turns in one period; 1 where none does."""
    turns = [
        round(abs(driver.value[-1] - driver.value[0]) / math.tau)
        for driver in motion.drivers.values()
        if driver.unit == "rad"
    ]
    return min((count for count in turns if count), default=1)


def natural_rate(span: float) -> float:
    """Seconds of the motion in a second of film: 1, or the round factor nearest to it with a watchable film."""
    powers = np.arange(-12, 13)
    rates = sorted((step * 10.0**k for k in powers for step in STEPS), key=lambda rate: abs(math.log(rate)))
    return next((rate for rate in rates if SHORTEST <= span / rate <= LONGEST), span / TURN)


def speed(rate: float) -> str:
    """``in real time``, ``slowed 20 times``, ``5 times faster``."""
    if abs(rate - 1) < 0.02:
        return "in real time"
    return f"slowed {figures(1 / rate, 3)} times" if rate < 1 else f"{figures(rate, 3)} times faster"
