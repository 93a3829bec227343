"""First derivatives of the result by all deviations, by central differences, all of them in one batch.

Whoever has exact derivatives of a result puts them in here: :func:`slopes` is all that the other files know of.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from mbsd.tolerancing.dimensions.dimension import Dimension

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
