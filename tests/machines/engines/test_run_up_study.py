"""The study of run-ups: a run against linear theory, the table of docs/engines.md, its picture."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mbsd import study
from tools.documents.pages import between, replaced
from tools.documents.run_up import BEGIN, DAMPING_RATIO, END, GRID, RATES, build, measure, picture, table

PAGE = (Path(__file__).resolve().parents[3] / "docs/engines.md").read_text()


@pytest.fixture(scope="module")
def runs() -> pd.DataFrame:
    """Return the runs of the inline four on soft mounts that the page shows."""
    grid = {"layout": ["I4"], "frequency": [8.0], "damping_ratio": [DAMPING_RATIO], "rate": list(RATES)}
    return study(build, grid, measure, folder=None, processes=1, progress=False)


def test_runs_agree_with_one_mode_in_closed_form(runs: pd.DataFrame) -> None:
    assert list(runs["reason"].isna()) == [True, True]
    assert list(runs["order of displacement"]) == [2.0, 2.0]
    assert list(runs["displacement"]) == pytest.approx(list(runs["expected displacement"]), rel=0.02)
    assert list(runs["speed of displacement"]) == pytest.approx(list(runs["speed of expected displacement"]), rel=0.02)
    slow, fast = runs["displacement"] / runs["steady displacement"]
    assert fast < 0.7 < 0.95 < slow


def test_the_page_shows_what_the_study_finds(runs: pd.DataFrame) -> None:
    shown = between(PAGE, BEGIN, END).strip().splitlines()
    head, line, row = table(runs).splitlines()
    assert shown[:2] == [head, line]
    assert row in shown, "docs/engines.md shows something else: make study-run-up"
    names = [tuple(text.split(" | ")[:2]) for text in shown[2:]]
    assert names == [(f"| {layout}", f"{hertz:g} Hz") for layout in GRID["layout"] for hertz in GRID["frequency"]]


def test_text_between_markers_is_replaced_and_a_missing_marker_is_an_error() -> None:
    assert replaced(f"before {BEGIN}\nold\n{END} after", BEGIN, END, "new") == f"before {BEGIN}\nnew\n{END} after"
    with pytest.raises(ValueError, match="the page has no"):
        replaced(f"{END} {BEGIN}", BEGIN, END, "new")


def test_the_picture_is_small(runs: pd.DataFrame) -> None:
    others = [runs.assign(layout=layout, frequency=hertz) for layout in GRID["layout"] for hertz in GRID["frequency"]]
    many = pd.concat([frame.assign(damping_ratio=zeta) for frame in others for zeta in GRID["damping_ratio"]])
    assert np.prod([len(values) for values in GRID.values()]) == 120
    file = io.BytesIO()
    picture(many).savefig(file, format="svg")
    assert len(file.getvalue()) < 300_000
