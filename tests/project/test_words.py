"""Words: how docstrings begin and how long their first line is, names that say nothing, words of our own.

A share above its aim has a ceiling, which is lowered when the share falls and never raised.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field
from functools import cache

import pytest

from shared.stage.paths import ROOT

ODD = re.compile(r"(What|Whether|Those|That|Of|Which)\b")
"""First words of docstrings that say neither what a thing is nor what a function does."""
LONG = 100
"""Letters that the first line of a docstring may have."""
AIM = 3.0, 3.0
CEILINGS = {
    "mbsd": (3.0, 8.0, 27),
    "mechanisms": (3.0, 3.0, 1),
    "render": (3.0, 6.6, 0),
    "shared": (3.0, 3.0, 0),
    "studio": (3.0, 3.0, 0),
    "tools": (3.0, 3.0, 0),
    "benchmarks": (3.0, 3.0, 0),
}
"""By room: per cent of docstrings that begin oddly, per cent with a long first line, BANNED names that are left."""
HEADLESS = {"mbsd": 4}
"""Strings below constants and fields that begin oddly and are left."""
BANNED = {"made", "done", "beside", "through", "asked", "bare", "of", "at", "put", "take"}
"""No function, class or file is called so."""
NAMELESS = {"one", "found"}
"""No variable or argument is called so."""
SOLVER, OUTSIDE = ("mbsd", "mechanisms", "shared"), ("render", "studio", "tools", "benchmarks")
INSTEAD = {
    r"told": ("reported, known, given", SOLVER + OUTSIDE),
    r"in vain": ("what fails or is missing", SOLVER + OUTSIDE),
    r"hush\w*": ("cleared, silenced", SOLVER + OUTSIDE),
    r"it were": ("it was", SOLVER + OUTSIDE),
    r"lets? go|letting go": ("released", SOLVER),
    r"parts by (?:them|it)sel(?:ves|f)": ("automatic parts", SOLVER),
    r"rubs?|rubbing|begin_rubbing|rub_\w+": ("friction", ("mbsd",)),
    r"hangs? on": ("depends on", SOLVER),
}
"""Words of our own, words to use instead, and the rooms that keep to these."""
LITERAL = {
    "hangs? on": (  # on a pin, a sleeve, a master rod
        *("mechanisms/chain/", "mechanisms/double_pendulum/", "mbsd/drawing/skeleton.py", "mbsd/machines/"),
        "mbsd/model/cylinders/",
    )
}
"""Places in which a word means what it says."""


@dataclass
class Words:
    """Docstrings, names and other texts of a room, each with its place."""

    texts: dict[str, str] = field(default_factory=dict)
    """Whole files."""
    docstrings: list[tuple[str, str]] = field(default_factory=list)
    strings: list[tuple[str, str]] = field(default_factory=list)
    """Docstrings, and strings below constants and fields."""
    functions: list[tuple[str, str]] = field(default_factory=list)
    """Names of functions, classes and files."""
    variables: list[tuple[str, str]] = field(default_factory=list)

    def read(self, path: str, text: str) -> None:
        """Add a file."""
        self.texts[path] = text
        self.functions.append((path, path.rpartition("/")[2].removesuffix(".py")))
        self._walk(path, ast.parse(text))

    def _walk(self, path: str, node: ast.AST) -> None:
        place = f"{path}:{getattr(node, 'lineno', 1)}"
        match node:
            case ast.Module() | ast.ClassDef() | ast.FunctionDef() | ast.AsyncFunctionDef():
                self.docstrings += [(place, text)] if (text := ast.get_docstring(node)) else []
                self.functions += [] if isinstance(node, ast.Module) else [(place, node.name)]
            case ast.Expr(value=ast.Constant(value=str(text))):
                self.strings.append((place, text.strip()))
                return
            case ast.arg(arg=name) | ast.Name(id=name, ctx=ast.Store()):
                self.variables.append((place, name))
        for child in ast.iter_child_nodes(node):
            if not (isinstance(node, ast.ClassDef) and isinstance(child, ast.AnnAssign)):  # read after its owner
                self._walk(path, child)


@cache
def words_of(room: str) -> Words:
    words = Words()
    for path in sorted((ROOT / room).rglob("*.py")):
        if "node_modules" not in path.parts:
            words.read(path.relative_to(ROOT).as_posix(), path.read_text())
    return words


@pytest.mark.parametrize("room", CEILINGS)
def test_docstrings_begin_with_a_verb_or_a_noun_in_a_short_line(room: str) -> None:
    words = words_of(room)
    headless = [f"{place} {text[:80]}" for place, text in words.strings if ODD.match(text)]
    assert len(headless) <= HEADLESS.get(room, 0), "begin with a noun:\n" + "\n".join(headless)
    first = [(place, text.partition("\n")[0]) for place, text in words.docstrings]
    odd = [f"{place} {line}" for place, line in first if ODD.match(line)]
    long = [f"{place} {line}" for place, line in first if len(line) > LONG]
    for faults, ceiling, aim in zip((odd, long), CEILINGS[room], AIM, strict=False):
        assert len(faults) <= max(ceiling, aim) / 100 * len(first), "\n".join(faults)


@pytest.mark.parametrize("room", CEILINGS)
def test_functions_and_files_have_names_that_say_what_they_are(room: str) -> None:
    named = [f"{place} {name}" for place, name in words_of(room).functions if name.strip("_") in BANNED]
    assert len(named) <= CEILINGS[room][2], "\n".join(named)


@pytest.mark.parametrize("room", [*CEILINGS, "tests"])
def test_variables_are_called_what_they_are(room: str) -> None:
    nameless = [f"{place} {name}" for place, name in words_of(room).variables if name in NAMELESS]
    assert not nameless, "\n".join(nameless)


@pytest.mark.parametrize("word", INSTEAD)
def test_the_sources_use_words_of_the_field(word: str) -> None:
    instead, rooms = INSTEAD[word]
    pattern = re.compile(rf"\b(?:{word})\b")
    lines = [
        f"{path}:{k}: {line.strip()}"
        for room in rooms
        for path, text in words_of(room).texts.items()
        if not path.startswith(LITERAL.get(word, ("/",)))
        for k, line in enumerate(text.splitlines(), 1)
        if pattern.search(line)
    ]
    assert not lines, f"say {instead}:\n" + "\n".join(lines)
