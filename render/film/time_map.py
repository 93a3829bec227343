"""Which moment of the motion the film shows at any of its seconds, and when it shows a given moment.

A showing is a row of pieces with a steady rate each: film seconds f0 .. f1 show the motion from m0 to m1, so that

    model(f) = m0 + rate (f - f0)      rate = (m1 - m0) / (f1 - f0)

A hold is a piece of rate 0; a cut is where a piece does not begin at the moment at which the one before it ends. Slower
and faster passages are more pieces; who reads the map knows nothing else of the film's time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TimePiece:
    """Film seconds ``film`` (from, to) of a showing show the motion from one moment to another, ``model`` (s)."""

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
    """Whether the next showing goes on with the motion where this one ends, as of a motion with a period."""

    @classmethod
    def through(cls, film: Sequence[float], model: Sequence[float], closes: bool) -> TimeMap:
        """The map with straight pieces between moments ``model`` (s) at film seconds ``film``, both (n,).

        Two moments at one film second are a cut.
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
        """The same showing, whose last moment is held until it is so many film seconds long."""
        end, moment = self.seconds, self.pieces[-1].model[1]
        return TimeMap((*self.pieces, TimePiece((end, seconds), (moment, moment))), False) if seconds > end else self

    def at(self, film: Array) -> tuple[Array, Array]:
        """Moments of the motion (s) and rates, (n,) each, at seconds ``film`` (n,) of a showing."""
        starts = np.array([piece.film[0] for piece in self.pieces])
        k = np.clip(np.searchsorted(starts, film, side="right") - 1, 0, len(starts) - 1)
        first = np.array([piece.model[0] for piece in self.pieces])
        rate = np.array([piece.rate for piece in self.pieces])[k]
        return first[k] + rate * (film - starts[k]), rate

    def when(self, model: Array) -> tuple[Array, NDArray[np.intp]]:
        """Film seconds at which moments ``model`` (n,) are shown, and the index of each moment.

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
