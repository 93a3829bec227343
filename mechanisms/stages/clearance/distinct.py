"""Rows that are alike, found by a hash of each row: an order of magnitude quicker than sorting whole rows."""

from __future__ import annotations

import numpy as np

_FACTORS = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x27D4EB2F165667C5], dtype=np.uint64)
"""Odd numbers without a pattern, one for each column."""


def distinct(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct rows of (n, k) float64, k up to 4: one number of each, and (n,) which of these each row is.

    Their order follows from the rows alone. -0.0 and 0.0 are alike; no row is like another that is not.
    """
    bits = np.ascontiguousarray(rows + 0.0).view(np.uint64)
    mixed = np.zeros(len(bits), dtype=np.uint64)
    for column, factor in zip(bits.T, _FACTORS, strict=False):
        mixed = (mixed ^ column) * factor
        mixed ^= mixed >> np.uint64(29)
    _, first, which = np.unique(mixed, return_index=True, return_inverse=True)
    if not np.array_equal(bits[first][which], bits):  # two rows of one hash
        _, first, which = np.unique(bits, axis=0, return_index=True, return_inverse=True)
    return first, which.ravel()
