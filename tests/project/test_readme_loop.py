"""The loop at the top of README.md: its story has no seam, its lines are the four-bar's, its file is small."""

from __future__ import annotations

import ast

import numpy as np
import pytest
from PIL import Image

from mechanisms.four_bar.mechanism import Params, build
from shared.stage.paths import ROOT
from tools.documents.readme_loop import CRANK, LINES, RATE, TURNS, frames, run

LOOP = ROOT / "docs" / "readme_loop.webp"


def test_the_lines_are_twelve_and_make_the_four_bar_of_the_gallery() -> None:
    assert len(LINES.splitlines()) == 12
    made, wanted = run(CRANK)["sol"], build(Params()).sweep()
    for name in ("x", "y"):
        np.testing.assert_allclose(getattr(made.point("P"), name), getattr(wanted.point("P"), name), atol=1e-12)


def test_the_readme_has_the_same_calls() -> None:
    shown = {node.func.attr for node in ast.walk(ast.parse(LINES.format(crank=CRANK))) if _calls(node)}
    file = ast.parse((ROOT / "mechanisms" / "four_bar" / "mechanism.py").read_text())
    assert shown == {node.func.attr for node in ast.walk(file) if _calls(node)} | {"sweep"}


def _calls(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)


def test_the_story_ends_where_it_begins_and_shows_reactions_once() -> None:
    story = frames()
    assert 5.0 <= len(story) / RATE <= 8.0
    step = TURNS / len(story)
    turned = [frame.part for frame in story] + [story[0].part]
    assert np.diff(np.unwrap(turned, period=1.0)) == pytest.approx(step, abs=1e-9)
    assert (story[0].crank, story[0].solid, story[0].tilt) == (CRANK, 0.0, 0.0)
    assert story[-1].crank == CRANK
    assert max(abs(a.solid - b.solid) for a, b in zip(story, story[1:] + story[:1], strict=True)) < 0.3
    assert len({frame.crank for frame in story}) > 12, "the number glides"
    for frame in story:
        assert frame.crank == CRANK or frame.solid == 0, "parts are shown with the numbers that they were made for"
        assert not frame.reactions or frame.solid == 1
    on = np.array([frame.reactions > 0 for frame in story])
    assert np.count_nonzero(np.diff(on.astype(int)) == 1) == 1
    assert max(frame.tilt for frame in story) == 1


def test_the_file_is_small_and_what_the_story_says() -> None:
    assert LOOP.stat().st_size <= 300_000
    with Image.open(LOOP) as picture:
        assert picture.n_frames == len(frames())  # pyright: ignore[reportAttributeAccessIssue]
        assert picture.size == (720, 315)
    assert "docs/readme_loop.webp" in (ROOT / "README.md").read_text()
