"""What a remotely controlled browser must be able to do, and actions of a hand in WebDriver's words."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Protocol

KEYS = {"Home": "\ue011", "End": "\ue010", "ArrowRight": "\ue014", "Escape": "\ue00c", "Space": " "}


class Browser(Protocol):
    """A window with one page. Both standards that tell browsers what to do write actions alike."""

    touches: bool
    """Whether touches that it performs reach the page as touches."""

    def open(self, page: Path, width: int, height: int) -> None:
        """Load a file into a page of that size (CSS pixels)."""
        ...

    def ask(self, expression: str) -> Any:
        """The value of an expression of JavaScript, awaited if it is a promise, as JSON carries it."""
        ...

    def act(self, actions: list[dict[str, Any]]) -> None:
        """Do what a hand does."""
        ...

    def saved(self) -> Path:
        """The folder where it saves what a page lets one download."""
        ...

    def picture(self) -> bytes:
        """The page as PNG."""
        ...

    def close(self) -> None:
        """End the browser."""
        ...


def click(x: float, y: float) -> list[dict[str, Any]]:
    """A click at a place of the page."""
    return drag([(x, y)])


def drag(places: Sequence[tuple[float, float]]) -> list[dict[str, Any]]:
    """The button goes down at the first place and up at the last."""
    first, *others = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0} for x, y in places]
    down, up = {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}
    hand = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}}
    return [{**hand, "actions": [first, down, *others, up]}]


def fingers(*ways: Sequence[tuple[float, float]]) -> list[dict[str, Any]]:
    """Fingers that go down together, each along its places, as many of one as of another, and up together."""
    hands = []
    for number, places in enumerate(ways):
        first, *others = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0} for x, y in places]
        down, up = {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}
        hand = {"type": "pointer", "id": f"finger {number}", "parameters": {"pointerType": "touch"}}
        hands.append({**hand, "actions": [first, down, *others, up]})
    return hands


def press(key: str) -> list[dict[str, Any]]:
    """A key goes down and up; one of KEYS, or a character."""
    value = KEYS.get(key, key)
    return [
        {
            "type": "key",
            "id": "keyboard",
            "actions": [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}],
        }
    ]
