"""Numbers of chance: deviations of n machines from a seed, the same bytes from the same seed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.tolerancing.dimensions.dimension import Dimension


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
