"""Names of Python and of a mechanism for names of files in any form, each given once."""

from __future__ import annotations

import builtins
import keyword
import re

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
