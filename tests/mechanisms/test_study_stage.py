"""mbsd study: the grid in words, a table that agrees with single runs, reasons of points that fail."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from mechanisms.stages import study
from mechanisms.stages.study import grid_of
from shared.stage.errors import UserError


@dataclass(frozen=True)
class Params:
    length: float = 0.1
    teeth: int = 20
    closed: bool = True
    kind: str = "open"
    place: tuple[float, float] = (0.0, 0.0)


def test_ranges_and_lists_by_the_kind_of_the_field() -> None:
    grid = grid_of("x", "length=0.1:0.3:3; teeth=10,12;closed=false; kind = a,b", Params())
    assert grid == {"length": [0.1, pytest.approx(0.2), 0.3], "teeth": [10, 12], "closed": [False], "kind": ["a", "b"]}


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "name the fields to vary"),
        ("length", "is no part of a grid"),
        ("lenght=1", "did you mean 'length'"),
        ("length=0.1:0.2", "is no range"),
        ("length=0.1:0.2:1", "two values or more"),
        ("length=nan", "must be finite"),
        ("length=0.1:inf:3", "two finite ends"),
        ("teeth=1.5", "whole number"),
        ("closed=2", "true or false"),
        ("place=1", "place is tuple"),
        ("length=1;length=2", "twice"),
        ("length=0:1:1000000000", "a grid of 1000000000 points; take 10000000 at most"),
        ("length=0:1:5000;teeth=1,2;place=0:1:5000", "a grid of 50000000 points"),
    ],
)
def test_bad_grids_are_refused_in_words(words: str, said: str) -> None:
    with pytest.raises(UserError, match=said):
        grid_of("x", words, Params())


def test_the_table_agrees_with_the_motion_and_names_what_failed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    monkeypatch.delenv("CLUSTER", raising=False)
    study.run("four_bar", "crank=0.03:0.05:2; rocker=0.09,0.02")
    table = pd.read_csv(tmp_path / "four_bar" / "study" / "study.csv")
    assert list(table["crank"]) == [0.03, 0.03, 0.05, 0.05]
    assert list(table["reason"].isna()) == [True, False, True, False]
    from mechanisms.four_bar.mechanism import Params as FourBar
    from mechanisms.four_bar.mechanism import build
    from mechanisms.stages.solve.masses import give_masses

    m = build(FourBar(crank=0.05))
    give_masses(m, None)
    sol = m.sweep()
    efforts, spans = table["motor effort [N m]"].to_numpy(), table["P span x [m]"].to_numpy()
    assert float(efforts[2]) == pytest.approx(np.abs(sol.driver("motor").effort).max(), rel=1e-6)
    assert float(spans[2]) == pytest.approx(np.ptp(sol.point("P").x), rel=1e-6)
    said = capsys.readouterr().out
    assert "not at crank 0.03, rocker 0.02" in said
    assert "do not close" in said


def test_a_study_without_a_good_point_fails_and_keeps_its_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    monkeypatch.delenv("CLUSTER", raising=False)
    with (
        pytest.warns(match="all of 2 points failed"),
        pytest.raises(UserError, match=r"all 2 points failed.*do not close"),
    ):
        study.run("four_bar", "rocker=0.02,0.01")
    assert len(pd.read_csv(tmp_path / "four_bar" / "study" / "study.csv")["reason"].dropna()) == 2
    said = capsys.readouterr().out
    assert "not at rocker 0.02: " in said
    assert "Error:" not in said, "the class of a refusal says nothing to a reader"
