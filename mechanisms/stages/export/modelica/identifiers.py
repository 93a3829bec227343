"""Names in a Modelica model: identifiers, each once."""

from __future__ import annotations

import re

from mechanisms.stages.export.modelica.classes import CLASSES

_LANGUAGE = (
    "algorithm and annotation block break class connect connector constant constrainedby der discrete each else elseif"
    " elsewhen encapsulated end enumeration equation expandable extends external false final flow for function if"
    " import impure in initial inner input loop model not operator or outer output package parameter partial protected"
    " public pure record redeclare replaceable return stream then true type when while within"
)
_USED = "time planarWorld Modelica PlanarMechanics Real Integer Boolean String StateSelect cos sin sqrt"
KEYWORDS = frozenset(f"{_LANGUAGE} {_USED}".split())
"""Those of the language (Modelica 3.6, 2.3.3), and what a model of planar mechanics uses."""


class Identifiers:
    """The names of one model."""

    def __init__(self, model: str) -> None:
        self._taken = {model.lower()}

    def new(self, *words: str) -> str:
        """A name that is like these words, joined by ``_``: ``rod 1`` gives ``rod_1``.

        No two differ in the case of letters alone, as files of results on some systems do not.
        """
        wish = name = identifier("_".join(words))
        count = 1
        while name.lower() in self._taken or name in CLASSES:
            count += 1
            name = f"{wish}_{count}"
        self._taken.add(name.lower())
        return name


def identifier(word: str) -> str:
    """An identifier like a word."""
    name = re.sub(r"[^0-9A-Za-z_]+", "_", word).strip("_") or "thing"
    return f"n{name}" if name[0].isdigit() else f"{name}_" if name in KEYWORDS else name


def quoted(words: str) -> str:
    """A comment of a component."""
    return '"' + words.replace("\\", "\\\\").replace('"', '\\"') + '"'
