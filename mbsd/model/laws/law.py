"""Motion laws: f, f', f'' as functions of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import finite_number, number_array
from mbsd.base.errors import ModelError
from mbsd.model.laws.fitting.sampling import look_times
from mbsd.model.laws.numbers import Compiled

Times = np.ndarray


def check_finite(law: str, **numbers: float) -> None:
    """Raise ModelError naming the first that is no finite number."""
    for name, value in numbers.items():
        finite_number(f"{law}: {name}", value)


@dataclass(frozen=True)
class Motion:
    """Base of the laws. ``period`` (s) is the time after which the motion repeats, or None."""

    @property
    def period(self) -> float | None:
        """Time (s) of one turn or one swing; None if the law does not repeat."""
        return None

    @property
    def given_derivatives(self) -> bool:
        """True if f' and f'' are given by the user, so that they may be wrong."""
        return True

    def knots(self, first: float, last: float) -> np.ndarray:
        """Rising times (s) in ``first`` .. ``last`` so close that the law does not turn back between two.

        A sweep looks at them where several lie between two of its outputs. A law of which nothing is known is looked at
        513 times.
        """
        return np.linspace(first, last, 513)

    def over(self, first: float, last: float) -> Motion:
        """The law made ready for times ``first`` .. ``last`` (s)."""
        return self

    def as_load(self, first: float, last: float) -> Motion:
        """The law made ready for ``first`` .. ``last`` (s) as a force or torque, of which f alone counts."""
        return self.over(first, last)

    def compiled(self, first: float, last: float) -> Compiled:
        """Return the law for kernels over ``first`` .. ``last`` (s): quintic pieces by default.

        Raises ModelError where f or f' jumps, and where f' and f'' are not the derivatives of f.
        """
        from mbsd.model.laws.fitting.exact import exact_pieces

        last = last if last > first else first + 1.0
        looks = look_times(first, last)
        return exact_pieces(self, first, last, (), looks, self(looks))

    def check_derivatives_at(self, time: float) -> None:
        """Raise ModelError where f' and f'' are not those of f within a second from ``time`` (s) on.

        Whatever else keeps the law from being made ready there is no matter of its value at ``time``.
        """
        from mbsd.model.laws.fitting.exact import DerivativeError

        try:
            self.compiled(time, time)
        except DerivativeError:
            raise
        except ModelError:
            return

    def __call__(self, times: Times) -> np.ndarray:
        """(T,) times to (T, 3): f, f', f''."""
        raise NotImplementedError


class Formula(Motion):
    """Base of laws whose f' and f'' follow from their own numbers."""

    @property
    def given_derivatives(self) -> bool:
        """Return False: nothing was given that could be wrong."""
        return False


def within(times: np.ndarray, first: float, last: float) -> np.ndarray:
    """Return those of ``times`` (n,) in ``first`` .. ``last`` (s)."""
    return times[(times >= first) & (times <= last)]


def rising_rows(law: str, fewest: int, finite: bool = True, **columns: object) -> tuple[np.ndarray, np.ndarray]:
    """Return two ``columns`` (n,), of which the first rises, n >= ``fewest``. Raises ModelError."""
    (x_name, x), (y_name, y) = ((name, number_array(f"{law}: {name}", c, finite)) for name, c in columns.items())
    if x.ndim != 1 or x.shape != y.shape or len(x) < fewest:
        raise ModelError(
            f"{law}: {x_name} {x.shape} and {y_name} {y.shape} must be two lists of {fewest} numbers or more"
        )
    if not finite and not (np.isfinite(x).all() and np.isfinite(y).all()):
        raise ModelError(f"{law}: {x_name} and {y_name} must be finite numbers; leave out rows without a value")
    if not (np.diff(x) > 0).all():
        raise ModelError(f"{law}: {x_name} must rise; {x_name}[{int(np.argmin(np.diff(x) > 0)) + 1}] does not")
    return x, y
