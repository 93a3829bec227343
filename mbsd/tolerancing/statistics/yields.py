"""How many machines meet the limits, and how sure that is.

The interval is Wilson's (Probable inference, the law of succession, and statistical inference, J. Am. Stat. Assoc. 22,
1927): with k of n good and z standard normal deviations

    (k + z^2/2 -+ z sqrt(k (n - k) / n + z^2/4)) / (n + z^2)
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown

Limits = tuple[float | None, float | None]


class Yield(NamedTuple):
    """The part of machines within the limits, and its interval."""

    part: float
    low: float
    high: float


def limits_given(owner: str, limits: Any) -> Limits | None:
    """``limits``, a pair of numbers of which one may be None. Raises ModelError."""
    if limits is None:
        return None
    what = f"{owner}: tolerances: limits"
    if not isinstance(limits, tuple | list) or len(limits) != 2 or limits[0] is limits[1] is None:
        raise ModelError(f"{what} are {shown(limits)}; give (lowest, highest), of which one may be None")
    for name, value in zip(("lowest", "highest"), limits, strict=True):
        if isinstance(value, float) and math.isinf(value):
            raise ModelError(f"{what}: {name} is {value}; give None where there is no limit")
    low, high = (
        None if value is None else finite_number(f"{what}: {name}", value)
        for name, value in zip(("lowest", "highest"), limits, strict=True)
    )
    if low is not None and high is not None and low >= high:
        raise ModelError(f"{what} are from {low:g} to {high:g}; the lowest comes first")
    return low, high


def within(values: np.ndarray, limits: Limits) -> np.ndarray:
    """(n,) which meet the limits; those that failed do not."""
    low, high = limits
    good = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return good & (values >= (-np.inf if low is None else low)) & (values <= (np.inf if high is None else high))


def yield_of(values: np.ndarray, limits: Limits, confidence: float) -> Yield:
    """The part within the limits with its Wilson interval of that ``confidence``."""
    return wilson(int(within(values, limits).sum()), len(values), confidence)


def wilson(good: int, count: int, confidence: float) -> Yield:
    """Wilson's interval of ``good`` of ``count``."""
    from scipy.special import ndtri

    z = float(ndtri(0.5 + 0.5 * confidence))
    middle, room = good + 0.5 * z * z, z * math.sqrt(good * (count - good) / count + 0.25 * z * z)
    low, high = ((middle + side * room) / (count + z * z) for side in (-1.0, 1.0))
    return Yield(good / count, max(0.0, low), min(1.0, high))
