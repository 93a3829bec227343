"""Characteristic curves: a force or torque over a length, an angle or a speed, from points.

    smooth   a cubic that keeps rises and falls of the points (Fritsch, Carlson 1980, SIAM J. Numer. Anal. 17)
    linear   straight lines
    spline   the cubic B-spline through the points

Beyond the first and last point a curve goes on along its tangent.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.laws.law import rising_rows
from mbsd.model.laws.numbers import Compiled, polynomial_pieces

KINDS = ("smooth", "linear", "spline")


@dataclass(frozen=True, eq=False)
class Curve:
    """See :func:`curve`."""

    x: np.ndarray
    y: np.ndarray
    kind: str = "smooth"

    @cached_property
    def pieces(self) -> Any:
        """scipy PPoly over the points."""
        from scipy.interpolate import PchipInterpolator, PPoly, make_interp_spline

        if self.kind == "linear":
            return PPoly(np.stack([np.diff(self.y) / np.diff(self.x), self.y[:-1]]), self.x)
        if self.kind == "spline":
            return PPoly.from_spline(make_interp_spline(self.x, self.y, k=3))
        smooth = PchipInterpolator(self.x, self.y)
        return PPoly(smooth.c, smooth.x)

    def __call__(self, x: np.ndarray) -> np.ndarray:
        """(T,) to (T, 3): value, first and second derivative."""
        x = np.asarray(x, float)
        inside = np.clip(x, self.x[0], self.x[-1])
        value, slope, bend = (self.pieces(inside, order) for order in range(3))
        beyond = x - inside
        return np.stack([value + slope * beyond, slope, np.where(beyond == 0.0, bend, 0.0)], axis=-1)

    def integral(self, x: np.ndarray) -> np.ndarray:
        """(T,) of the curve from its first point to x."""
        x = np.asarray(x, float)
        inside = np.clip(x, self.x[0], self.x[-1])
        beyond = x - inside
        return self.pieces.antiderivative()(inside) + beyond * (
            self.pieces(inside) + beyond * self.pieces(inside, 1) / 2
        )

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        return polynomial_pieces(self.pieces)


def curve(x: object, y: object, kind: str = "smooth") -> Curve:
    """A curve through the points (x, y), x rising (m, rad, m/s or rad/s), y a force or torque (N, N m)."""
    if not isinstance(kind, str) or kind not in KINDS:
        raise ModelError(f"curve: {no_such('kind', kind, KINDS)}")
    return Curve(*rising_rows("curve", 4 if kind == "spline" else 2, x=x, y=y), kind)
