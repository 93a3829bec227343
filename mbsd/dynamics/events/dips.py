"""Where a scalar falls below zero for a moment, between the parts of a step at which it was sampled.

Where a scalar is convex it lies above the lines through the samples on both sides of an interval. So it can fall below
zero there only where these lines do; where they meet it is looked at next, and each half is judged anew. That closes in
on a minimum of any width, and costs nothing where the scalar stays away from zero.

A distance is no convex scalar: the arms of its V bend inwards where the point moves on an arc. So lines that come near
zero are drawn again from the ends of the interval, where they are steeper.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

AT_END = 1e-3
"""Part of an interval within which the slope at the end of a step is taken."""
INSIDE = 0.02
"""The next look is this part of an interval away from its ends."""
NARROWEST = 1e-10
MOST_LOOKS = 80
NEAR, SLACK = 0.3, 0.05
"""Fractions of the higher sample: lines of the neighbours, and of the ends, that come down to this are followed."""
UNSURE = 1e-4
"""Part of what the scalar changes by in a step below which the quintic does not tell its sign."""


class Dip(NamedTuple):
    """Parts of the step between which the scalar falls through zero for the first time."""

    above: float
    below: float


class _Interval(NamedTuple):
    a: float
    fa: float
    b: float
    fb: float
    falls: float
    """Slope of the line from the left."""
    rises: float

    def lowest(self) -> tuple[float, float]:
        """Where the two lines meet, and their value there; the scalar is not below. (a, fa) if it has no minimum."""
        if self.falls >= 0.0 or self.rises <= 0.0:
            return self.a, self.fa
        x = (self.fb - self.fa + self.falls * self.a - self.rises * self.b) / (self.falls - self.rises)
        x = min(max(x, self.a), self.b)
        return x, max(self.fa + self.falls * (x - self.a), self.fb + self.rises * (x - self.b))

    def enough(self, level: float) -> float:
        """Where the lines stay above this, the scalar stays above ``level``."""
        return level + SLACK * max(self.fa - level, self.fb - level, 0.0)


def first_dip(
    x: np.ndarray, values: np.ndarray, still: float, quintic: Callable[[float], float], true: Callable[[float], float]
) -> Dip | None:
    """The first dip below -``still`` between samples ``values`` at parts ``x`` (n,) of a step, none of them below.

    ``quintic`` and ``true`` give the scalar at a part of the step, roughly and exactly.
    """
    slopes = np.diff(values) / np.diff(x)
    spread = float(np.ptp(values))
    for k in range(len(slopes)):
        if min(values[k], values[k + 1]) <= still and k == 0:
            continue  # it has just left zero
        interval = _interval(x, values, slopes, k, quintic, -still)
        if interval is None:
            continue
        dip = _searched(interval, UNSURE * spread - still, quintic)
        if dip is None:
            continue
        if quintic(dip.below) < -still and true(dip.below) < -still:
            return dip
        dip = _searched(interval, -still, true)
        if dip is not None:
            return dip
    return None


def _interval(
    x: np.ndarray, values: np.ndarray, slopes: np.ndarray, k: int, quintic: Callable[[float], float], level: float
) -> _Interval | None:
    """Interval k with its two lines, or None where the scalar does not fall from its left or rise to its right."""
    a, b, fa, fb = float(x[k]), float(x[k + 1]), float(values[k]), float(values[k + 1])
    if (k > 0 and slopes[k - 1] >= 0.0) or (k + 1 < len(slopes) and slopes[k + 1] <= 0.0):
        return None
    level += NEAR * max(fa - level, fb - level, 0.0)
    if k > 0 and fa + slopes[k - 1] * (b - a) >= level:
        return None
    if k + 1 < len(slopes) and fb - slopes[k + 1] * (b - a) >= level:
        return None
    near = AT_END * (b - a)
    falls, rises = (quintic(a + near) - fa) / near, (fb - quintic(b - near)) / near
    if k > 0:
        falls = min(falls, float(slopes[k - 1]))
    if k + 1 < len(slopes):
        rises = max(rises, float(slopes[k + 1]))
    return _Interval(a, fa, b, fb, falls, rises)


def _searched(interval: _Interval, level: float, value: Callable[[float], float]) -> Dip | None:
    """The first place that is found below ``level``, and one before it that is not."""
    waiting, looks = [interval], 0
    while waiting and looks < MOST_LOOKS:
        piece = waiting.pop()
        x, least = piece.lowest()
        width = piece.b - piece.a
        if least >= piece.enough(level) or width < NARROWEST:
            continue
        x = min(max(x, piece.a + INSIDE * width), piece.b - INSIDE * width)
        fx = value(x)
        looks += 1
        if fx < level:
            return Dip(piece.a, x)
        left, right = (fx - piece.fa) / (x - piece.a), (piece.fb - fx) / (piece.b - x)
        waiting.append(_Interval(x, fx, piece.b, piece.fb, max(left, piece.falls), piece.rises))
        waiting.append(_Interval(piece.a, piece.fa, x, fx, piece.falls, min(right, piece.rises)))
    return None
