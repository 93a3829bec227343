"""Laws and curves moved by a constant, or with their sign changed, each as a law of its own kind where it has one."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.formulas import ConstantRate, Cycloidal, Harmonic, Polynomial
from mbsd.model.laws.splines import Recorded, Table


@dataclass(frozen=True, eq=False)
class Raised(Motion):
    """sign times a law, and a constant."""

    law: Motion
    by: float
    sign: float

    @property
    def period(self) -> float | None:
        """That of the law."""
        return self.law.period

    def over(self, first: float, last: float) -> Motion:
        """The law made ready."""
        return Raised(self.law.over(first, last), self.by, self.sign)

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """(T,) times to (T, 3)."""
        return self.sign * self.law(times) + np.array([self.by, 0.0, 0.0])


def raised(law: Motion, by: float, sign: float = 1.0) -> Motion:
    """sign * law + by."""
    if by == 0.0 and sign == 1.0:
        return law
    if isinstance(law, ConstantRate):
        return replace(law, rate=sign * law.rate, start=sign * law.start + by)
    if isinstance(law, Harmonic):
        return replace(law, amplitude=sign * law.amplitude, mean=sign * law.mean + by)
    if isinstance(law, Cycloidal):
        return replace(law, rise=sign * law.rise, start=sign * law.start + by)
    if isinstance(law, Polynomial):
        first, *rest = law.coefficients
        return Polynomial((sign * first + by, *(sign * c for c in rest)))
    if isinstance(law, Table):
        return Table(law.times, sign * law.values + by, law.periodic)
    if isinstance(law, Recorded) and law.noise is not None:
        return Recorded(law.times, sign * law.values + by, law.noise)
    return Raised(law, by, sign)


def raised_curve(curve: Curve, by: float) -> Curve:
    """The same curve, its x counted from elsewhere."""
    return Curve(curve.x + by, curve.y, curve.kind)
