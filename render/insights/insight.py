"""An insight, and the sentence that says it in a language."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal, NamedTuple

from shared.contract.quantity import figures, written

LANGUAGES = Path(__file__).parent
"""Folder with a file of sentences for each language, named by its code; a translator adds one."""
Sort = Literal["body", "joint", "point", "load"]


class Named(NamedTuple):
    """Names of the model in a sentence: one, several, or all that are alike."""

    sort: Sort
    names: tuple[str, ...]
    each: bool = False
    """True if the names stand for each body of their stem: ``each piston``."""


class Amount(NamedTuple):
    """Number in a sentence: SI, or one of these units:

    ``deg`` an angle and ``place`` a crank's angle, both given in rad; ``share`` a part of 1; ``times``; ``count``.
    """

    value: float
    unit: str
    digits: int = 3


Value = Named | Amount | str


@dataclass(frozen=True)
class Insight:
    """Something that a motion shows."""

    kind: str
    """Subject: ``dwell``, ``quick_return``; one of the keys of the ranking's table of weights."""
    number: float
    """Its main number (SI, or a ratio)."""
    unit: str
    """Unit of the number; empty of a ratio."""
    start: float
    """Time (s) at which it begins; that of a moment is start and end."""
    end: float
    bodies: tuple[str, ...]
    joints: tuple[str, ...]
    """Names of joints, drivers, forces, contacts and points that it concerns."""
    strength: float
    """How far it is from what one expects, 0 .. 1."""
    template: str
    """Key of its sentence in the file of a language."""
    values: Mapping[str, Value]
    """Values of the names in braces of that sentence."""
    telling: float = 0.0
    """Rank, 0 .. 1: see ranking.py."""

    def sentence(self, language: str = "en", say: Callable[[Value, Mapping[str, str]], str] | None = None) -> str:
        """Return the sentence, which begins with a capital and ends with a full stop; ``say`` writes its values."""
        words, say = sentences(language), say or said
        return capital(words[self.template].format(**{key: say(value, words) for key, value in self.values.items()}))


def capital(text: str) -> str:
    """Return a text whose first letter is a capital, also one behind a sign."""
    return re.sub(r"^\W*[^\W\d_]", lambda begin: begin[0].upper(), text, count=1)


@cache
def sentences(language: str) -> dict[str, str]:
    """Return the sentences of a language by template; single words have keys that begin with a bar."""
    tables = tomllib.loads((LANGUAGES / f"{language}.toml").read_text(encoding="utf-8"))
    return {f"|{key}": words for key, words in tables["words"].items()} | tables["sentences"]


def said(value: Value, words: Mapping[str, str]) -> str:
    """Return a value of a sentence in words."""
    if isinstance(value, str):
        return words.get(f"|{value}", value)
    if isinstance(value, Amount):
        return _number(value, words)
    if value.each:
        return words["|each"].format(stem=stem_of(value.names[0]).replace("_", " "))
    return listed([_name(value.sort, name, words) for name in value.names], words["|and"])


def listed(words: Sequence[str], joined_by: str = "and") -> str:
    """Return ``a, b and c``."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {joined_by} {words[-1]}"


def stem_of(name: str) -> str:
    """Return a name without the number at its end: ``piston`` of ``piston_2``."""
    return re.sub(r"[_ ]?\d+$", "", name)


def _number(amount: Amount, words: Mapping[str, str]) -> str:
    value, unit, digits = amount
    if unit in ("deg", "place"):
        degrees = math.degrees(value) % 360 if unit == "place" else math.degrees(value)
        degrees = round(degrees, 1) if abs(degrees) < 10 else round(degrees)
        return f"{figures(0 if unit == 'place' and degrees == 360 else degrees, 4)}°"
    if unit == "share":
        return f"{figures(100 * value, 2 if value < 0.995 else 3)} %"
    if unit == "times":
        return words["|twice"] if abs(value - 2) < 1e-3 else words["|times"].format(factor=figures(value, digits))
    if unit == "count":
        return words.get(f"|{round(value)}", f"{round(value)}")
    return written(value, unit, digits)


def _name(sort: Sort, name: str, words: Mapping[str, str]) -> str:
    """Return a name as a sentence has it: ``the crank``, ``piston 2``, ``joint B``, ``point P``."""
    plain = re.sub(r"(?<=[a-z])(?=\d)", " ", name.replace("_", " "))
    if sort == "joint":
        return words["|joint"].format(name=plain)
    is_symbol = len(name) == 1 or bool(re.fullmatch(r"[A-Z]\w?", name))
    if is_symbol and sort in ("point", "load"):
        return words[f"|{sort}"].format(name=plain)
    if plain in words["|adjectives"].split():
        return words["|one_that_is"].format(name=plain)
    if is_symbol or plain[-1].isdigit():
        return plain
    return words["|the"].format(name=plain)
