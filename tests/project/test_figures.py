"""The pictures of docs/ are what their pages compute now: small, shown by their page, the same each time."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from shared.stage.paths import ROOT
from tools.figures.__main__ import PAGES, drawn

LARGEST = 300_000
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")
PATH = re.compile(r'(?<= d=")[^"]*(?=")')
NAME = re.compile(r"\b[a-z][0-9a-f]{10}\b")
"""Names that matplotlib makes from the numbers of what they name."""
ANALYSES = (
    "kinematics",
    "inverse_dynamics",
    "forward_dynamics",
    "events",
    "statics",
    "linearisation",
    "batch",
    "synthesis",
    "joints",
    "cams",
    "forces",
)

once = cache(drawn)


def parts(svg: str) -> tuple[str, np.ndarray, np.ndarray]:
    """An SVG without its numbers; those beside its paths; and the box of each path, which may have other points."""
    paths = [np.array(NUMBER.findall(path), float).reshape(-1, 2) for path in PATH.findall(svg)]
    boxes = np.array([[*path.min(axis=0), *path.max(axis=0)] for path in paths])
    text = NAME.sub("name", PATH.sub("path", svg))
    return NUMBER.sub("#", text), np.array(NUMBER.findall(text), float), boxes


@pytest.mark.parametrize("page", PAGES)
def test_pictures_are_what_their_pages_compute(page: str) -> None:
    """Up to the last digits of other machines, a tenth of a point."""
    for name, content in once(page).items():
        words, numbers, boxes = parts(content.decode())
        kept_words, kept_numbers, kept_boxes = parts((ROOT / "docs" / name).read_text())
        assert words == kept_words, f"docs/{name} shows something else: make docs"
        np.testing.assert_allclose(numbers, kept_numbers, atol=0.1, err_msg=f"docs/{name} has moved: make docs")
        np.testing.assert_allclose(boxes, kept_boxes, atol=0.1, err_msg=f"docs/{name} has moved: make docs")


def test_a_picture_has_the_same_bytes_each_time() -> None:
    assert drawn("statics") == once("statics")


@pytest.mark.parametrize("path", sorted((ROOT / "docs").glob("*.svg")), ids=lambda path: path.name)
def test_pictures_are_small_and_shown(path: Path) -> None:
    assert path.stat().st_size < LARGEST
    assert any(f"]({path.name})" in page.read_text() for page in (ROOT / "docs").glob("*.md"))


def test_each_analysis_has_a_page_with_a_picture_and_stands_in_the_index() -> None:
    index = (ROOT / "docs" / "README.md").read_text()
    for name in ANALYSES:
        assert f"]({name}.svg)" in (ROOT / "docs" / f"{name}.md").read_text()
    for page in (ROOT / "docs").glob("*.md"):
        assert page.name == "README.md" or f"]({page.name})" in index, f"docs/README.md does not name {page.name}"
