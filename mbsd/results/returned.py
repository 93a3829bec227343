"""Returns of a mechanism to where it was, moving as it moved."""

from __future__ import annotations

import math

import numpy as np

RETURNED = 1e-7
"""Largest difference between both ends of a period: m, rad and their rates, relative above 1."""


Ends = tuple[tuple[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def returned(ends: Ends) -> bool:
    """Return True if both ends have the same pose and rates (nb, 3) but for whole turns.

    Rates are velocities and accelerations.
    """
    first, last = ends
    for order, (start, end) in enumerate(zip(first, last, strict=True)):
        gap = end - start
        if order == 0:
            gap[:, 2] -= 2 * math.pi * (gap[:, 2] / 2 / math.pi).round()
        if np.abs(gap).max() > RETURNED * max(1.0, float(np.abs(start).max())):
            return False
    return True
