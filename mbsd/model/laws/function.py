"""Function: a Python callable with its derivatives, or pieces fitted to it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from mbsd.base.arguments import finite_number, value_at
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.base.pickled import WithFunctions
from mbsd.model.laws.fitting.sampling import Sampled, look_times
from mbsd.model.laws.formulas import polynomial
from mbsd.model.laws.law import Motion, Times, within
from mbsd.model.laws.numbers import Compiled, breaks_of, evaluated

TOLD = 1e-6
"""The fraction of a load that may be missed before it is reported."""
REMEDY = "give breaks= where it jumps, shortest= (s) if parts of it are short, or smooth it with recorded(...)"


@dataclass(frozen=True, eq=False)
class Function(WithFunctions, Motion):
    """See :func:`function`."""

    f: Callable[[float], float]
    df: Callable[[float], float] | None = None
    ddf: Callable[[float], float] | None = None
    repeats_after: float | None = None
    breaks: tuple[float, ...] = ()
    shortest: float | None = None

    @property
    def period(self) -> float | None:
        """As declared by the user."""
        return self.repeats_after

    @property
    def given_derivatives(self) -> bool:
        """True if the user gave them."""
        return self.df is not None

    def over(self, first: float, last: float) -> Motion:
        """The fit over the span, unless the derivatives were given."""
        return self if self.df is not None else self._fit(first, last if last > first else first + 1.0, load=False)

    def as_load(self, first: float, last: float) -> Motion:
        """The fit of f alone over the span; f may jump."""
        return self._fit(first, last, load=True) if last > first else polynomial(self._values(np.array([first]))[0])

    def compiled(self, first: float, last: float) -> Compiled:
        """Pieces over the span."""
        if self.df is None or self.ddf is None:
            return self.over(first, last).compiled(first, last)
        from mbsd.model.laws.fitting.exact import exact_pieces

        last = last if last > first else first + 1.0
        looks = look_times(first, last, self.shortest)
        return exact_pieces(self, first, last, self.breaks, looks, self(looks))

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where a pulse cannot hide, and its breaks."""
        times = np.unique(np.concatenate([look_times(first, last, self.shortest), self.breaks]))
        return within(times, first, last)

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        if self.df is None or self.ddf is None:
            return self.over(float(np.min(times)), float(np.max(times)))(times)
        return np.stack([_samples(law, times) for law in (self.f, self.df, self.ddf)], axis=1)

    def _values(self, times: Times) -> np.ndarray:
        return _samples(self.f, times)

    def _fit(self, first: float, last: float, load: bool) -> Fitted:
        from mbsd.model.laws.fitting.fit import fit, fit_pieces
        from mbsd.model.laws.fitting.leaves import given_cuts

        looks, sampled = look_times(first, last, self.shortest), Sampled(self._values)
        fitted = fit(sampled, first, last, given_cuts(self.breaks, first, last), looks, load)
        made, cuts, jumps = fit_pieces(fitted, load)
        missed, where = None, f"near t = {fitted.missed_at:.6g} s"
        if fitted.overrun and not load:
            raise ModelError(
                f"function: the law is not smooth: {sampled.count} values do not determine f'' {where}; {REMEDY}"
            )
        if load and fitted.missed > TOLD * fitted.size:
            missed = (
                f"{sampled.count} values do not determine the law: {fitted.missed:.2g} of it is missed {where}; "
                f"{REMEDY}"
            )
        elif fitted.missed and not load:
            missed = (
                f"f'' is uncertain by {fitted.missed:.2g} {where}, where a derivative grows without bound; {REMEDY}"
            )
        return Fitted(
            self.f,
            repeats_after=self.repeats_after,
            breaks=tuple(cuts),
            shortest=self.shortest,
            law=made,
            first=first,
            last=last,
            jumps=tuple(jumps),
            missed=missed,
        )


@dataclass(frozen=True, eq=False)
class Fitted(Function):
    """Function as pieces between ``first`` and ``last`` (s); at ``breaks`` it or a derivative jumps."""

    law: Compiled = field(default=(0, np.zeros(1)))
    first: float = 0.0
    last: float = 0.0
    jumps: tuple[float, ...] = ()
    """Times at which f itself jumps."""
    missed: str | None = None
    """The part that could not be fitted, in words."""

    @property
    def given_derivatives(self) -> bool:
        """No: they follow from the fit."""
        return False

    def over(self, first: float, last: float) -> Motion:
        """Itself: it was made for one span."""
        return self

    def as_load(self, first: float, last: float) -> Motion:
        """Itself."""
        return self

    def knots(self, first: float, last: float) -> np.ndarray:
        """Where its pieces meet, and their middles."""
        breaks = breaks_of(self.law)
        times = np.sort(np.concatenate([breaks, 0.5 * (breaks[1:] + breaks[:-1])]))
        return within(times, first, last)

    def compiled(self, first: float, last: float) -> Compiled:
        """As kernels evaluate it."""
        return self.law

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''. Raises ModelError beyond the span it was fitted to."""
        times = np.ascontiguousarray(times, float)
        beyond = 1e-9 * (self.last - self.first)
        if len(times) and (times.min() < self.first - beyond or times.max() > self.last + beyond):
            raise ModelError(
                f"function: asked for t = {times.min():g} .. {times.max():g} s, it was fitted to {self.first:g} .. "
                f"{self.last:g} s"
            )
        return evaluated(self.law, times)


def _samples(f: Callable[[float], float], times: Times) -> np.ndarray:
    return np.array([value_at(f, float(t), "function: the law") for t in times])


def function(
    f: Callable[[float], float],
    df: Callable[[float], float] | None = None,
    ddf: Callable[[float], float] | None = None,
    period: float | None = None,
    breaks: Sequence[float] = (),
    shortest: float | None = None,
) -> Motion:
    """Any ``f(t)``. Give both derivatives if you can; else they come from a fit to f.

    The fit looks at 4180 times beside its nodes, so it sees what lasts 1/3500 of the span or longer, and looks closer
    where something happens. ``shortest`` (s): how long the shortest thing in it lasts, if that is less, or to save
    calls if it is more. ``breaks`` (s): where f or a derivative jumps; most of these are found without. f of a force
    or torque may jump, f and f' of a driver may not.
    """
    for name, law in (("f", f), ("df", df), ("ddf", ddf)):
        if not callable(law) and (law is not None or name == "f"):
            raise ModelError(f"function: {name} is {shown(law)}; it must be a function of the time (s)")
    if (df is None) != (ddf is None):
        raise ModelError("function: give both derivatives df and ddf, or neither")
    if period is not None and not finite_number("function: period", period) > 0:
        raise ModelError(f"function: period is {period} s; it must be positive")
    return Function(f, df, ddf, period, *checked_pulses("function", breaks, shortest))


def checked_pulses(what: str, breaks: object, shortest: object) -> tuple[tuple[float, ...], float | None]:
    """``breaks`` and ``shortest`` (s) as numbers. Raises ModelError, which begins with ``what``."""
    try:
        at = tuple(float(t) for t in np.ravel(np.asarray(breaks, float)))
    except (TypeError, ValueError):
        at = (math.nan,)
    if not all(map(math.isfinite, at)):
        raise ModelError(f"{what}: breaks is {breaks!r}; it must be a list of times (s)")
    if shortest is None:
        return at, None
    if isinstance(shortest, bool) or not isinstance(shortest, int | float | np.number) or not 0 < shortest < math.inf:
        raise ModelError(f"{what}: shortest is {shortest!r} s; it must be a positive time, or None")
    return at, float(shortest)
