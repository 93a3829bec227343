"""State of a mechanism as all open pages show it: last good motion, numbers, error; and its messages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from studio.live.messages import framed

# Undo and redo of the numbers that sliders, drags and fits have set.


MOST = 500
"""Steps that are kept."""


def differing(values: Mapping[str, float], file: Mapping[str, float]) -> dict[str, float]:
    """Return the numbers that the file has otherwise."""
    return {name: value for name, value in values.items() if name in file and value != file[name]}


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

    def keep(self, file: Mapping[str, float]) -> None:
        """Forget in all states the numbers that the file lacks, or has itself."""
        self._states = [differing(state, file) for state in self._states]

    def written(self, values: dict[str, float], before: dict[str, float]) -> None:
        """Rebase all states after the file took these values in place of ``before``.

        Each state gives the same mechanism as before. So a number that was set to another value meanwhile stays, and
        undoing goes on to the value that the file held before.
        """

        def rebased(state: dict[str, float]) -> dict[str, float]:
            meant = {name: before[name] for name in values if name in before} | state
            return {name: value for name, value in meant.items() if values.get(name) != value}

        self._states = [rebased(state) for state in self._states]


Push = Callable[[bytes, bool], None]
LINES = 50
"""Number of printed lines that are kept for a page that opens later."""


class Board:
    """State and messages.

    ``push`` sends a frame to all pages, and says whether it replaces an older one of its kind.
    """

    def __init__(self, push: Push) -> None:
        self._push = push
        self.history = History()
        self.numbers: list[dict[str, Any]] = []
        """Numbers of Params as the file has it, with their ranges, labels and units."""
        self._words: dict[str, dict[str, str]] = {}
        self.payload: bytes | None = None
        """Payload of the last good motion."""
        self.solid: bytes | None = None
        """Payload of the parts of the last good motion of the file, with the numbers of that motion."""
        self.error: str | None = None
        self._stop: dict[str, Any] | None = None
        self._lines: list[str] = []
        self._again = False
        """True if the same files are being solved once more."""

    @property
    def file(self) -> dict[str, float]:
        """Values of the file, by name."""
        return {number["name"]: number["value"] for number in self.numbers}

    def tell(self, header: dict[str, Any], payload: bytes = b"", replaces: bool = False) -> None:
        """Send all pages a message."""
        self._push(framed(header, payload), replaces)

    def greeting(self, **more: Any) -> list[bytes]:
        """Return the messages that bring a newly opened page up to date."""
        state = {"numbers": self.numbers, "error": self.error, "lines": self._lines, "stop": self._stop}
        out = [framed({"kind": "state", **state, **self._values(), **more}, self.payload or b"")]
        if self.solid is not None:
            out.append(framed({"kind": "solid"}, self.solid))
        return out

    def begin(self, parts_ready: bool = False) -> None:
        """Announce that the files are being solved.

        With ``parts_ready`` they are solved again, and lines printed about the parts stay.
        """
        self._again = parts_ready
        if not parts_ready:
            self._lines = []
        self.tell({"kind": "solving", "again": parts_ready})

    def solved(self, numbers: list[dict[str, Any]]) -> bool:
        """Record that the files are solved with these numbers of Params.

        Parts of other numbers are removed. Returns True if parts stay in sight.
        """
        self.error, self._again = None, False
        numbers = [self._described(number) for number in numbers]
        seen, self.solid = self.solid is not None, None  # it has numbers of the motion before
        if numbers != self.numbers and seen:
            seen = False
            self.tell({"kind": "solid"})
        self.numbers = numbers
        self.history.keep(self.file)
        self.tell({"kind": "solved", "numbers": numbers, **self._values()})
        return seen

    def describe(self, words: dict[str, dict[str, str]]) -> None:
        """Record labels and units of the numbers; they outlast a save of the file."""
        self._words = words
        numbers = [self._described(number) for number in self.numbers]
        if numbers != self.numbers:
            self.numbers = numbers
            self.tell({"kind": "numbers", "numbers": numbers, **self._values()})

    def _described(self, number: dict[str, Any]) -> dict[str, Any]:
        return number | self._words.get(number["name"], {"label": number["name"], "unit": ""})

    def motion(self, header: dict[str, Any], payload: bytes, values: dict[str, float]) -> None:
        """Publish a new motion, solved with these numbers other than the file's."""
        self.payload, self._stop = payload, header.get("stop")
        self.tell({"kind": "motion", "stop": self._stop, "values": values}, payload, replaces=True)
        if self.solid is not None and not values:
            self.tell({"kind": "solid"}, self.solid)

    def parts(self, payload: bytes) -> None:
        """Publish the parts of the file's motion; empty for none. A page with other numbers dims them."""
        self.solid = payload or None
        if self.solid is not None:
            self.tell({"kind": "solid"}, self.solid)

    def fail(self, text: str) -> None:
        """Publish an error of the files; the last good motion stays."""
        self.error = text
        self.tell({"kind": "error", "text": text})

    def line(self, text: str) -> None:
        """Publish a printed line, unless it was published before there were parts."""
        if self._again and text in self._lines:
            return
        self._lines = [*self._lines, text][-LINES:]
        self.tell({"kind": "line", "text": text})

    def tell_values(self) -> None:
        """Publish the numbers that differ from the file, and whether there is something to undo."""
        self.tell({"kind": "values", **self._values()})

    def _values(self) -> dict[str, Any]:
        history = self.history
        return {"values": history.now, "can_undo": history.can_undo, "can_redo": history.can_redo}
