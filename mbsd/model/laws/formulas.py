"""Laws by a formula: constant rate, harmonic, polynomial, cycloidal rise.

Constant rate:  f = start + rate t

Harmonic:  f = mean + amplitude sin(rate t + phase)

Polynomial:  f = c0 + c1 t + c2 t^2 + ...

Cycloidal law:  f = start + rise (u - sin(2 pi u) / 2 pi),  u = (t - begin) / duration.

It dwells before and after.

Source: Norton, Design of Machinery, ch. 8 (cam laws).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.base.codes import CYCLOIDAL, HARMONIC, POLYNOMIAL
from mbsd.base.errors import ModelError
from mbsd.model.laws.law import Formula, Motion, Times, check_finite, within
from mbsd.model.laws.numbers import Compiled


@dataclass(frozen=True)
class ConstantRate(Formula):
    """See :func:`constant_rate`."""

    rate: float
    start: float = 0.0

    @property
    def period(self) -> float | None:
        """One turn, for an angle."""
        return 2 * math.pi / abs(self.rate) if self.rate else None

    def knots(self, first: float, last: float) -> np.ndarray:
        """None: it never turns back."""
        return np.zeros(0)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        return POLYNOMIAL, np.array([self.start, self.rate], float)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        out = np.zeros((len(times), 3))
        out[:, 0] = self.start + self.rate * times
        out[:, 1] = self.rate
        return out


def constant_rate(rate: float, start: float = 0.0) -> Motion:
    """``start + rate t``: rad and rad/s for an angle, m and m/s for a length."""
    check_finite("constant_rate", rate=rate, start=start)
    return ConstantRate(float(rate), float(start))


@dataclass(frozen=True)
class Harmonic(Formula):
    """See :func:`harmonic`."""

    amplitude: float
    rate: float
    phase: float = 0.0
    mean: float = 0.0

    @property
    def period(self) -> float | None:
        """One swing."""
        return 2 * math.pi / abs(self.rate) if self.rate else None

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where it turns back."""
        if not (self.rate and self.amplitude):
            return np.zeros(0)
        ends = sorted((self.rate * time + self.phase) / math.pi - 0.5 for time in (first, last))
        turns = np.arange(math.ceil(ends[0]), math.floor(ends[1]) + 1)
        return np.sort(((turns + 0.5) * math.pi - self.phase) / self.rate)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        return HARMONIC, np.array([self.amplitude, self.rate, self.phase, self.mean], float)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
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
    check_finite("harmonic", amplitude=amplitude, rate=rate, phase=phase, mean=mean)
    return Harmonic(float(amplitude), float(rate), float(phase), float(mean))


@dataclass(frozen=True)
class Polynomial(Formula):
    """See :func:`polynomial`."""

    coefficients: tuple[float, ...]

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where it turns back."""
        roots = np.polynomial.Polynomial(self.coefficients).deriv().roots()
        turns = np.sort(roots.real[np.abs(roots.imag) <= 1e-6 * np.abs(roots)])
        return within(turns, first, last)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        return POLYNOMIAL, np.array(self.coefficients, float)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        law = np.polynomial.Polynomial(self.coefficients)
        return np.stack([law(times), law.deriv(1)(times), law.deriv(2)(times)], axis=1)


def polynomial(*coefficients: float) -> Motion:
    """``c0 + c1 t + c2 t^2 + ...``"""
    if not coefficients:
        raise ModelError("polynomial: give at least one coefficient, c0 first")
    check_finite("polynomial", **{f"c{k}": c for k, c in enumerate(coefficients)})
    return Polynomial(tuple(float(c) for c in coefficients))


@dataclass(frozen=True)
class Cycloidal(Formula):
    """See :func:`cycloidal`."""

    rise: float
    duration: float
    begin: float = 0.0
    start: float = 0.0

    def __post_init__(self) -> None:
        if self.duration <= 0:
            raise ModelError(f"cycloidal: duration is {self.duration} s; it must be positive")

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where it begins and ends; it never turns back."""
        return within(np.array([self.begin, self.begin + self.duration]), first, last)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        return CYCLOIDAL, np.array([self.rise, self.duration, self.begin, self.start], float)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
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
    """Return a rise from ``start`` by ``rise`` within ``duration`` (s) after ``begin``, else at rest."""
    check_finite("cycloidal", rise=rise, duration=duration, begin=begin, start=start)
    return Cycloidal(float(rise), float(duration), float(begin), float(start))
