"""Values of a function of time, each asked for once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np


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
