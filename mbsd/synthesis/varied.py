"""What a fit varies: names of lengths and places with their bounds, as one vector of numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown

Value = float | tuple[float, ...]
FORM = 'give "name": (lowest, highest), or for a place "name": ((lowest, highest), (lowest, highest))'


@dataclass(frozen=True)
class Varied:
    """Names, and the columns of the vector that are theirs."""

    sizes: dict[str, int]
    """Numbers of each name: 1 of a length, 2 of a place; 0 stands for a single number, which is no tuple."""
    low: np.ndarray
    high: np.ndarray
    """(k,) bounds in the units of the numbers themselves (m)."""

    @property
    def count(self) -> int:
        """How many numbers there are."""
        return len(self.low)

    def columns(self) -> list[tuple[str, slice, bool]]:
        """Each name, where its numbers are, and whether it is a single number."""
        out, first = [], 0
        for name, size in self.sizes.items():
            out.append((name, slice(first, first + max(size, 1)), size == 0))
            first += max(size, 1)
        return out

    def values(self, x: np.ndarray) -> dict[str, Value]:
        """By name, the numbers of a vector x (k,)."""
        return {
            name: float(x[part][0]) if single else tuple(float(v) for v in x[part])
            for name, part, single in self.columns()
        }


def varied(name: str, vary: Mapping[str, Any]) -> Varied:
    """Check ``vary`` of the mechanism called ``name``. Raises ModelError."""
    if not isinstance(vary, Mapping) or not vary:
        raise ModelError(f"{name}: fit_path: vary is {shown(vary)}; {FORM}")
    sizes: dict[str, int] = {}
    rows: list[tuple[float, float]] = []
    for key, bounds in vary.items():
        try:
            pairs = np.asarray(bounds, float)
        except (TypeError, ValueError):
            pairs = np.zeros(0)
        if not isinstance(key, str) or pairs.shape[-1:] != (2,) or pairs.ndim not in (1, 2) or not len(pairs):
            raise ModelError(f"{name}: fit_path: bounds of {shown(key)} are {shown(bounds)}; {FORM}")
        wrong = ~(np.isfinite(pairs).all(axis=-1) & (pairs[..., 0] < pairs[..., 1]))
        if wrong.any():
            low, high = np.atleast_2d(pairs)[np.atleast_1d(wrong)][0]
            raise ModelError(
                f"{name}: fit_path: '{key}' may be from {low:g} to {high:g}; the first must be smaller, both finite "
                "(leave out what keeps its value)"
            )
        sizes[key] = 0 if pairs.ndim == 1 else len(pairs)
        rows += [(float(low), float(high)) for low, high in np.atleast_2d(pairs)]
    bounds = np.array(rows)
    return Varied(sizes, bounds[:, 0], bounds[:, 1])
