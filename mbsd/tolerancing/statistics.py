"""Statistics of tolerances: yields, worst cases, gains of halved tolerances, shares of dimensions.

The interval of a yield is Wilson's, with k of n good and z standard normal deviations:

    (k + z^2/2 -+ z sqrt(k (n - k) / n + z^2/4)) / (n + z^2)

The variance V of the result is shared among dimensions by first derivatives, or by Sobol's indices:

    S_i  = 1 - E[(f(B) - f(A_B^i))^2] / 2V        first order: what knowing the dimension alone would take away
    ST_i =     E[(f(A) - f(A_B^i))^2] / 2V        total: what remains if all others are known

A and B are two independent sets of machines, A_B^i is A with the dimension i of B. First derivatives by all deviations
are central differences in one batch; whoever has exact ones puts them into :func:`slopes`. Gains of halving one
tolerance or play are found by these derivatives, or on the same machines solved again where they do not serve.

Sources: Wilson, Probable inference, the law of succession, and statistical inference, J. Am. Stat. Assoc. 22, 1927;
Jansen, Analysis of variance designs for model output, Computer Physics Communications 117, 1999; Saltelli et al.,
Variance based sensitivity analysis of model output, ibid. 181, 2010.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.tolerancing.dimensions.dimension import Dimension

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


def linear_worst(middle: float, slopes: np.ndarray, dimensions: Sequence[Dimension]) -> tuple[float, float]:
    """Least and largest result by first derivatives about that in the ``middle`` of all tolerances."""
    swings = sum(d.swing(slopes[part]) for d, part in zip(dimensions, parts(dimensions), strict=True))
    return middle - swings, middle + swings


def vertex_worst(
    evaluate: Evaluate, middle: float, slopes: np.ndarray, dimensions: Sequence[Dimension]
) -> tuple[tuple[float, float], int]:
    """Return least and largest result at the 2^d corners of all tolerances, and how many corners fail.

    The ``middle`` counts too. A pin that lies anywhere in its bore lies on either side along its gradient.
    """
    sides = [
        (d.farthest(slopes[part], -1.0), d.farthest(slopes[part], 1.0))
        for d, part in zip(dimensions, parts(dimensions), strict=True)
    ]
    corners = np.array([np.concatenate(corner) for corner in itertools.product(*sides)])
    values = evaluate(corners)
    at = np.append(values[np.isfinite(values)], middle)
    return (float(at.min()), float(at.max())), int(np.isnan(values).sum())


CURVED = 0.1
"""Part by which the standard deviation by derivatives may be off."""
ROUNDING = 1e-11
"""Part of the largest result that is nothing."""
CHANCE = 3.0
"""Standard deviations of the standard deviation of n machines, which is nearly 1 / sqrt(2 n)."""


@dataclass(frozen=True, eq=False)
class Halving:
    """By dimension (d,): standard deviation of the result, and the part of machines within limits."""

    std: np.ndarray
    within: np.ndarray
    again: bool
    """True if all machines were solved again."""


def curved(values: np.ndarray, linear_std: float) -> bool:
    """Return True if derivatives miss the standard deviation of (n,) results by more than chance."""
    good = values[np.isfinite(values)]
    std, off = float(good.std(ddof=1)), CURVED + CHANCE / math.sqrt(2.0 * len(good))
    return abs(std - linear_std) > off * max(std, linear_std) + ROUNDING * float(np.abs(good).max())


def solved_again(values: np.ndarray, all_of_them: bool, count: int) -> np.ndarray:
    """Return (n,) mechanisms to be solved again for each of ``count`` dimensions.

    These are all, or those that failed if they are few.
    """
    failed = np.isnan(values)
    if all_of_them:
        return np.ones(len(values), bool)
    return failed if failed.sum() * count <= len(values) else np.zeros(len(values), bool)  # they stay failed


def halving(
    evaluate: Evaluate,
    dimensions: Sequence[Dimension],
    x: np.ndarray,
    values: np.ndarray,
    slopes: np.ndarray,
    again: np.ndarray,
    part_within: Callable[[np.ndarray], float],
) -> Halving:
    """Halve one tolerance after the other, and solve the mechanisms ``again`` (n,).

    The mechanisms are (n, columns), their results (n,).
    """
    out = np.zeros((2, len(dimensions)))
    for k, (dimension, part) in enumerate(zip(dimensions, parts(dimensions), strict=True)):
        other = x.copy()
        other[:, part] = dimension.halved(x[:, part])
        results = values + (other - x)[:, part] @ slopes[part]
        if again.any():
            results[again] = evaluate(other[again])
        out[:, k] = np.nanstd(results, ddof=1), part_within(results)
    return Halving(out[0], out[1], bool(again.all()))


@dataclass(frozen=True, eq=False)
class Sobol:
    """Sobol's indices of the dimensions."""

    first: np.ndarray
    """(d,) of first order; they add up to 1 where the dimensions do not act together."""
    total: np.ndarray
    """(d,) total."""
    machines: int
    """Number of evaluated mechanisms."""
    failed: int
    """Number of them that failed; results that need one of these are left out."""


def linear_variances(slopes: np.ndarray, dimensions: Sequence[Dimension]) -> np.ndarray:
    """(d,) what each adds to the variance of the result, by its first derivatives."""
    return np.array([d.variance(slopes[part]) for d, part in zip(dimensions, parts(dimensions), strict=True)])


def shares_of(variances: np.ndarray) -> np.ndarray:
    """(d,) parts of their sum; 0 where nothing strays."""
    total = variances.sum()
    return variances / total if total > 0.0 else np.zeros_like(variances)


def sobol_indices(evaluate: Evaluate, dimensions: Sequence[Dimension], power: int, seed: int) -> Sobol:
    """Sobol's indices from 2^power machines in each of d + 2 sets, scrambled Sobol points."""
    from scipy.stats.qmc import Sobol as Points

    width = sum(d.draws for d in dimensions)
    points = Points(2 * width, scramble=True, rng=np.random.default_rng(seed)).random_base2(power)
    a, b = (deviations(dimensions, u) for u in (points[:, :width], points[:, width:]))
    results = [evaluate(a), evaluate(b)]
    for part in parts(dimensions):
        own = a.copy()
        own[:, part] = b[:, part]
        results.append(evaluate(own))
    values = np.stack(results)
    good = np.isfinite(values).all(axis=0)
    f_a, f_b, mixed = values[0, good], values[1, good], values[2:, good]
    variance = float(np.concatenate([f_a, f_b]).var()) if good.any() else 0.0
    if variance == 0.0:
        none = np.zeros(len(dimensions))
        return Sobol(none, none, values.size, int(np.isnan(values).sum()))
    first = 1.0 - ((f_b - mixed) ** 2).mean(axis=1) / (2.0 * variance)
    total = ((f_a - mixed) ** 2).mean(axis=1) / (2.0 * variance)
    return Sobol(first, total, values.size, int(np.isnan(values).sum()))


Evaluate = Callable[[np.ndarray], np.ndarray]
"""(n,) results, NaN where a machine failed, of (n, columns) deviations."""


def middles(dimensions: Sequence[Dimension]) -> np.ndarray:
    """(columns,) deviations in the middle of all tolerances."""
    return np.concatenate([dimension.middle for dimension in dimensions])


def slopes(evaluate: Evaluate, dimensions: Sequence[Dimension]) -> np.ndarray:
    """(columns,) of the result in the middle of all tolerances, NaN where a machine beside it fails."""
    steps = np.repeat([d.step for d in dimensions], [len(d.columns) for d in dimensions])
    aside = np.diag(steps)
    middle = middles(dimensions)
    values = evaluate(np.concatenate([middle + aside, middle - aside]))
    return (values[: len(steps)] - values[len(steps) :]) / (2.0 * steps)


def parts(dimensions: Sequence[Dimension]) -> list[slice]:
    """The columns of each dimension."""
    ends = np.cumsum([len(dimension.columns) for dimension in dimensions]).tolist()
    return [slice(end - len(d.columns), end) for d, end in zip(dimensions, ends, strict=True)]


def drawn(dimensions: Sequence[Dimension], count: int, seed: int) -> np.ndarray:
    """(count, columns) independent deviations. The rows of a smaller count are the first of a larger one."""
    width = sum(dimension.draws for dimension in dimensions)
    return deviations(dimensions, np.random.default_rng(seed).random((count, width)))


def deviations(dimensions: Sequence[Dimension], u: np.ndarray) -> np.ndarray:
    """(n, columns) from numbers (n, draws) between 0 and 1."""
    out, first = [], 0
    for dimension in dimensions:
        out.append(dimension.draw(u[:, first : first + dimension.draws]).reshape(len(u), -1))
        first += dimension.draws
    return np.concatenate(out, axis=1)
