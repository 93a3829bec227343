"""What all open pages see of a mechanism: last good motion, numbers, error; and the messages that tell it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from studio.live.frames import framed
from studio.live.history import History

Push = Callable[[bytes, bool], None]
LINES = 50
"""Number of printed lines that are kept for a page that opens later."""


class Board:
    """State and messages; ``push`` sends a frame to all pages, and says whether it replaces an older such."""

    def __init__(self, push: Push) -> None:
        self._push = push
        self.history = History()
        self.numbers: list[dict[str, Any]] = []
        """Numbers of Params as the file has it, with their ranges, labels and units."""
        self._words: dict[str, dict[str, str]] = {}
        self.payload: bytes | None = None
        """Payload of the last good motion."""
        self.solid: bytes | None = None
        """What the page says of the parts of the last good motion of the file, with the numbers of that motion."""
        self.error: str | None = None
        self._stop: dict[str, Any] | None = None
        self._lines: list[str] = []
        self._again = False
        """Whether the same files are being solved once more."""

    def tell(self, header: dict[str, Any], payload: bytes = b"", replaces: bool = False) -> None:
        """Send all pages a message."""
        self._push(framed(header, payload), replaces)

    def greeting(self, **more: Any) -> list[bytes]:
        """What a page gets that has just opened: all that there is."""
        state = {"numbers": self.numbers, "error": self.error, "lines": self._lines, "stop": self._stop}
        out = [framed({"kind": "state", **state, **self._values(), **more}, self.payload or b"")]
        if self.solid is not None and not self.history.now:
            out.append(framed({"kind": "solid"}, self.solid))
        return out

    def begin(self, parts_ready: bool = False) -> None:
        """The files are being solved; once more, where ``parts_ready``: what was printed about the parts stays."""
        self._again = parts_ready
        if not parts_ready:
            self._lines = []
        self.tell({"kind": "solving", "again": parts_ready})

    def solved(self, numbers: list[dict[str, Any]]) -> bool:
        """They are, and Params has these numbers; parts of other numbers are taken away. Whether some stay in sight."""
        self.error, self._again = None, False
        numbers = [self._described(number) for number in numbers]
        seen, self.solid = self.solid is not None, None  # it has numbers of the motion before
        if numbers != self.numbers and seen:
            seen = False
            self.tell({"kind": "solid"})
        self.numbers = numbers
        self.history.keep({number["name"] for number in numbers})
        self.tell({"kind": "solved", "numbers": numbers, **self._values()})
        return seen

    def describe(self, words: dict[str, dict[str, str]]) -> None:
        """What people call the numbers of Params; they keep these words when the file is saved again."""
        self._words = words
        numbers = [self._described(number) for number in self.numbers]
        if numbers != self.numbers:
            self.numbers = numbers
            self.tell({"kind": "numbers", "numbers": numbers, **self._values()})

    def _described(self, number: dict[str, Any]) -> dict[str, Any]:
        return number | self._words.get(number["name"], {"label": number["name"], "unit": ""})

    def motion(self, header: dict[str, Any], payload: bytes, values: dict[str, float]) -> None:
        """A new motion, with these numbers other than the file's."""
        self.payload, self._stop = payload, header.get("stop")
        self.tell({"kind": "motion", "stop": self._stop, "values": values}, payload, replaces=True)
        if self.solid is not None and not values:
            self.tell({"kind": "solid"}, self.solid)

    def parts(self, payload: bytes) -> None:
        """The parts of the motion as the file has it; none where it is empty."""
        self.solid = payload or None
        if self.solid is not None and not self.history.now:
            self.tell({"kind": "solid"}, self.solid)

    def fail(self, text: str) -> None:
        """The files cannot be solved; the last good motion stays."""
        self.error = text
        self.tell({"kind": "error", "text": text})

    def line(self, text: str) -> None:
        """Something was printed; what was said already, before there were parts, is not said again."""
        if self._again and text in self._lines:
            return
        self._lines = [*self._lines, text][-LINES:]
        self.tell({"kind": "line", "text": text})

    def tell_values(self) -> None:
        """The numbers that differ from the file, and whether there is something to undo."""
        self.tell({"kind": "values", **self._values()})

    def _values(self) -> dict[str, Any]:
        history = self.history
        return {"values": history.now, "can_undo": history.can_undo, "can_redo": history.can_redo}
