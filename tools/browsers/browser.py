"""A remotely controlled browser: actions of a hand in WebDriver's words, places of a page, a screen."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Protocol

from shared.stage.errors import UserError

KEYS = {"Home": "\ue011", "End": "\ue010", "ArrowRight": "\ue014", "Escape": "\ue00c", "Space": " "}
APP = "window.mbsd.app"
STATE = f"(({{time, playing, selected, view, shown}}) => ({{time, playing, selected, view, shown}}))({APP}.store.state)"
FRAME = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))"
SCREEN = "1400x1000x24"
SCREEN_SECONDS = 20


class Browser(Protocol):
    """A window with one page. Both standards that tell browsers what to do write actions alike."""

    touches: bool
    """True if touches that it performs reach the page as touches."""

    def open(self, page: Path, width: int, height: int) -> None:
        """Load a file into a page of that size (CSS pixels)."""
        ...

    def ask(self, expression: str) -> Any:
        """Return the value of an expression of JavaScript, awaited if it is a promise, as JSON carries it."""
        ...

    def act(self, actions: list[dict[str, Any]]) -> None:
        """Perform actions of a hand."""
        ...

    def saved(self) -> Path:
        """Return the folder of its downloads."""
        ...

    def picture(self) -> bytes:
        """Return the page as PNG."""
        ...

    def close(self) -> None:
        """End the browser."""
        ...


def click(x: float, y: float) -> list[dict[str, Any]]:
    """Return a click at a place of the page."""
    return drag([(x, y)])


def drag(places: Sequence[tuple[float, float]]) -> list[dict[str, Any]]:
    """Return a drag: the button goes down at the first place and up at the last."""
    first, *others = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0} for x, y in places]
    down, up = {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}
    hand = {"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}}
    return [{**hand, "actions": [first, down, *others, up]}]


def fingers(*ways: Sequence[tuple[float, float]]) -> list[dict[str, Any]]:
    """Return fingers that go down together, each along its places, and up together.

    All have equally many places.
    """
    hands = []
    for number, places in enumerate(ways):
        first, *others = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0} for x, y in places]
        down, up = {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}
        hand = {"type": "pointer", "id": f"finger {number}", "parameters": {"pointerType": "touch"}}
        hands.append({**hand, "actions": [first, down, *others, up]})
    return hands


def press(key: str) -> list[dict[str, Any]]:
    """Return a key that goes down and up; one of KEYS, or a character."""
    value = KEYS.get(key, key)
    return [
        {
            "type": "key",
            "id": "keyboard",
            "actions": [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}],
        }
    ]


def box(browser: Browser, selector: str) -> dict[str, float]:
    """Return the place of an element: left, top, width, height (CSS pixels of the page)."""
    return browser.ask(
        f"(({{left, top, width, height}}) => ({{left, top, width, height}}))"
        f"(document.querySelector('{selector}').getBoundingClientRect())"
    )


@contextmanager
def screen(program: str) -> Iterator[dict[str, str]]:
    """Give an environment with a screen that nobody sees (Xvfb); without one these browsers have no WebGL."""
    read, write = os.pipe()
    command = [program, "-displayfd", str(write), "-screen", "0", SCREEN, "-nolisten", "tcp"]
    process = subprocess.Popen(command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as display:
            number = display.readline().strip()
        if not number:
            raise UserError("Xvfb gives no screen")
        kept = {name: value for name, value in os.environ.items() if name != "WAYLAND_DISPLAY"}
        yield kept | {"DISPLAY": f":{number}", "GDK_BACKEND": "x11"}
    finally:
        process.terminate()
        process.wait(SCREEN_SECONDS)
