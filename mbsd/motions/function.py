"""Function: a Python callable with its derivatives, or a quintic spline fitted to it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mbsd.arguments import finite_number
from mbsd.errors import ModelError
from mbsd.motions.law import Motion, Times
from mbsd.motions.table import Table
from mbsd.shown import shown
from mbsd.users_function import value_at

FIT_INTERVALS = (128, 256, 512, 1024, 2048, 4096)
FIT_TOLERANCE = 1e-8
"""Relative change of f'' at which a fit is good."""
FIT_REFUSED = 1e-3
"""Relative change of f'' at the finest fit above which the law counts as not smooth."""


@dataclass(frozen=True, eq=False)
class Function(Motion):
    """See :func:`function`."""

    f: Callable[[float], float]
    df: Callable[[float], float] | None = None
    ddf: Callable[[float], float] | None = None
    repeats_after: float | None = None

    @property
    def period(self) -> float | None:
        """As declared by the user."""
        return self.repeats_after

    def over(self, first: float, last: float) -> Motion:
        """The spline fit over the span, unless the derivatives were given."""
        return self if self.df is not None else self._fit(first, last)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        if self.df is None or self.ddf is None:
            return self._fit(float(np.min(times)), float(np.max(times)))(times)
        return np.stack([_samples(law, times) for law in (self.f, self.df, self.ddf)], axis=1)

    def _fit(self, first: float, last: float) -> Motion:
        """Quintic spline through ever more samples, until its second derivative no longer changes."""
        if not last > first:
            last = first + 1.0
        coarse, change = None, math.inf
        for intervals in FIT_INTERVALS:
            nodes = np.linspace(first, last, intervals + 1)
            fine = Table(nodes, _samples(self.f, nodes))
            if coarse is not None:
                between = nodes[1::2]
                bend = fine(between)[:, 2]
                usual = (np.ptp(fine.values) + 1e-3 * np.abs(fine.values).max()) / (last - first) ** 2
                size = max(
                    float(np.abs(bend).max()), float(usual), 1e-300
                )  # a straight line has no f'' to compare with
                change = float(np.abs(bend - coarse(between)[:, 2]).max()) / size
                if change < FIT_TOLERANCE:
                    return fine
            coarse = fine
        if coarse is None or change > FIT_REFUSED:
            raise ModelError(
                f"function: f'' from {FIT_INTERVALS[-1]} samples still changes by {change:.1e} of its size between "
                f"t = {first:g} and {last:g} s; the law is not smooth: give its derivatives df and ddf"
            )
        return coarse


def _samples(f: Callable[[float], float], times: Times) -> np.ndarray:
    return np.array([value_at(f, float(t), "function: the law") for t in times])


def function(
    f: Callable[[float], float],
    df: Callable[[float], float] | None = None,
    ddf: Callable[[float], float] | None = None,
    period: float | None = None,
) -> Motion:
    """Any ``f(t)``. Give both derivatives if you can; else they come from a quintic spline fitted to f."""
    for name, law in (("f", f), ("df", df), ("ddf", ddf)):
        if not callable(law) and (law is not None or name == "f"):
            raise ModelError(f"function: {name} is {shown(law)}; it must be a function of the time (s)")
    if (df is None) != (ddf is None):
        raise ModelError("function: give both derivatives df and ddf, or neither")
    if period is not None and not finite_number("function: period", period) > 0:
        raise ModelError(f"function: period is {period} s; it must be positive")
    return Function(f, df, ddf, period)
