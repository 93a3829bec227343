"""The pictures of docs/ are what their pages compute now: small, shown by their page, the same each time."""

from __future__ import annotations

import io
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

from mbsd.drawing.look import FAINT, INK, QUIET
from shared.stage.paths import ROOT
from tools.documents.figures.dark import COLOUR, NEUTRAL, PAPER, dark, dark_gif, data_colours, name_of
from tools.documents.figures.figures import PAGES, drawn

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
    "derivatives",
    "joints",
    "cams",
    "forces",
)

SLOW = ("integrators", "forward_dynamics", "derivatives")
"""Pages whose code takes ten seconds and more."""

once = cache(drawn)


def parts(svg: str) -> tuple[str, np.ndarray, np.ndarray]:
    """An SVG without its numbers; those beside its paths; and the box of each path, which may have other points."""
    paths = [np.array(NUMBER.findall(path), float).reshape(-1, 2) for path in PATH.findall(svg)]
    boxes = np.array([[*path.min(axis=0), *path.max(axis=0)] for path in paths])
    text = NAME.sub("name", PATH.sub("path", svg))
    return NUMBER.sub("#", text), np.array(NUMBER.findall(text), float), boxes


@pytest.mark.parametrize(
    "page", [pytest.param(page, marks=[pytest.mark.slow] if page in SLOW else []) for page in PAGES]
)
def test_pictures_are_what_their_pages_compute(page: str) -> None:
    """Up to the last digits of other machines, a tenth of a point."""
    for name, content in once(page).items():
        if name.endswith(".gif"):
            refuse_other_films(name, content)
            continue
        words, numbers, boxes = parts(content.decode())
        kept_words, kept_numbers, kept_boxes = parts((ROOT / "docs" / name).read_text())
        assert words == kept_words, f"docs/{name} shows something else: make docs"
        np.testing.assert_allclose(numbers, kept_numbers, atol=0.1, err_msg=f"docs/{name} has moved: make docs")
        np.testing.assert_allclose(boxes, kept_boxes, atol=0.1, err_msg=f"docs/{name} has moved: make docs")


def refuse_other_films(name: str, content: bytes) -> None:
    """As many pictures, each with few pixels that differ: edges may be soft in another way on other machines."""
    made, kept = films(content), films((ROOT / "docs" / name).read_bytes())
    assert made.shape == kept.shape, f"docs/{name} shows something else: make docs"
    differ = (abs(made.astype(int) - kept) > 24).any(axis=3)
    assert differ.mean() < 1e-3, f"docs/{name} shows something else: make docs"


def films(gif: bytes) -> np.ndarray:
    """(pictures, height, width, 3)"""
    with Image.open(io.BytesIO(gif)) as film:
        return np.stack([np.asarray(picture.convert("RGB")) for picture in ImageSequence.Iterator(film)])


def test_a_film_on_dark_paper_moves_as_the_other_one_and_is_small() -> None:
    light, dark_one = ((ROOT / "docs" / name).read_bytes() for name in ("animation.gif", "animation_dark.gif"))
    assert dark_gif(light) == dark_one, "make docs"
    assert max(len(light), len(dark_one)) < LARGEST
    bright, dim = films(light), films(dark_one)
    moves = [(np.abs(np.diff(film.astype(int), axis=0)) > 8).any(axis=3).mean() for film in (bright, dim)]
    assert moves[1] == pytest.approx(moves[0], rel=0.05)
    assert np.median(bright) > 230
    assert np.median(dim) < 40
    assert dim.max() > 220, "words are read"


def test_files_that_are_no_film_are_refused() -> None:
    with pytest.raises(ValueError, match="no GIF"):
        dark_gif(b"no picture")


def test_a_picture_has_the_same_bytes_each_time() -> None:
    assert drawn("statics") == once("statics")


@pytest.mark.parametrize("path", sorted((ROOT / "docs").glob("*.svg")), ids=lambda path: path.name)
def test_pictures_are_small_and_shown_in_dark_and_light(path: Path) -> None:
    assert path.stat().st_size < LARGEST
    light = path.with_name(f"{path.stem.removesuffix('_dark')}.svg")
    assert any(shown(light.name) in page.read_text() for page in (ROOT / "docs").glob("*.md"))
    assert dark(light.read_bytes()) == light.with_name(name_of(light.name)).read_bytes(), "make docs"


@pytest.mark.parametrize("path", sorted((ROOT / "docs").glob("*_dark.svg")), ids=lambda path: path.name)
def test_dark_pictures_have_no_white_slab_and_ink_that_is_read(path: Path) -> None:
    """WCAG 2: contrast of 3 at least of lines, 4.5 of words; words of matplotlib and mbsd have the ink's colours."""
    colours = set(COLOUR.findall(path.read_text())) - data_colours()
    assert PAPER in colours
    assert "#ffffff" not in colours
    for colour in colours - {PAPER, NEUTRAL[FAINT]}:
        assert contrast(colour, PAPER) > 3, colour
    assert all(contrast(NEUTRAL[ink], PAPER) > 4.5 for ink in (INK, QUIET))


def contrast(first: str, second: str) -> float:
    def light(colour: str) -> float:
        rgb = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
        return float(np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4) @ [0.2126, 0.7152, 0.0722])

    low, high = sorted((light(first), light(second)))
    return (high + 0.05) / (low + 0.05)


def shown(name: str) -> str:
    """How a page shows a picture."""
    return f'srcset="{name_of(name)}"><img alt='


def test_each_analysis_has_a_page_with_a_picture_and_stands_in_the_index() -> None:
    index = (ROOT / "docs" / "README.md").read_text()
    for name in ANALYSES:
        assert f'src="{name}.svg">' in (ROOT / "docs" / f"{name}.md").read_text()
    for page in (ROOT / "docs").glob("*.md"):
        assert page.name == "README.md" or f"]({page.name})" in index, f"docs/README.md does not name {page.name}"
