"""Files nearly those of other programs: samples with numbers, names or nesting gone wrong."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

from shared.stage.paths import ROOT
from studio.imports.pmks_records import stamped

SAMPLES = ROOT / "tests" / "studio" / "imports" / "samples"
LONGEST = 60_000
"""Bytes of a sample that are kept; more of the same are results of a solver."""
NUMBERS = (
    "nan", "inf", "-inf", "1e999", "-1e999", "1e308", "1e-320", "0", "-0", "-1", ".5", "-.1", "0x10", "1_0", "1e",
    "9" * 400, "0." + "3" * 400, "1e9", "1e-9", "3", "true", "null", '""', "", "١٢", "1,5",
)  # fmt: skip
"""In place of a number."""
NAMES = (
    "ground", "speed", "sqrt", "pi", "e", "m", "p", "t", "self", "float", "class", "None", "lambda", "__init__",
    "dataclass", "Mechanism", "Params", "build", "constant_rate", "", " ", "\0", "\ud800", "\u2028", "a\nb",
    'a"b', "a\\b", '"""', "'", "é", "日本", "x" * 3000, "1", "-", "../../x", "{p}", "%s", "R", "RP", "origin", "link_2",
)  # fmt: skip
"""In place of a word."""
LAWS = (
    "e**time",
    "sin(10*pi*time)",
    "1/time",
    "sqrt(-1)",
    "9**9**9**9",
    "(" * 300,
    "time*" * 400 + "1",
    "-" * 2000 + "1",
)
NESTED = (("[", "]"), ('{"a":', "}"), ("<a>", "</a>"), ("<Link>", ""), ("<!--", ""), ("(", ")"), ("<a ", ""))
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
WORD = re.compile(r"[A-Za-z_]\w*")
SKETCH_UNITS = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n"
SKETCH = (("motor", 0, 0), ("0", 0, 40), ("0", 110, 90), ("ground", 120, 0))
"""Pins of a four-bar as circles of a drawing: layer, x, y."""


@dataclass(frozen=True)
class Damaged:
    """The bytes of a file of this name, or an address."""

    kind: str
    mutation: str
    name: str
    content: bytes

    @property
    def is_address(self) -> bool:
        """True for an address, which is given as it is."""
        return not self.name


@cache
def samples() -> dict[str, list[tuple[str, str]]]:
    """Return names and texts of sound files, by the ending of their names; those of PMKS+ have no name."""
    texts: dict[str, list[tuple[str, str]]] = {}
    for file in sorted(SAMPLES.iterdir()):
        text = file.read_bytes()[:LONGEST].decode("latin-1")
        if file.suffix == ".tsv":
            texts["pmks+"] = [("", line.split("\t")[1]) for line in text.splitlines()]
        elif file.suffix != ".md":
            texts.setdefault(file.suffix[1:], []).append((file.name, text))
    return texts | {"dxf": [("sketch.dxf", _drawing())]}


def damaged(seed: int, kind: str | None = None) -> Damaged:
    """Return the damaged file of a seed, the same each time. Raises KeyError for a kind that there is not."""
    chance = random.Random(seed)
    kind = kind or chance.choice(sorted(samples()))
    name, text = chance.choice(samples()[kind])
    mutations = MUTATIONS | ({"values": _values} if text.lstrip().startswith("{") else {})
    names = [chance.choice(sorted(mutations)) for _ in range(chance.choice((1, 1, 1, 2, 3, 5)))]
    for mutation in names:
        text = mutations[mutation](chance, text)
    if not name and chance.random() < 0.8:
        text = stamped(text)
    if not name and chance.random() < 0.3:
        text = chance.choice(("https://app.pmksplus.com/?", "http://[", "://")) + text
    return Damaged(kind, " + ".join(dict.fromkeys(names)), name, text.encode("utf-8", "surrogatepass"))


def _drawing() -> str:
    circles = "".join(f"0\nCIRCLE\n8\n{layer}\n10\n{x}\n20\n{y}\n30\n0\n40\n3\n" for layer, x, y in SKETCH)
    lines = "".join(
        f"0\nLINE\n8\n0\n10\n{a[1]}\n20\n{a[2]}\n30\n0\n11\n{b[1]}\n21\n{b[2]}\n31\n0\n" for a, b in pairwise(SKETCH)
    )
    return f"{SKETCH_UNITS}0\nSECTION\n2\nENTITIES\n{circles}{lines}0\nENDSEC\n0\nEOF\n"


def _replaced(chance: random.Random, text: str, pattern: re.Pattern[str], words: tuple[str, ...]) -> str:
    """With one to three matches of a pattern replaced."""
    matches = list(pattern.finditer(text))
    for match in sorted(chance.sample(matches, min(len(matches), chance.randint(1, 3))), key=lambda m: -m.start()):
        text = text[: match.start()] + chance.choice(words) + text[match.end() :]
    return text


def _numbers(chance: random.Random, text: str) -> str:
    return _replaced(chance, text, NUMBER, NUMBERS)


def _names(chance: random.Random, text: str) -> str:
    """A word wherever it stands, or one place of it."""
    words = sorted(set(WORD.findall(text[:20000])))
    if not words or chance.random() < 0.5:
        return _replaced(chance, text, WORD, NAMES)
    word, new = re.escape(chance.choice(words)), chance.choice(NAMES)
    return re.sub(rf"\b{word}\b", lambda _: new, text)


def _laws(chance: random.Random, text: str) -> str:
    return re.sub(r"2\.0d\*pi\*time", lambda _: chance.choice(LAWS), text)


def _bytes(chance: random.Random, text: str) -> str:
    """Some characters are changed, left out or doubled."""
    for _ in range(chance.randint(1, 8)):
        at = chance.randrange(len(text) + 1)
        end = min(len(text), at + chance.choice((0, 1, 1, 2, 30)))
        new = chance.choice(("", chr(chance.randrange(256)), text[at:end] * 2, chance.choice("<>\"'{}[],.;:\t\n\0&")))
        text = text[:at] + new + text[end:]
    return text


def _lines(chance: random.Random, text: str) -> str:
    """A line is left out, repeated, indented or exchanged with another."""
    lines = text.splitlines(keepends=True)
    if len(lines) < 3:
        return text[: chance.randrange(len(text) + 1)]
    a, b = sorted(chance.sample(range(len(lines)), 2))
    match chance.randrange(5):
        case 0:
            del lines[a : min(b, a + 20)]
        case 1:
            lines[a:a] = lines[a : a + 5] * chance.choice((1, 10, 600))
        case 2:
            lines[a], lines[b] = lines[b], lines[a]
        case 3:
            lines[a] = "\t" * chance.choice((1, 2, 300)) + lines[a]
        case _:
            lines = lines[:a]
    return "".join(lines)


def _nesting(chance: random.Random, text: str) -> str:
    """Something is nested deep."""
    at, many = chance.randrange(len(text) + 1), chance.choice((10, 300, 20_000))
    opened, closed = chance.choice(NESTED)
    return text[:at] + opened * many + chance.choice(("", closed * many)) + text[at:]


def _splice(chance: random.Random, text: str) -> str:
    """The beginning of one file and the end of another."""
    other = chance.choice([text for _, texts in sorted(samples().items()) for _, text in texts])
    return text[: chance.randrange(len(text) + 1)] + other[chance.randrange(len(other)) :]


def _values(chance: random.Random, text: str) -> str:
    """Values of JSON of another kind, missing or repeated; the text itself where it is no JSON any more."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return text
    places = list(_places(data))
    for holder, key in chance.sample(places, min(len(places), chance.randint(1, 3))):
        new: Any = chance.choice(
            (None, True, [], {}, "", -1, 1e300, 10**30, float("nan"), chance.choice(NAMES), [[]], 0)
        )
        if isinstance(holder, list) and chance.random() < 0.3:
            holder += holder[: chance.choice((1, 3))] * chance.choice((1, 200))
        else:
            holder[key] = new
    return json.dumps(data)


def _places(data: Any) -> Iterator[tuple[Any, Any]]:
    """All holders in nested lists and objects with their keys."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield data, key
        yield from _places(value)


MUTATIONS: dict[str, Callable[[random.Random, str], str]] = {
    "bytes": _bytes,
    "laws": _laws,
    "lines": _lines,
    "names": _names,
    "nesting": _nesting,
    "numbers": _numbers,
    "splice": _splice,
}
