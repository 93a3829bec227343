"""Numbers of Params that a page offers, and the ends between which they move."""

from __future__ import annotations

from dataclasses import dataclass, replace

from studio.live.numbers import Number
from studio.site.designs.solved import Solved

WIDEST = 0.6, 1.5
"""Multiples of a number's value: a page offers no more than this."""
NARROWER = 0.7
TRIES = 7
NUDGE = 0.02
"""Part of its range by which a number is moved to see what it does."""
FELT = 1e-3
"""Parts of the machine's size or of its largest effort: what moves less is no main number."""


@dataclass(frozen=True)
class Axis:
    """Number of Params between two ends."""

    number: Number
    low: float
    high: float

    @property
    def name(self) -> str:
        """Name in Params."""
        return self.number.name

    def narrower(self) -> Axis:
        """Return an axis whose ends are nearer to the number's own value."""
        value = self.number.value
        return replace(self, low=value + NARROWER * (self.low - value), high=value + NARROWER * (self.high - value))


def axes_of(solved: Solved, numbers: list[Number], most: int) -> list[Axis]:
    """Return at most ``most`` main numbers.

    First come those that move the mechanism most, then those that change its efforts most.
    """
    felt: list[tuple[float, float, Axis]] = []
    for number in numbers:
        axis = _widest(number)
        if axis is None or solved.is_late:
            continue
        moved = solved.numbers_at({number.name: number.value + NUDGE * (number.high - number.low)})
        if moved is None:
            continue
        places, efforts = solved.away(moved, solved.usual)
        if max(places, efforts) > FELT:
            felt.append((places if places > FELT else 0.0, efforts, axis))
    felt.sort(key=lambda each: each[:2], reverse=True)
    fitting = (_that_solves(solved, axis) for _, _, axis in felt)
    out = []
    for axis in fitting:
        if axis is not None:
            out.append(axis)
        if len(out) == most:
            break
    return out


def _widest(number: Number) -> Axis | None:
    """Return the number's own range, within WIDEST.

    It is None for whole numbers and zeros, which have no multiples.
    """
    if number.whole or number.value == 0:
        return None
    ends = sorted(factor * number.value for factor in WIDEST)
    return Axis(number, max(number.low, ends[0]), min(number.high, ends[1]))


def _that_solves(solved: Solved, axis: Axis) -> Axis | None:
    """Return ends that both solve while all other numbers stay; None without such."""
    for _ in range(TRIES):
        if all(solved.numbers_at({axis.name: end}) is not None for end in (axis.low, axis.high)):
            return axis
        axis = axis.narrower()
    return None
