"""How a dimension strays within its tolerance: normal, uniform or triangular.

    Normal(5e-5)                  +- 0.05 mm are three standard deviations
    Uniform((-1e-5, 4e-5))        from 0.01 mm below to 0.04 mm above, all alike
    Triangular("m")               within the general tolerance of ISO 2768-1 of the dimension's size
    Normal("IT9")                 half of the standard tolerance of ISO 286-1 to either side (JS9)

Each is drawn by the inverse of its distribution from numbers between 0 and 1.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number, positive_number, several_numbers, switch
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.tolerancing.dimensions.standards import GENERAL, GRADES, general_tolerance, standard_tolerance

Tolerance = float | Sequence[float] | str
WANTED = "give a number t for +-t, a pair (lower, upper), a class of ISO 2768-1 such as 'm', or a grade such as 'IT7'"
GRADE = re.compile(r"IT(\d{1,2})")
FARTHEST = 8.3
"""Standard deviations beyond which no normal number of 53 bits lies."""


@dataclass(frozen=True)
class Spread:
    """A dimension that strays: by what, from its nominal size."""

    tolerance: Tolerance
    """A number t for +-t, a pair (lower, upper), a class "f", "m", "c", "v" or a grade "IT1" .. "IT16"."""

    def __post_init__(self) -> None:
        what = f"{type(self).__name__}: tolerance"
        if isinstance(self.tolerance, str):
            _refuse_no_class(what, self.tolerance)
            return
        self.limits  # noqa: B018  # refuses what is none

    @property
    def limits(self) -> tuple[float, float]:
        """Lower and upper deviation. Raises ModelError for what is no tolerance."""
        return limits_of(f"{type(self).__name__}: tolerance", self.tolerance)

    @property
    def middle(self) -> float:
        """Middle of the tolerance."""
        low, high = self.limits
        return 0.5 * (low + high)

    @property
    def half(self) -> float:
        """Half of the width of the tolerance."""
        low, high = self.limits
        return 0.5 * (high - low)

    @property
    def sigma(self) -> float:
        """Standard deviation."""
        raise NotImplementedError

    @property
    def reach(self) -> float:
        """How far from the middle a number can lie."""
        return self.half

    def deviations(self, u: np.ndarray) -> np.ndarray:
        """(n,) deviations from (n,) numbers between 0 and 1."""
        raise NotImplementedError

    def at_size(self, size: float | None) -> Any:
        """The same, a class made a number for a ``size`` (m). Raises ModelError where it has none."""
        if not isinstance(self.tolerance, str):
            return self
        if size is None:
            raise ModelError(f"class {self.tolerance} goes by the size of a length, and there is none; give a number")
        grade = GRADE.fullmatch(self.tolerance)
        half = 0.5 * standard_tolerance(size, int(grade[1])) if grade else general_tolerance(size, self.tolerance)
        return replace(self, tolerance=half)


@dataclass(frozen=True)
class Normal(Spread):
    """Normal, its mean in the middle of the tolerance, whose half width is ``sigmas`` standard deviations.

    ``cut``: what lies outside of the tolerance is sorted out, the rest is as it was.
    """

    sigmas: float = 3.0
    cut: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        positive_number("Normal: sigmas", self.sigmas)
        switch("Normal: cut", self.cut)

    @property
    def sigma(self) -> float:
        """Standard deviation."""
        s = self.sigmas
        if not self.cut:
            return self.half / s
        density = math.exp(-0.5 * s * s) / math.sqrt(2.0 * math.pi)
        return self.half / s * math.sqrt(1.0 - 2.0 * s * density / math.erf(s / math.sqrt(2.0)))

    @property
    def reach(self) -> float:
        """How far from the middle a number can lie."""
        return self.half if self.cut else self.half * max(1.0, FARTHEST / self.sigmas)

    def deviations(self, u: np.ndarray) -> np.ndarray:
        """(n,) deviations from (n,) numbers between 0 and 1."""
        from scipy.special import ndtr, ndtri

        if self.cut:
            low = ndtr(-self.sigmas)
            u = low + u * (1.0 - 2.0 * low)
        return self.middle + self.half / self.sigmas * ndtri(np.clip(u, 2.0**-54, 1.0 - 2.0**-53))


@dataclass(frozen=True)
class Uniform(Spread):
    """All sizes within the tolerance are equally likely."""

    @property
    def sigma(self) -> float:
        """Standard deviation."""
        return self.half / math.sqrt(3.0)

    def deviations(self, u: np.ndarray) -> np.ndarray:
        """(n,) deviations from (n,) numbers between 0 and 1."""
        return self.middle + self.half * (2.0 * u - 1.0)


@dataclass(frozen=True)
class Triangular(Spread):
    """The middle of the tolerance is the likeliest, its limits are never reached."""

    @property
    def sigma(self) -> float:
        """Standard deviation."""
        return self.half / math.sqrt(6.0)

    def deviations(self, u: np.ndarray) -> np.ndarray:
        """(n,) deviations from (n,) numbers between 0 and 1."""
        below = u < 0.5
        side = np.sqrt(2.0 * np.where(below, u, 1.0 - u)) - 1.0
        return self.middle + self.half * np.where(below, side, -side)


def spread_of(what: str, given: Any) -> Spread:
    """Return the spread of a dimension; a bare tolerance is :class:`Normal`.

    Raises ModelError.
    """
    if isinstance(given, Spread):
        return given
    if isinstance(given, str):
        _refuse_no_class(what, given)
        return Normal(given)
    low, high = limits_of(what, given)
    return Normal((low, high))


def limits_of(what: str, given: Any) -> tuple[float, float]:
    """A number t as (-t, t), a pair as it is. Raises ModelError."""
    if isinstance(given, int | float | np.floating | np.integer) and not isinstance(given, bool):
        half = finite_number(what, given)
        if half <= 0.0:
            raise ModelError(f"{what} is {half:g}; a tolerance is above 0 (leave out what does not stray)")
        return -half, half
    low, high = several_numbers(what, given, 2, WANTED)
    if low >= high:
        raise ModelError(f"{what} is from {low:g} to {high:g}; the lower limit comes first, and they differ")
    return low, high


def _refuse_no_class(what: str, name: str) -> None:
    grade = GRADE.fullmatch(name)
    if name not in GENERAL and (grade is None or int(grade[1]) not in GRADES):
        raise ModelError(f"{what} is {shown(name)}; {WANTED}")
