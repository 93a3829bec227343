"""The error of an answer that is not what was ordered, and its words in a form that can be printed."""

from __future__ import annotations

LONGEST = 400
"""Characters of a text from elsewhere that are shown."""


class WrongAnswer(Exception):
    """A worker sent something else than what was ordered; the message tells what. No other worker is to blame."""


def printable(text: str, longest: int = LONGEST) -> str:
    """A text from another machine for a message: one line of printable characters, cut where it is too long."""
    line = "".join(letter if letter.isprintable() else " " for letter in text[: longest + 1])
    line = " ".join(line.split())
    return line if len(text) <= longest else f"{line[:longest]}..."
