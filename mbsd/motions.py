"""Motion laws: f, f', f'' as functions of time, for drivers.

    constant rate   f = start + rate t
    harmonic        f = mean + amplitude sin(rate t + phase)
    polynomial      f = sum c_k t^k
    cycloidal       f = rise (u - sin(2 pi u) / 2 pi),  u = (t - begin) / duration, dwelling before and after
    table           quintic spline through the given values
    function        a Python callable with its derivatives, or a quintic spline fitted to it

A law takes times (T,) and returns (T, 3): value, rate, acceleration, in rad or m by seconds.
Source of the cycloidal law: Norton, Design of Machinery, ch. 8 (cam laws).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from mbsd.errors import ModelError

Times = np.ndarray


def _finite(law: str, **numbers: float) -> None:
    for name, value in numbers.items():
        if not math.isfinite(value):
            raise ModelError(f"{law}: {name} is {value}; it must be a finite number")


@dataclass(frozen=True)
class Motion:
    """Base of the laws. ``period`` (s) is the time after which the motion repeats, or None."""

    @property
    def period(self) -> float | None:
        """Time (s) of one turn or one swing; None if the law does not repeat."""
        return None

    def over(self, first: float, last: float) -> Motion:
        """The law made ready for times ``first`` .. ``last`` (s)."""
        return self

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        raise NotImplementedError


@dataclass(frozen=True)
class ConstantRate(Motion):
    """See :func:`constant_rate`."""

    rate: float
    start: float = 0.0

    @property
    def period(self) -> float | None:
        """One turn, for an angle."""
        return 2 * math.pi / abs(self.rate) if self.rate else None

    def __call__(self, times: Times) -> np.ndarray:
        out = np.zeros((len(times), 3))
        out[:, 0] = self.start + self.rate * times
        out[:, 1] = self.rate
        return out


def constant_rate(rate: float, start: float = 0.0) -> Motion:
    """``start + rate t``: rad and rad/s for an angle, m and m/s for a length."""
    _finite("constant_rate", rate=rate, start=start)
    return ConstantRate(float(rate), float(start))


@dataclass(frozen=True)
class Harmonic(Motion):
    """See :func:`harmonic`."""

    amplitude: float
    rate: float
    phase: float = 0.0
    mean: float = 0.0

    @property
    def period(self) -> float | None:
        """One swing."""
        return 2 * math.pi / abs(self.rate) if self.rate else None

    def __call__(self, times: Times) -> np.ndarray:
        angle = self.rate * times + self.phase
        sine, cosine = np.sin(angle), np.cos(angle)
        return np.stack(
            [
                self.mean + self.amplitude * sine,
                self.amplitude * self.rate * cosine,
                -self.amplitude * self.rate**2 * sine,
            ],
            axis=1,
        )


def harmonic(amplitude: float, rate: float, phase: float = 0.0, mean: float = 0.0) -> Motion:
    """``mean + amplitude sin(rate t + phase)``; rate in rad/s."""
    _finite("harmonic", amplitude=amplitude, rate=rate, phase=phase, mean=mean)
    return Harmonic(float(amplitude), float(rate), float(phase), float(mean))


@dataclass(frozen=True)
class Polynomial(Motion):
    """See :func:`polynomial`."""

    coefficients: tuple[float, ...]

    def __call__(self, times: Times) -> np.ndarray:
        law = np.polynomial.Polynomial(self.coefficients)
        return np.stack([law(times), law.deriv(1)(times), law.deriv(2)(times)], axis=1)


def polynomial(*coefficients: float) -> Motion:
    """``c0 + c1 t + c2 t^2 + ...``"""
    if not coefficients:
        raise ModelError("polynomial: give at least one coefficient, c0 first")
    _finite("polynomial", **{f"c{k}": c for k, c in enumerate(coefficients)})
    return Polynomial(tuple(float(c) for c in coefficients))


@dataclass(frozen=True)
class Cycloidal(Motion):
    """See :func:`cycloidal`."""

    rise: float
    duration: float
    begin: float = 0.0
    start: float = 0.0

    def __call__(self, times: Times) -> np.ndarray:
        u = np.clip((times - self.begin) / self.duration, 0.0, 1.0)
        turn = 2 * math.pi * u
        return np.stack(
            [
                self.start + self.rise * (u - np.sin(turn) / (2 * math.pi)),
                self.rise / self.duration * (1.0 - np.cos(turn)),
                self.rise / self.duration**2 * 2 * math.pi * np.sin(turn),
            ],
            axis=1,
        )


def cycloidal(rise: float, duration: float, begin: float = 0.0, start: float = 0.0) -> Motion:
    """From ``start`` to ``start + rise`` within ``duration`` seconds after ``begin``, at rest before and after."""
    _finite("cycloidal", rise=rise, duration=duration, begin=begin, start=start)
    if duration <= 0:
        raise ModelError(f"cycloidal: duration is {duration} s; it must be positive")
    return Cycloidal(float(rise), float(duration), float(begin), float(start))


@dataclass(frozen=True, eq=False)
class Table(Motion):
    """See :func:`table`."""

    times: np.ndarray
    values: np.ndarray
    periodic: bool = False
    _spline: list = field(default_factory=list, repr=False)

    @property
    def period(self) -> float | None:
        """The table's span, if it was declared periodic."""
        return float(self.times[-1] - self.times[0]) if self.periodic else None

    def __call__(self, times: Times) -> np.ndarray:
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
    t, f = np.asarray(times, float), np.asarray(values, float)
    if t.ndim != 1 or t.shape != f.shape or len(t) < 6:
        raise ModelError(f"table: times {t.shape} and values {f.shape} must be two lists of six numbers or more")
    if not (np.isfinite(t).all() and np.isfinite(f).all()):
        raise ModelError("table: times and values must be finite numbers")
    if not (np.diff(t) > 0).all():
        raise ModelError(f"table: times must rise; times[{int(np.argmin(np.diff(t) > 0)) + 1}] does not")
    if periodic and abs(f[-1] - f[0]) > 1e-12 * max(1.0, float(np.abs(f).max())):
        raise ModelError(f"table: periodic, but the last value {f[-1]:g} is not the first {f[0]:g}")
    if periodic:
        f = np.concatenate([f[:-1], f[:1]])
    return Table(t, f, periodic)


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
                change = float(np.abs(bend - coarse(between)[:, 2]).max() / max(1e-9, np.abs(bend).max()))
                if change < FIT_TOLERANCE:
                    return fine
            coarse = fine
        if coarse is None or change > FIT_REFUSED:
            raise ModelError(
                f"function: f'' from {FIT_INTERVALS[-1]} samples still changes by {change:.1e} of its size between "
                f"t = {first:g} and {last:g} s; the law is not smooth: give its derivatives df and ddf"
            )
        return coarse


FIT_INTERVALS = (128, 256, 512, 1024, 2048, 4096)
FIT_TOLERANCE = 1e-8
"""Relative change of f'' at which a fit is good."""
FIT_REFUSED = 1e-3
"""Relative change of f'' at the finest fit above which the law counts as not smooth."""


def _samples(f: Callable[[float], float], times: Times) -> np.ndarray:
    values = np.array([float(f(float(t))) for t in times])
    if not np.isfinite(values).all():
        bad = int(np.argmin(np.isfinite(values)))
        raise ModelError(f"function: the law gives {values[bad]} at t = {times[bad]:g} s; it must be finite")
    return values


def function(
    f: Callable[[float], float],
    df: Callable[[float], float] | None = None,
    ddf: Callable[[float], float] | None = None,
    period: float | None = None,
) -> Motion:
    """Any ``f(t)``. Give both derivatives if you can; else they come from a quintic spline fitted to f."""
    if (df is None) != (ddf is None):
        raise ModelError("function: give both derivatives df and ddf, or neither")
    if period is not None and not period > 0:
        raise ModelError(f"function: period is {period} s; it must be positive")
    return Function(f, df, ddf, period)


EXAMPLES: tuple[Motion, ...] = (
    constant_rate(1.3, 0.2),
    harmonic(0.4, 3.1, 0.3, 0.1),
    polynomial(0.3, -0.2, 0.7, 0.05),
    cycloidal(0.8, 1.1, 0.2, -0.1),
    table(np.linspace(-0.5, 2.5, 40), np.cos(np.linspace(-0.5, 2.5, 40))),
    table(np.linspace(0.0, 1.5, 41), np.sin(np.linspace(0.0, 2 * math.pi, 41)), periodic=True),
    function(math.sin, math.cos, lambda t: -math.sin(t)),
    function(lambda t: math.exp(-t) * math.sin(3 * t)),
)
"""At least one of every law; the test of all laws walks through them and refuses a law without one."""
