"""Times at which a law is looked at, and its values, each evaluated once.

Times beside the nodes of a fit at which a function is evaluated, so that short pulses are seen.

    t_k = first + span frac(k g),  k = 1 .. n,  g = (sqrt(5) - 1) / 2

These times fall on no even grid, so nothing periodic hides between them; for n = 4180 neighbours are span / 3570 apart
at most. Source: Sos, Ann. Univ. Sci. Budapest 1 (1958) 127 (the three gaps of multiples of a number).

Values of a function of time, each asked for once.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
LOOKS = 4180
"""One less than a Fibonacci number: then the gaps are nearly equal."""
FORCE_LOOKS = 2583
"""At functions of forces, which take longer."""
LEAST, MOST = 88, 2_000_000
PER_SHORTEST = 4
"""Looks within the shortest thing that a law does, where the author says how long that is."""


def look_times(first: float, last: float, shortest: float | None = None, count: int = LOOKS) -> np.ndarray:
    """Return (n,) rising times (s) between ``first`` and ``last``.

    ``shortest`` (s) is the duration of the shortest thing in the law, if known.
    """
    if shortest is not None:
        count = min(max(math.ceil(PER_SHORTEST * (last - first) / shortest), LEAST), MOST)
    return first + (last - first) * np.sort(np.mod(np.arange(1, count + 1) * GOLDEN, 1.0))


class Sampled:
    """``function`` takes times (n,) and gives (n, ...)."""

    def __init__(self, function: Callable[[np.ndarray], np.ndarray]) -> None:
        self._function = function
        self._known: dict[float, np.ndarray] = {}
        self._passed = 0

    @property
    def count(self) -> int:
        """Times asked for so far."""
        return len(self._known) + self._passed

    def once(self, times: np.ndarray) -> np.ndarray:
        """The same for times (n,) that nobody asks for again."""
        self._passed += len(times)
        return self._function(times)

    def __call__(self, times: np.ndarray) -> np.ndarray:
        """(..., n) times to (..., n, ...)."""
        flat = np.ravel(times).tolist()
        missing = sorted({t for t in flat if t not in self._known})
        if missing:
            self._known.update(zip(missing, self._function(np.array(missing)), strict=True))
        values = np.array([self._known[t] for t in flat])
        return values.reshape(*np.shape(times), *values.shape[1:])
