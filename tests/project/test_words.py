"""Words of our own where the field or English has one: they stay out of the sources."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from shared.stage.paths import ROOT

ROOMS = ("mbsd", "mechanisms", "shared")
MORE = ("render", "studio", "tools", "benchmarks")
"""Rooms in which only docstrings and some of the words are looked at."""
TESTS = "tests"
"""Where only names of variables are looked at: sentences of tests tell what they try in their own words."""
EVERYWHERE = ("told", "in vain", r"hush\w*", "it were")
INSTEAD = {
    r"rubs?|rubbing|begin_rubbing|rub_\w+": "friction",
    r"told": "reported, known, given",
    r"lets? go|letting go": "released",
    r"in vain": "what fails or is missing",
    r"hush\w*": "cleared, silenced",
    r"hangs? on": "depends on",
    r"it were": "it was",
    r"parts by (?:them|it)sel(?:ves|f)": "automatic parts",
}
NAMELESS = ("one", "found")
"""Names that say nothing of what they hold."""
LITERAL = {
    "hangs? on": (  # on a pin, a sleeve, a master rod
        *("mechanisms/chain/", "mechanisms/double_pendulum/", "mbsd/drawing/skeleton.py", "mbsd/machines/"),
        "mbsd/model/cylinders/",
    ),
    r"rubs?|rubbing|begin_rubbing|rub_\w+": ("mechanisms/", "shared/"),  # paint, edges that wear
}
"""Folders in which a word means what it says."""
FILES = sorted(file for room in ROOMS for file in (ROOT / room).rglob("*.py"))
ALL = FILES + sorted(file for room in MORE for file in (ROOT / room).rglob("*.py") if "node_modules" not in file.parts)
NAMING = ALL + sorted((ROOT / TESTS).rglob("*.py"))


@pytest.mark.parametrize("word", INSTEAD)
def test_the_sources_use_textbook_words(word: str) -> None:
    pattern = re.compile(rf"\b(?:{word})\b")
    lines = [
        f"{_place(file)}:{k}: {line.strip()}"
        for file in (ALL if word in EVERYWHERE else FILES)
        if not _place(file).startswith(LITERAL.get(word, ("/",)))
        for k, line in _lines(file)
        if pattern.search(line)
    ]
    assert not lines, f"say {INSTEAD[word]}: " + "; ".join(lines)


@pytest.mark.parametrize("room", [*ROOMS, *MORE, TESTS])
def test_variables_are_called_what_they_are(room: str) -> None:
    nameless = [
        f"{_place(file)}:{node.lineno} {name}"
        for file in NAMING
        if _place(file).startswith(f"{room}/")
        for node in _bindings(ast.parse(file.read_text()))
        if (name := node.id if isinstance(node, ast.Name) else node.arg) in NAMELESS
    ]
    assert not nameless, "name what it is: " + "; ".join(nameless)


def _bindings(tree: ast.AST) -> Iterator[ast.Name | ast.arg]:
    """What a file calls its variables and arguments; fields of classes are read after their owner's name."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.arg) or (isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)):
            yield node
        elif not (isinstance(node, ast.AnnAssign) and isinstance(tree, ast.ClassDef)):
            yield from _bindings(node)


def test_docstrings_begin_with_their_noun_or_verb() -> None:
    headless = [
        f"{_place(file)}: {text.splitlines()[0]}" for file in ALL for text in _texts(file) if text.startswith("Of ")
    ]
    assert not headless, "say what it is of f: its size, its place, its name: " + "; ".join(headless)


def _texts(file: Path) -> Iterator[str]:
    """Docstrings of modules, classes, functions, and the strings below constants and fields."""
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.value.value.strip()


@cache
def _lines(file: Path) -> list[tuple[int, str]]:
    return list(enumerate(file.read_text().splitlines(), 1))


def _place(file: Path) -> str:
    return file.relative_to(ROOT).as_posix()
