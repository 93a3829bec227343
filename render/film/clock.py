"""The clock of a film: from times of the motion to frames."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment
from shared.contract import AnyMotion
from shared.contract.quantity import figures
from shared.contract.shot import Shot

# The map from seconds of the film to moments of the motion, and back.
#
# A showing is a row of pieces with a steady rate each: film seconds f0 .. f1 show the motion from m0 to m1, so that
#
#     model(f) = m0 + rate (f - f0)      rate = (m1 - m0) / (f1 - f0)
#
# A hold is a piece of rate 0; a cut is where a piece does not begin at the moment at which the one before it ends.
# Slower and faster passages are more pieces; who reads the map knows nothing else of the film's time.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TimePiece:
    """A piece of a showing: film seconds ``film`` show the motion's times ``model`` (s), from and to."""

    film: tuple[float, float]
    model: tuple[float, float]

    @property
    def rate(self) -> float:
        """Seconds of the motion in a second of film."""
        return (self.model[1] - self.model[0]) / (self.film[1] - self.film[0])


@dataclass(frozen=True)
class TimeMap:
    """One showing of a film, in pieces that follow each other from film second 0 on."""

    pieces: tuple[TimePiece, ...]
    closes: bool
    """True if the next showing goes on with the motion where this one ends, as of a motion with a period."""

    @classmethod
    def from_moments(cls, film: Sequence[float], model: Sequence[float], closes: bool) -> TimeMap:
        """Return the map with straight pieces between moments ``model`` (s) at film seconds ``film``.

        Both are (n,). Two moments at one film second are a cut.
        """
        rows = zip(film[:-1], film[1:], model[:-1], model[1:], strict=True)
        return cls(tuple(TimePiece((a, b), (c, d)) for a, b, c, d in rows if b > a), closes)

    @property
    def seconds(self) -> float:
        """Film seconds of a showing."""
        return self.pieces[-1].film[1]

    @property
    def cuts(self) -> list[float]:
        """Film seconds at which the motion jumps; 0, where a showing does not go on with the next one."""
        cuts = [] if self.closes else [0.0]
        rows = zip(self.pieces, self.pieces[1:], strict=False)
        return cuts + [b.film[0] for a, b in rows if abs(b.model[0] - a.model[1]) > 1e-9 * max(1.0, abs(a.model[1]))]

    def held(self, seconds: float) -> TimeMap:
        """Return the same showing, whose last moment is held until it is so many film seconds long."""
        end, moment = self.seconds, self.pieces[-1].model[1]
        return TimeMap((*self.pieces, TimePiece((end, seconds), (moment, moment))), False) if seconds > end else self

    def moments_at(self, film: Array) -> tuple[Array, Array]:
        """Return moments of the motion (s) and rates, (n,) each, at seconds ``film`` (n,) of a showing."""
        starts = np.array([piece.film[0] for piece in self.pieces])
        k = np.clip(np.searchsorted(starts, film, side="right") - 1, 0, len(starts) - 1)
        first = np.array([piece.model[0] for piece in self.pieces])
        rate = np.array([piece.rate for piece in self.pieces])[k]
        return first[k] + rate * (film - starts[k]), rate

    def when(self, model: Array) -> tuple[Array, NDArray[np.intp]]:
        """Return the film seconds at which moments ``model`` (n,) are shown, and the index of each moment.

        A moment that a film shows twice is there twice, and one that it leaves out is not there. The end of a motion
        is its start where it closes.
        """
        film, index = [], []
        for number, piece in enumerate(self.pieces):
            (low, high), last = piece.model, number + 1 == len(self.pieces) or not self.pieces[number + 1].rate
            ends = model <= high if last and not self.closes else model < high
            shown = np.flatnonzero((model >= low) & ends) if piece.rate else np.zeros(0, np.intp)
            film.append(piece.film[0] + (model[shown] - low) / (piece.rate or 1.0))
            index.append(shown)
        return np.concatenate(film), np.concatenate(index)


# The film's clock: which moment of the motion each frame shows.
#
# A motion with a period is shown turn after turn without a seam, so the first period's pictures serve for all. One
# without plays forwards at a rate, holds at its end, and begins anew; it never runs backwards.

TURN = 4.0
"""Film time (s) of a turn of the drivers where the shot says nothing, and of a period that has no turns."""
LONGEST_PERIOD = 12.0
"""Film time (s) of a period of many turns where the shot says nothing."""
SHORTEST, LONGEST = 1.0, 20.0
"""Film time (s) of a motion without a period that plays in real time; otherwise at a round factor within these."""
STEPS = (1.0, 2.0, 5.0)
"""Round factors, times powers of ten."""


class Clock:
    """Times that the frames of a film show, from its motion and its shot."""

    def __init__(self, motion: AnyMotion, shot: Shot) -> None:
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
        return TimeMap.from_moments(film, model, closes=self.repeats)

    def moment(self, frame: float) -> Moment:
        """Return the moment that a frame shows; frames outside one showing go on with the loop.

        The same place in a showing gives the same float in every one, so later ones find their pictures made.
        """
        showing, step = divmod(frame, self.frames)
        if self.repeats:
            return Moment(self.start + (self.end - self.start) * (step / self.moving), int(showing))
        return Moment(self.end if step >= self.moving else self.start + (self.end - self.start) * step / self.moving, 0)

    def around(self, frame: int) -> tuple[int, int, int]:
        """Return the frames that a shutter sees before, at and after a frame, within its showing.

        A motion that repeats has frames on both sides.
        """
        if self.repeats:
            return frame - 1, frame, frame + 1
        first = frame - frame % self.frames
        return max(first, frame - 1), frame, min(first + self.frames - 1, frame + 1)

    def frame_at(self, part: float) -> int:
        """Return the frame that shows the motion at a part of it, 0 .. 1."""
        return min(round(part * self.moving), self.frames - 1) if not self.repeats else round(part * self.moving)

    def phase(self, frame: float) -> float:
        """Return the part of the showing that has passed, 0 .. 1."""
        return (frame % self.frames) / self.frames

    def trail_times(self, frame: float, tail: float, count: int) -> Array:
        """Return (count,) times of the motion from now back to the end of a trail ``tail`` turns long.

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
        """Return how fast it plays and how often it is shown, for people."""
        seconds = self.moving / self.shot.fps
        if self.repeats:
            turns = "turn" if self.turns == 1 else f"{self.turns} turns"
            return f"{self.showings} x {seconds:.3g} s ({turns} each), {speed(self.rate)}"
        hold = (self.frames - self.moving) / self.shot.fps
        return f"{self.showings} x {seconds:.3g} s and {hold:.2g} s held at the end, {speed(self.rate)}"


def turns_of(motion: AnyMotion) -> int:
    """Return the whole turns of the slowest driver that turns in one period; 1 where none does."""
    turns = [
        round(abs(driver.value[-1] - driver.value[0]) / math.tau)
        for driver in motion.drivers.values()
        if driver.unit == "rad"
    ]
    return min((count for count in turns if count), default=1)


def natural_rate(span: float) -> float:
    """Return seconds of the motion in a second of film.

    It is 1, or the round factor nearest to it with a watchable film.
    """
    powers = np.arange(-12, 13)
    rates = sorted((step * 10.0**k for k in powers for step in STEPS), key=lambda rate: abs(math.log(rate)))
    return next((rate for rate in rates if SHORTEST <= span / rate <= LONGEST), span / TURN)


def speed(rate: float) -> str:
    """Return ``in real time``, ``slowed 20 times`` or ``5 times faster``."""
    if abs(rate - 1) < 0.02:
        return "in real time"
    return f"slowed {figures(1 / rate, 3)} times" if rate < 1 else f"{figures(rate, 3)} times faster"
