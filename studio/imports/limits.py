"""Limits of files from other programs, checks against them, and names that Python can take."""

from __future__ import annotations

import builtins
import json
import keyword
import math
import re
from collections.abc import Sized
from pathlib import Path
from typing import Any

from shared.stage.errors import UserError

# Limits for files of other people: bytes, characters, depth, number of things, size of numbers.
#
# A file beyond them is no mechanism that a person drew. Each check raises UserError with the limit and what is there.


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
    """Raise UserError for a text nested too deeply; ``where`` names the line or element."""
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
        raise UserError("its JSON is nested too deeply") from error
    except ValueError as error:
        raise UserError(f"its JSON cannot be read ({error})") from error
    if not isinstance(data, dict):
        raise UserError(f"its JSON is a {type(data).__name__}, not an object")
    return data


def _number(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text[:40]} is not a finite number")
    return number


def _whole_number(text: str) -> int | float:
    return int(text) if len(text) < 16 else _number(text)


# Names of Python and of a mechanism for names of files in any form, each given once.


LONGEST = 40
"""Characters of a name; a longer one is cut."""
WRITTEN = "m p t self np ground build Params DURATION Mechanism dataclass constant_rate harmonic e pi sin cos exp sqrt"
"""Names that a written file uses itself."""
RESERVED = frozenset(
    name.lower() for name in (*keyword.kwlist, *keyword.softkwlist, *dir(builtins), *dir(object), *WRITTEN.split())
)


class Names:
    """Lower-case names of Python.

    Words of different kinds never share one, nor do two words of one kind.
    """

    def __init__(self) -> None:
        self._taken = set(RESERVED)
        self._given: dict[tuple[str, str], str] = {}

    def name_for(self, word: str, kind: str) -> str:
        """Return the name that stands for ``word``, always the same.

        ``kind`` precedes one that Python has.
        """
        if (kind, word) not in self._given:
            name = re.sub(r"[^0-9a-z]+", "_", word.lower()).strip("_")[:LONGEST].strip("_") or kind
            if name[0].isdigit() or name in RESERVED:
                name = f"{kind}_{name}"
            self._given[kind, word] = _first_free(name, self._taken, "_")
        return self._given[kind, word]


class Titles:
    """Names of joints, motors or points as their author wrote them, printable and unique."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def title_for(self, word: str) -> str:
        """Return a new name after ``word``."""
        return _first_free(printable(word)[:LONGEST].strip() or "unnamed", self._taken, " ")


def printable(words: str) -> str:
    """Return the words with spaces for control characters, surrogates and line ends."""
    return " ".join("".join(letter if letter.isprintable() else " " for letter in words).split())


def _first_free(name: str, taken: set[str], between: str) -> str:
    tried, number = name, 1
    while tried in taken:
        number += 1
        tried = f"{name}{between}{number}"
    taken.add(tried)
    return tried
