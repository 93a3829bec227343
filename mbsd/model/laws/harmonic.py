"""Harmonic:  f = mean + amplitude sin(rate t + phase)"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.model.laws.law import Motion, Times, refuse_non_finite

if TYPE_CHECKING:
    from mbsd.model.laws.numbers import Compiled


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

    @property
    def given_derivatives(self) -> bool:
        """No: they follow from the numbers."""
        return False

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where it turns back."""
        if not (self.rate and self.amplitude):
            return np.zeros(0)
        ends = sorted((self.rate * time + self.phase) / math.pi - 0.5 for time in (first, last))
        turns = np.arange(math.ceil(ends[0]), math.floor(ends[1]) + 1)
        return np.sort(((turns + 0.5) * math.pi - self.phase) / self.rate)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        from mbsd.base.codes import HARMONIC

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
    refuse_non_finite("harmonic", amplitude=amplitude, rate=rate, phase=phase, mean=mean)
    return Harmonic(float(amplitude), float(rate), float(phase), float(mean))
