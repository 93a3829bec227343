"""Polynomial:  f = c0 + c1 t + c2 t^2 + ..."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.model.laws.law import Motion, Times, refuse_non_finite

if TYPE_CHECKING:
    from mbsd.model.laws.numbers import Compiled


@dataclass(frozen=True)
class Polynomial(Motion):
    """See :func:`polynomial`."""

    coefficients: tuple[float, ...]

    @property
    def given_derivatives(self) -> bool:
        """No: they follow from the numbers."""
        return False

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where it turns back."""
        roots = np.polynomial.Polynomial(self.coefficients).deriv().roots()
        turns = np.sort(roots.real[np.abs(roots.imag) <= 1e-6 * np.abs(roots)])
        return turns[(turns >= first) & (turns <= last)]

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        from mbsd.base.codes import POLYNOMIAL

        return POLYNOMIAL, np.array(self.coefficients, float)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        law = np.polynomial.Polynomial(self.coefficients)
        return np.stack([law(times), law.deriv(1)(times), law.deriv(2)(times)], axis=1)


def polynomial(*coefficients: float) -> Motion:
    """``c0 + c1 t + c2 t^2 + ...``"""
    if not coefficients:
        raise ModelError("polynomial: give at least one coefficient, c0 first")
    refuse_non_finite("polynomial", **{f"c{k}": c for k, c in enumerate(coefficients)})
    return Polynomial(tuple(float(c) for c in coefficients))
