"""The last results of functions of numbers alone, by these numbers as bytes.

What a change leaves as it was need not be found again.
Nothing gets stale, as all that a result depends on is in its key.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

T = TypeVar("T")
MOST = 64
"""So many results of one function are kept, the oldest go first."""


class Kept(Generic[T]):
    """Results by key. Who gets one does not write into it."""

    def __init__(self) -> None:
        self._results: dict[Hashable, T] = {}
        self._changing = threading.Lock()

    def get(self, key: Hashable, find: Callable[[], T]) -> T:
        """Return what ``find`` returned for this key before, or returns now; errors are not kept."""
        with self._changing:
            if key in self._results:
                return self._results[key]
        result = find()
        with self._changing:
            while len(self._results) >= MOST:
                del self._results[next(iter(self._results))]
            self._results[key] = result
        return result
