"""Gains of halving the tolerance, or the play, of one dimension after the other.

The same machines with half of its deviations: by first derivatives where these serve, and solved again where they do
not and where a machine failed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.tolerancing.dimensions.dimension import Dimension
from mbsd.tolerancing.statistics.derivatives import Evaluate, parts

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
    """Whether all machines were solved again."""


def curved(values: np.ndarray, linear_std: float) -> bool:
    """Return True if derivatives miss the standard deviation of (n,) results by more than chance."""
    good = values[np.isfinite(values)]
    std, off = float(good.std(ddof=1)), CURVED + CHANCE / math.sqrt(2.0 * len(good))
    return abs(std - linear_std) > off * max(std, linear_std) + ROUNDING * float(np.abs(good).max())


def solved_again(values: np.ndarray, all_of_them: bool, count: int) -> np.ndarray:
    """(n,) machines to be solved again for each of ``count`` dimensions: all, or those that failed if they are few."""
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
    """Halve one tolerance after the other of machines (n, columns) with results (n,); solve those ``again`` (n,)."""
    out = np.zeros((2, len(dimensions)))
    for k, (dimension, part) in enumerate(zip(dimensions, parts(dimensions), strict=True)):
        other = x.copy()
        other[:, part] = dimension.halved(x[:, part])
        results = values + (other - x)[:, part] @ slopes[part]
        if again.any():
            results[again] = evaluate(other[again])
        out[:, k] = np.nanstd(results, ddof=1), part_within(results)
    return Halving(out[0], out[1], bool(again.all()))
