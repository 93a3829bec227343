"""The worst case: all dimensions at the limits of their tolerances, where each does the most harm."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from mbsd.tolerancing.dimensions.dimension import Dimension
from mbsd.tolerancing.statistics.derivatives import Evaluate, parts


def linear_worst(middle: float, slopes: np.ndarray, dimensions: Sequence[Dimension]) -> tuple[float, float]:
    """Least and largest result by first derivatives about that in the ``middle`` of all tolerances."""
    swings = sum(d.swing(slopes[part]) for d, part in zip(dimensions, parts(dimensions), strict=True))
    return middle - swings, middle + swings


def vertex_worst(
    evaluate: Evaluate, middle: float, slopes: np.ndarray, dimensions: Sequence[Dimension]
) -> tuple[tuple[float, float], int]:
    """Least and largest result at the 2^d corners of all tolerances and in the ``middle``, and how many corners fail.

    A pin that lies anywhere in its bore lies on either side along its gradient.
    """
    sides = [
        (d.farthest(slopes[part], -1.0), d.farthest(slopes[part], 1.0))
        for d, part in zip(dimensions, parts(dimensions), strict=True)
    ]
    corners = np.array([np.concatenate(corner) for corner in itertools.product(*sides)])
    values = evaluate(corners)
    at = np.append(values[np.isfinite(values)], middle)
    return (float(at.min()), float(at.max())), int(np.isnan(values).sum())
