"""Shares of dimensions in the variance of the result: by first derivatives, or by Sobol's indices.

    S_i  = 1 - E[(f(B) - f(A_B^i))^2] / 2V        first order: what knowing the dimension alone would take away
    ST_i =     E[(f(A) - f(A_B^i))^2] / 2V        total: what remains if all others are known

A and B are two independent sets of machines, A_B^i is A with the dimension i of B; V is the variance. Source: Jansen,
Analysis of variance designs for model output, Computer Physics Communications 117, 1999; Saltelli et al., Variance
based sensitivity analysis of model output, ibid. 181, 2010.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.tolerancing.dimensions.dimension import Dimension
from mbsd.tolerancing.statistics.derivatives import Evaluate, deviations, parts


@dataclass(frozen=True, eq=False)
class Sobol:
    """Sobol's indices of the dimensions."""

    first: np.ndarray
    """(d,) of first order; they add up to 1 where the dimensions do not act together."""
    total: np.ndarray
    """(d,) total."""
    machines: int
    """How many were evaluated."""
    failed: int
    """How many of them failed; what needs one of these is left out."""


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
