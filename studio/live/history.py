"""Undo and redo of the numbers that sliders, drags and fits have set."""

from __future__ import annotations

MOST = 500
"""Steps that are kept."""


class History:
    """States of the changed numbers, by name, with the current one."""

    def __init__(self) -> None:
        self._states: list[dict[str, float]] = [{}]
        self._now = 0

    @property
    def now(self) -> dict[str, float]:
        """Numbers that differ from the file."""
        return dict(self._states[self._now])

    @property
    def can_undo(self) -> bool:
        """True if there is a state before this one."""
        return self._now > 0

    @property
    def can_redo(self) -> bool:
        """True if something was undone."""
        return self._now < len(self._states) - 1

    def add(self, values: dict[str, float]) -> None:
        """Add a new state; undone states are forgotten."""
        if values == self._states[self._now]:
            return
        self._states = [*self._states[: self._now + 1], dict(values)][-MOST:]
        self._now = len(self._states) - 1

    def undo(self) -> dict[str, float]:
        """Go back one state and return it."""
        self._now = max(self._now - 1, 0)
        return self.now

    def redo(self) -> dict[str, float]:
        """Go forward one state and return it."""
        self._now = min(self._now + 1, len(self._states) - 1)
        return self.now

    def keep(self, names: set[str]) -> None:
        """Forget numbers other than ``names`` in all states."""
        self._states = [{name: value for name, value in state.items() if name in names} for state in self._states]

    def written(self, values: dict[str, float], before: dict[str, float]) -> None:
        """Rebase all states after the file took these values in place of ``before``.

        Each state gives the same mechanism as before. So a number that was set to another value meanwhile stays, and
        undoing goes on to the value that the file held before.
        """

        def rebased(state: dict[str, float]) -> dict[str, float]:
            meant = {name: before[name] for name in values if name in before} | state
            return {name: value for name, value in meant.items() if values.get(name) != value}

        self._states = [rebased(state) for state in self._states]
