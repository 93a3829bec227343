"""Laws by a spline of degree 5: through the rows of a table, or smoothed through measured values.

Table: a quintic spline through given values.

Recorded: a smoothing spline through measured values.

The spline of degree 5 with the fewest knots whose mean square distance to the values is noise^2, so that its second
derivative is smooth and does not follow the noise. Where the noise is not known it is estimated from the
gaps between each value and the quintic through its six neighbours, w the weights of these:

    noise^2 = mean of gap^2 / (1 + sum of w^2)

Sources: Dierckx, Curve and Surface Fitting with Splines, 1993, ch. 5 (fewest knots); Gasser, Sroka, Jennen-Steinmetz,
Biometrika 73 (1986) 625 (noise from neighbours).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number, switch
from mbsd.base.errors import ModelError
from mbsd.model.laws.law import Formula, Motion, Times, rising_rows, within
from mbsd.model.laws.numbers import Compiled, spline_pieces


@dataclass(frozen=True, eq=False)
class Table(Formula):
    """See :func:`table`."""

    times: np.ndarray
    values: np.ndarray
    periodic: bool = False
    _spline: list = field(default_factory=list, repr=False)

    @property
    def period(self) -> float | None:
        """The table's span, if it was declared periodic."""
        return float(self.times[-1] - self.times[0]) if self.periodic else None

    def knots(self, first: float, last: float) -> np.ndarray:
        """Its own times."""
        times = self.times
        if self.periodic:
            span = times[-1] - times[0]
            turns = np.arange(math.floor((first - times[0]) / span), math.floor((last - times[0]) / span) + 1)
            times = np.unique((times[:-1] + span * turns[:, None]).ravel())
        return within(times, first, last)

    def compiled(self, first: float, last: float) -> Compiled:
        """The spline's own pieces. Raises ModelError if the table does not cover ``first`` .. ``last`` (s)."""
        self(np.array([first, last]))
        return spline_pieces(self._spline[0], self.periodic)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        first, last = self.times[0], self.times[-1]
        if not self._spline:
            from scipy.interpolate import make_interp_spline

            ends = "periodic" if self.periodic else None
            self._spline.append(make_interp_spline(self.times, self.values, k=5, bc_type=ends))
        if self.periodic:
            times = first + np.mod(times - first, last - first)
        elif np.min(times) < first - 1e-12 or np.max(times) > last + 1e-12:
            raise ModelError(
                f"table: asked for t = {np.min(times):g} .. {np.max(times):g} s, "
                f"the table covers {first:g} .. {last:g} s; add rows, or declare it periodic"
            )
        spline = self._spline[0]
        return np.stack([spline(times), spline(times, 1), spline(times, 2)], axis=1)


def table(times: object, values: object, periodic: bool = False) -> Motion:
    """Quintic spline through ``values`` (rad or m) at rising ``times`` (s), six rows or more.

    ``periodic``: the last value equals the first and the motion repeats with continuous derivatives.
    """
    periodic = switch("table: periodic", periodic)
    t, f = rising_rows("table", 6, times=times, values=values)
    if periodic and abs(f[-1] - f[0]) > 1e-12 * max(1.0, float(np.abs(f).max())):
        raise ModelError(f"table: periodic, but the last value {f[-1]:g} is not the first {f[0]:g}")
    if periodic:
        f = np.concatenate([f[:-1], f[:1]])
    return Table(t, f, periodic)


LEAST_ROWS = 8


@dataclass(frozen=True, eq=False)
class Recorded(Formula):
    """See :func:`recorded`."""

    times: np.ndarray
    values: np.ndarray
    noise: float | None = None

    @cached_property
    def spline(self) -> Any:
        """scipy BSpline of degree 5."""
        from scipy.interpolate import make_splrep

        noise = estimated_noise(self.times, self.values) if self.noise is None else self.noise
        return make_splrep(self.times, self.values, k=5, s=len(self.times) * noise**2)  # pyright: ignore[reportArgumentType]

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where the pieces of its spline meet."""
        return within(np.unique(self.spline.t), first, last)

    def compiled(self, first: float, last: float) -> Compiled:
        """The spline's own pieces. Raises ModelError if the record does not cover ``first`` .. ``last`` (s)."""
        self(np.array([first, last]))
        return spline_pieces(self.spline)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        first, last = self.times[0], self.times[-1]
        if np.min(times) < first - 1e-12 or np.max(times) > last + 1e-12:
            raise ModelError(
                f"recorded: asked for t = {np.min(times):g} .. {np.max(times):g} s, the record covers {first:g} .. "
                f"{last:g} s; end the motion there"
            )
        return np.stack([self.spline(times, order) for order in range(3)], axis=1)


def estimated_noise(times: np.ndarray, values: np.ndarray) -> float:
    """Standard deviation of the noise in values (n,) at rising times (n,), n at least 8."""
    squares = []
    for k in range(3, len(times) - 3):
        near = np.array([k - 3, k - 2, k - 1, k + 1, k + 2, k + 3])
        gaps = times[near][:, None] - times[near]
        ratio = np.where(np.eye(6, dtype=bool), 1.0, (times[k] - times[near]) / np.where(gaps == 0, 1.0, gaps))
        weights = ratio.prod(axis=1)  # Lagrange
        squares.append((values[k] - weights @ values[near]) ** 2 / (1.0 + weights @ weights))
    return float(np.sqrt(np.mean(squares)))


def recorded(times: object, values: object, noise: float | None = None) -> Motion:
    """Smooth motion from measured ``values`` (rad or m) at rising ``times`` (s), eight rows or more.

    ``noise``: standard deviation of a value (rad or m), 0 for values without any; None estimates it.
    """
    t, f = rising_rows("recorded", LEAST_ROWS, finite=False, times=times, values=values)
    if noise is not None and finite_number("recorded: noise", noise) < 0:
        raise ModelError(f"recorded: noise is {noise}; it must be zero or positive, or None to estimate it")
    return Recorded(t, f, None if noise is None else float(noise))
