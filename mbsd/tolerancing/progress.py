"""Progress: the part of all mechanisms that has been evaluated."""

from __future__ import annotations

from collections.abc import Callable


class Progress:
    """Gives a function of the user the part done, 0 .. 1, which never falls; it is 1 at the end alone."""

    def __init__(self, function: Callable[[float], object] | None, expected: int) -> None:
        self._function = function
        self._begun, self._share, self._rows, self._done = 0.0, 1.0, max(expected, 1), 0
        """The part before the rows that are counted now, what they are of the whole, how many they are, and how
        many of them are done."""

    def more(self, rows: int) -> None:
        """So many rows have been evaluated. What the function raises goes on."""
        self._done = min(self._done + rows, self._rows)
        if self._function is not None and self._part < 1.0:
            self._function(self._part)

    def last(self, rows: int) -> None:
        """The rest are so many rows, as is known by now."""
        self._begun, self._share = self._part, 1.0 - self._part
        self._rows, self._done = max(rows, 1), 0

    def end(self) -> None:
        """All is done."""
        if self._function is not None:
            self._function(1.0)

    @property
    def _part(self) -> float:
        return self._begun + self._share * self._done / self._rows
