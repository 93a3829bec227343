"""Limits for files of other people: bytes, characters, depth, number of things, size of numbers.

A file beyond them is no mechanism that a person drew. Each check raises UserError with the limit and what is there.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sized
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError

LARGEST_FILE = 1 << 26
"""Bytes of a file; assemblies carry the results of their solver."""
LONGEST_TEXT = 1 << 22
"""Characters of a file without such results."""
DEEPEST = 100
"""Levels of nested elements or of indented lines."""
MOST = 400
"""Links, joints or other things of one kind."""
LARGEST_NUMBER = 1e9
"""Lengths in metres, masses in kg and other numbers are below it."""


def read_bytes(file: Path) -> bytes:
    """Return the content of a file, of which no more than the limit is ever read."""
    try:
        with file.open("rb") as opened:
            content = opened.read(LARGEST_FILE + 1)
    except (OSError, ValueError) as error:  # ValueError: NUL in its name
        raise UserError(f"{str(file)!r} cannot be read: {getattr(error, 'strerror', None) or error}") from error
    if len(content) > LARGEST_FILE:
        raise UserError(f"{str(file)!r} is larger than {LARGEST_FILE >> 20} MB; no mechanism is that large")
    return content


def check_length(text: str) -> None:
    """Raise UserError for a text that is too long."""
    if len(text) > LONGEST_TEXT:
        raise UserError(f"it has {len(text)} characters; a mechanism has fewer than {LONGEST_TEXT}")


def check_count(things: Sized, words: str) -> None:
    """Raise UserError for too many things; ``words`` names them in the plural."""
    if len(things) > MOST:
        raise UserError(f"it has {len(things)} {words}; a mechanism that can be imported has {MOST} at most")


def check_depth(depth: int, where: str) -> None:
    """Raise UserError for a text nested too deep; ``where`` names the line or element."""
    if depth > DEEPEST:
        raise UserError(f"{where}: it is nested deeper than {DEEPEST} levels")


def parsed_json(text: str) -> dict[str, Any]:
    """Return the object of a JSON text.

    Raises UserError if it is none, is too deep, or has NaN or infinity.
    """
    check_length(text)
    try:
        data = json.loads(text, parse_float=_number, parse_int=_whole_number, parse_constant=_number)
    except RecursionError as error:
        raise UserError("its JSON is nested too deep") from error
    except ValueError as error:
        raise UserError(f"its JSON cannot be read ({error})") from error
    if not isinstance(data, dict):
        raise UserError(f"its JSON is a {type(data).__name__}, not an object")
    return data


def _number(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text[:40]} is no finite number")
    return number


def _whole_number(text: str) -> int | float:
    return int(text) if len(text) < 16 else _number(text)
