"""Words of our own where the field has one: they stay out of the solver."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shared.stage.paths import ROOT

INSTEAD = {
    r"rubs?|rubbing|begin_rubbing|rub_\w+": "friction",
    r"told": "reported, known, given",
    r"lets? go|letting go": "released",
}
FILES = sorted((ROOT / "mbsd").rglob("*.py"))


@pytest.mark.parametrize("word", INSTEAD)
def test_the_solver_uses_textbook_words(word: str) -> None:
    pattern = re.compile(rf"\b(?:{word})\b")
    found = [
        f"{_place(file)}:{k}: {line.strip()}" for file in FILES for k, line in _lines(file) if pattern.search(line)
    ]
    assert not found, f"say {INSTEAD[word]}: " + "; ".join(found)


def _lines(file: Path) -> list[tuple[int, str]]:
    return list(enumerate(file.read_text().splitlines(), 1))


def _place(file: Path) -> str:
    return file.relative_to(ROOT).as_posix()
