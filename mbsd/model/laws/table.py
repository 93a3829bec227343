"""Table: a quintic spline through given values."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.arguments import number_array, switch
from mbsd.base.errors import ModelError
from mbsd.model.laws.law import Motion, Times

if TYPE_CHECKING:
    from mbsd.model.laws.numbers import Compiled


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

    @property
    def given_derivatives(self) -> bool:
        """No: they follow from the numbers."""
        return False

    def knots(self, first: float, last: float) -> np.ndarray:
        """Its own times."""
        times = self.times
        if self.periodic:
            span = times[-1] - times[0]
            turns = np.arange(math.floor((first - times[0]) / span), math.floor((last - times[0]) / span) + 1)
            times = np.unique((times[:-1] + span * turns[:, None]).ravel())
        return times[(times >= first) & (times <= last)]

    def compiled(self, first: float, last: float) -> Compiled:
        """The spline's own pieces. Raises ModelError if the table does not cover ``first`` .. ``last`` (s)."""
        from mbsd.model.laws.numbers import spline_pieces

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
    t, f = number_array("table: times", times), number_array("table: values", values)
    periodic = switch("table: periodic", periodic)
    if t.ndim != 1 or t.shape != f.shape or len(t) < 6:
        raise ModelError(f"table: times {t.shape} and values {f.shape} must be two lists of six numbers or more")
    if not (np.diff(t) > 0).all():
        raise ModelError(f"table: times must rise; times[{int(np.argmin(np.diff(t) > 0)) + 1}] does not")
    if periodic and abs(f[-1] - f[0]) > 1e-12 * max(1.0, float(np.abs(f).max())):
        raise ModelError(f"table: periodic, but the last value {f[-1]:g} is not the first {f[0]:g}")
    if periodic:
        f = np.concatenate([f[:-1], f[:1]])
    return Table(t, f, periodic)
