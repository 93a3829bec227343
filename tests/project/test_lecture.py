"""docs/lecture.ipynb: its cells run in order, also without Jupyter, and what it shows is what they give now."""

from __future__ import annotations

import contextlib
import io
import re
from importlib.util import find_spec
from typing import Any

import matplotlib as mpl
import pytest

from shared.stage.errors import UserError
from tools.documents.lecture import NOTEBOOK, code, executed, read, written

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
