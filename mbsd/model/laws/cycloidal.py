"""Cycloidal law:  f = start + rise (u - sin(2 pi u) / 2 pi),  u = (t - begin) / duration.

It dwells before and after.

Source: Norton, Design of Machinery, ch. 8 (cam laws).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.laws.law import Motion, Times, refuse_non_finite

if TYPE_CHECKING:
    from mbsd.model.laws.numbers import Compiled


@dataclass(frozen=True)
class Cycloidal(Motion):
    """See :func:`cycloidal`."""

    rise: float
    duration: float
    begin: float = 0.0
    start: float = 0.0

    def __post_init__(self) -> None:
        if self.duration <= 0:
            raise ModelError(f"cycloidal: duration is {self.duration} s; it must be positive")

    @property
    def given_derivatives(self) -> bool:
        """No: they follow from the numbers."""
        return False

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where it begins and ends; it never turns back."""
        times = np.array([self.begin, self.begin + self.duration])
        return times[(times >= first) & (times <= last)]

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        from mbsd.base.codes import CYCLOIDAL

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
    refuse_non_finite("cycloidal", rise=rise, duration=duration, begin=begin, start=start)
    return Cycloidal(float(rise), float(duration), float(begin), float(start))
