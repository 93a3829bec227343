"""Constant rate:  f = start + rate t"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.model.laws.law import Motion, Times, refuse_non_finite

if TYPE_CHECKING:
    from mbsd.model.laws.numbers import Compiled


@dataclass(frozen=True)
class ConstantRate(Motion):
    """See :func:`constant_rate`."""

    rate: float
    start: float = 0.0

    @property
    def period(self) -> float | None:
        """One turn, for an angle."""
        return 2 * math.pi / abs(self.rate) if self.rate else None

    @property
    def given_derivatives(self) -> bool:
        """No: they follow from the numbers."""
        return False

    def knots(self, first: float, last: float) -> np.ndarray:
        """None: it never turns back."""
        return np.zeros(0)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        from mbsd.base.codes import POLYNOMIAL

        return POLYNOMIAL, np.array([self.start, self.rate], float)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        out = np.zeros((len(times), 3))
        out[:, 0] = self.start + self.rate * times
        out[:, 1] = self.rate
        return out


def constant_rate(rate: float, start: float = 0.0) -> Motion:
    """``start + rate t``: rad and rad/s for an angle, m and m/s for a length."""
    refuse_non_finite("constant_rate", rate=rate, start=start)
    return ConstantRate(float(rate), float(start))
