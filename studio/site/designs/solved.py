"""Mechanism solved with any numbers of its Params, as vectors that can be added."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from mbsd.base.errors import MechanismError
from shared.stage.errors import UserError
from studio.live.child.author import Author
from studio.site.designs.leaves import Unlike, leaves, thinned, vector, where

PLACES = ("x", "y")
EFFORTS = ("effort", "fx", "fy", "torque")


class Solved:
    """Designs of one mechanism; ``patience`` (s) bounds the time of all of them together."""

    def __init__(self, author: Author, patience: float) -> None:
        self.author = author
        self.ends = time.monotonic() + patience
        author.payload({})  # a whole one, whose symbols the quick ones keep
        self.payload = thinned(author.payload({}, quick=True))
        self.base = list(leaves(self.payload))
        self.usual = vector(self.payload)
        self.places, self.efforts = where(self.base, *PLACES), where(self.base, *EFFORTS)
        low, high = (np.array(self.payload["skeleton"][end]) for end in ("low", "high"))
        self.size = float(np.max(high - low))
        """m, of all that the machine sweeps."""
        self._kept: dict[tuple[tuple[str, float], ...], np.ndarray | None] = {}

    @property
    def is_late(self) -> bool:
        """True if the time is up."""
        return time.monotonic() > self.ends

    def numbers_at(self, values: Mapping[str, float]) -> np.ndarray | None:
        """Return the numbers of a design, (N,); None if it is not solved to its end or differs in form."""
        key = tuple(sorted(values.items()))
        if key not in self._kept:
            self._kept[key] = None if self.is_late else self._solve(dict(values))
        return self._kept[key]

    def away(self, first: np.ndarray, second: np.ndarray) -> tuple[float, float]:
        """Return how far two designs differ, relative to the machine's size and to its largest effort."""
        gap = np.abs(first - second)
        largest = max(float(np.abs(self.usual[self.efforts]).max(initial=0.0)), 1e-12)
        places = float(gap[self.places].max(initial=0.0)) / self.size
        return places, float(gap[self.efforts].max(initial=0.0)) / largest

    def _solve(self, values: dict[str, float]) -> np.ndarray | None:
        try:
            payload: dict[str, Any] = self.author.payload(values, quick=True)
            return vector(thinned(payload), self.base)
        except (UserError, MechanismError, Unlike, ArithmeticError, ValueError):
            return None
