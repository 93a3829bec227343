"""Builders of documents: the loop of README, the lecture, and the theory page."""

from __future__ import annotations

import ast
import contextlib
import io
import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from mechanisms.four_bar.mechanism import Params, build
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tools.documents.lecture import NOTEBOOK, code, executed, read, written
from tools.documents.readme_loop import CRANK, LARGEST, LINES, RATE, SHAPES, TURNS, Shape, frames, run, shown_lines
from tools.site.staging import THEORY, with_equations

# docs/lecture.ipynb: its cells run in order, also without Jupyter, and what it shows is what they give now.


JUPYTER = pytest.mark.skipif(find_spec("nbclient") is None, reason="needs nbclient, of the extra docs")


def texts(notebook: dict[str, Any]) -> list[str]:
    """Return the text that each cell with code prints."""
    return [
        "".join("".join(output.get("text", "")) for output in cell["outputs"])
        for cell in notebook["cells"]
        if cell["cell_type"] == "code"
    ]


@pytest.mark.filterwarnings("ignore:FigureCanvasAgg is non-interactive")
def test_its_cells_run_in_order_without_jupyter_and_print_what_it_shows() -> None:
    """Their assertions compare every result with a formula."""
    mpl.use("Agg")
    variables: dict[str, Any] = {"__name__": "__main__"}
    notebook, printed = read(NOTEBOOK), []
    for cell in code(notebook):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            exec(compile(cell, NOTEBOOK.name, "exec"), variables)
        printed.append(out.getvalue())
    mpl.pyplot.close("all")
    assert [_without_numbers(text) for text in printed] == [_without_numbers(text) for text in texts(notebook)]
    assert "872 of 4000 go round by Grashof, 872 by the program\n" in printed


def _without_numbers(text: str) -> str:
    return re.sub(r"\d+(\.\d+)?", "#", text)


def test_it_is_small_and_has_five_pictures_for_any_screen() -> None:
    assert NOTEBOOK.stat().st_size < 300_000
    shown = [
        kind for cell in read(NOTEBOOK)["cells"] for out in cell.get("outputs", []) for kind in out.get("data", [])
    ]
    assert shown == ["image/svg+xml"] * 5
    assert "sliders" not in NOTEBOOK.read_text()


@JUPYTER
@pytest.mark.slow
def test_a_kernel_of_jupyter_gives_the_same_file() -> None:
    notebook = executed(read(NOTEBOOK), NOTEBOOK.parent)
    assert [_without_numbers(text) for text in texts(notebook)] == [_without_numbers(t) for t in texts(read(NOTEBOOK))]
    assert len(written(notebook)) == pytest.approx(NOTEBOOK.stat().st_size, rel=0.01)


@JUPYTER
def test_a_cell_that_fails_is_an_error_with_its_traceback() -> None:
    cell = {"cell_type": "code", "id": "a", "metadata": {}, "source": ["1 / 0"], "outputs": [], "execution_count": None}
    notebook = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    with pytest.raises(UserError, match=r"(?s)lecture: a cell failed: .*ZeroDivisionError"):
        executed(notebook, NOTEBOOK.parent)


# The loop at the top of README.md: its story has no seam, its lines are the four-bar's, its file is small.


def test_the_lines_are_twelve_of_which_six_are_shown_and_make_the_four_bar_of_the_gallery() -> None:
    assert len(LINES.splitlines()) == 12
    assert all(line.removesuffix(" …") in LINES.splitlines() for line in shown_lines().splitlines())
    assert len(shown_lines().splitlines()) == 6
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
    assert all((frame.crank, frame.solid, frame.tilt) == (CRANK, 1.0, 1.0) for frame in story[:RATE])
    assert story[-1].crank == CRANK
    assert max(abs(a.solid - b.solid) for a, b in zip(story, story[1:] + story[:1], strict=True)) < 0.3
    assert len({frame.crank for frame in story}) > 12, "the number glides"
    for frame in story:
        assert frame.crank == CRANK or frame.solid == 0, "parts are shown with the numbers that they were made for"
        assert not frame.reactions or frame.solid == 1
    on = np.array([frame.reactions > 0 for frame in story])
    assert np.count_nonzero(np.diff(on.astype(int)) == 1) == 1
    assert max(frame.tilt for frame in story) == 1


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.target.stem)
def test_the_files_are_small_and_what_the_story_says(shape: Shape) -> None:
    assert shape.target.stat().st_size <= LARGEST
    with Image.open(shape.target) as picture:
        assert picture.n_frames == len(frames())  # pyright: ignore[reportAttributeAccessIssue]
        assert picture.size == (shape.width, shape.height)
    assert f"docs/{shape.target.name}" in (ROOT / "README.md").read_text()


# docs/theory.md lists the sources of the equations; the site shows the equations themselves.


def test_every_section_of_the_page_is_filled_from_its_sources() -> None:
    kept = (ROOT / THEORY).read_text()
    filled = with_equations(kept, ROOT)
    sections = re.split(r"^## ", filled, flags=re.MULTILINE)[1:]
    assert len(sections) == kept.count("Sources: [") == len(re.findall(r"^## ", kept, re.MULTILINE)) > 10
    for section in sections:
        assert "\n### " in section
        assert "```text" in section
    assert "Sources: [" not in filled
    assert filled.startswith(kept.partition("Sources:")[0])


def test_a_source_is_shown_with_its_equations(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "joints").mkdir()
    (tmp_path / "joints" / "pin.py").write_text('"""A pin.\n\n    x1 = x2\n    y1 = y2\n"""\n')
    (tmp_path / "joints" / "short.py").write_text('"""No equations."""\n')
    page = "# T\n\n## Joints\n\nWords.\n\nSources: [joints](../joints)\n"
    assert with_equations(page, tmp_path) == (
        "# T\n\n## Joints\n\nWords.\n\n### Pin\n\nA pin.\n\n```text\nx1 = x2\ny1 = y2\n```\n\n`joints/pin.py`\n"
    )


@pytest.mark.parametrize("source", ["joints/gone.py", "joints/short.py"])
def test_a_source_without_equations_raises_an_error(tmp_path: Path, source: str) -> None:
    (tmp_path / "joints").mkdir()
    (tmp_path / "joints" / "short.py").write_text('"""No equations."""\n')
    with pytest.raises(UserError, match=rf"lists \.\./{source}, which holds no equations"):
        with_equations(f"## A\n\nSources: [a](../{source})\n", tmp_path)
