"""Parameter studies: the table, what is kept, what fails, and the same values whoever computes them."""

from __future__ import annotations

import itertools
import json
import math
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest
from pandas.testing import assert_frame_equal

import mbsd
from mbsd import Mechanism, ModelError, ModelWarning
from mbsd.studies import work
from tools.models import linkages

STEPS = 36
LENGTHS = {"crank": [0.03, 0.04, 0.2], "rocker": np.array([0.08, 0.09])}


def build(crank: float, rocker: float) -> Mechanism:
    return linkages.four_bar(0.12, crank, 0.12, rocker, (60, 100))


def swing(m: Mechanism) -> dict[str, float]:
    return {"swing": float(np.ptp(m.sweep(steps=STEPS).body("rocker").theta))}


def study(*args: Any, **keywords: Any) -> pandas.DataFrame:
    return mbsd.study(*args, **({"processes": 1, "progress": False, "folder": None} | keywords))


@pytest.fixture
def calls(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The points that are computed."""
    computed = []
    real = work.result_of

    def counted(build: Any, measure: Any, point: Any) -> work.Result:
        computed.append(point)
        return real(build, measure, point)

    monkeypatch.setattr(work, "result_of", counted)
    return computed


def dead_angle_swing(crank: float, rocker: float) -> float:
    """Angle of the rocker between the poses in which crank and coupler are in line, by the law of cosines."""
    far, near = 0.12 + crank, 0.12 - crank
    return math.acos((0.12**2 + rocker**2 - far**2) / (0.24 * rocker)) - math.acos(
        (0.12**2 + rocker**2 - near**2) / (0.24 * rocker)
    )


def test_the_table_has_all_points_in_order_with_their_reasons() -> None:
    table = study(build, LENGTHS, swing)
    assert list(table.columns) == ["crank", "rocker", "swing", "reason"]
    assert list(zip(table["crank"], table["rocker"], strict=True)) == [
        (c, r) for c in (0.03, 0.04, 0.2) for r in (0.08, 0.09)
    ]
    good, bad = table[table["crank"] < 0.1], table[table["crank"] > 0.1]
    assert all(good["reason"].isna())
    assert all(bad["swing"].isna())
    for row in good.itertuples():  # at 36 angles the sweep passes the dead poses by 5 degrees at most
        assert row.swing == pytest.approx(dead_angle_swing(row.crank, row.rocker), rel=0.01)
    assert all("four_bar" in reason for reason in bad["reason"])


@pytest.mark.parametrize("change", ["list", "frame"])
def test_points_may_be_listed(change: str) -> None:
    points = [{"crank": 0.04, "rocker": 0.09}, {"crank": 0.03, "rocker": 0.08}]
    whole = study(build, LENGTHS, swing)
    given = pandas.DataFrame(points, index=["b", "a"]) if change == "frame" else points
    table = study(build, given, swing)
    assert list(table.index) == (["b", "a"] if change == "frame" else [0, 1])
    assert list(table["swing"]) == [whole["swing"][3], whole["swing"][0]]


def test_known_points_are_not_computed_again(tmp_path: Path, calls: list[Any]) -> None:
    first = study(build, LENGTHS, swing, folder=tmp_path)
    assert len(calls) == 6
    assert_frame_equal(study(build, LENGTHS, swing, folder=tmp_path), first)
    assert len(calls) == 6
    more = study(build, LENGTHS | {"crank": [0.035, 0.04]}, swing, folder=tmp_path)
    assert len(calls) == 8
    assert list(more["swing"][2:]) == list(first["swing"][2:4])


def test_other_code_constants_and_helpers_are_other_studies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, calls: list[Any]
) -> None:
    study(build, LENGTHS, swing, folder=tmp_path)
    monkeypatch.setattr("tests.studies.test_study.STEPS", 35)
    study(build, LENGTHS, swing, folder=tmp_path)
    assert len(calls) == 12
    study(build, LENGTHS, lambda m: swing(m), folder=tmp_path)
    assert len(calls) == 18


def test_a_study_that_was_stopped_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, calls: list[Any]) -> None:
    counted = work.result_of

    def until(build: Any, measure: Any, point: Any) -> work.Result:
        if len(calls) == 4:
            raise KeyboardInterrupt
        return counted(build, measure, point)

    with monkeypatch.context() as patch:
        patch.setattr(work, "result_of", until)
        with pytest.raises(KeyboardInterrupt):
            study(build, LENGTHS, swing, folder=tmp_path)
    kept = sum(len(file.read_bytes().splitlines()) - 1 for file in tmp_path.rglob("*.jsonl"))
    assert 1 <= kept <= 4
    calls.clear()
    study(build, LENGTHS, swing, folder=tmp_path)
    assert len(calls) == 6 - kept


def test_a_damaged_file_is_computed_again(tmp_path: Path) -> None:
    first = study(build, LENGTHS, swing, folder=tmp_path)
    [file] = tmp_path.rglob("*.jsonl")
    for content in (file.read_bytes()[:-9], file.read_bytes().replace(b"0.", b"1.", 1), b""):
        [file] = tmp_path.rglob("*.jsonl")
        file.write_bytes(content)
        assert_frame_equal(study(build, LENGTHS, swing, folder=tmp_path), first)


def test_many_files_become_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mbsd.studies.store.EVERY", 0.0)
    points = [{"crank": 0.03 + 1e-5 * k, "rocker": 0.09} for k in range(40)]
    first = study(build, points, swing, folder=tmp_path)
    assert len(list(tmp_path.rglob("*.jsonl"))) == 40
    assert_frame_equal(study(build, points, swing, folder=tmp_path), first)
    assert len(list(tmp_path.rglob("*.jsonl"))) == 1
    assert_frame_equal(study(build, points, swing, folder=tmp_path), first)


def test_failures_of_the_machine_are_tried_again(tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    broken.touch()

    def measure(m: Mechanism) -> dict[str, bool]:
        if broken.exists():
            raise OSError("the disk is gone")
        return {"good": True}

    points = [{"crank": 0.03, "rocker": 0.09}]
    with pytest.warns(ModelWarning, match="disk"):
        assert list(study(build, points, measure, folder=tmp_path)["reason"]) == ["OSError: the disk is gone"]
    broken.unlink()
    assert list(study(build, points, measure, folder=tmp_path)["reason"].isna()) == [True]


def test_the_table_is_saved_whole_and_the_same_each_time(tmp_path: Path) -> None:
    for name in ("table.parquet", "table.csv"):
        table = study(build, LENGTHS, swing, save=tmp_path / name)
        content = (tmp_path / name).read_bytes()
        study(build, LENGTHS, swing, save=tmp_path / name)
        assert (tmp_path / name).read_bytes() == content
    assert_frame_equal(pandas.read_parquet(tmp_path / "table.parquet"), table)


def test_processes_give_the_same_table_and_survive_a_killed_one(tmp_path: Path) -> None:
    def measure(m: Mechanism) -> dict[str, float]:
        if m.bodies["crank"].length == 0.04 and m.bodies["rocker"].length == 0.09 and deadly:
            os.kill(os.getpid(), signal.SIGKILL)
        return {"swing": float(np.ptp(m.sweep(steps=36).body("rocker").theta))}

    deadly = False
    alone = study(build, LENGTHS, measure)
    deadly = True
    table = study(build, LENGTHS, measure, processes=2, folder=tmp_path)
    assert table["reason"][3].startswith("its process was ended")
    assert math.isnan(table["swing"][3])
    assert_frame_equal(table.drop(3), alone.drop(3))


def test_progress_is_told_in_lines_where_no_terminal_listens(capsys: pytest.CaptureFixture[str]) -> None:
    study(build, LENGTHS, swing, progress=True)
    assert capsys.readouterr().err.splitlines()[-1].startswith("study: 6/6, ")


@pytest.mark.parametrize(
    ("keywords", "said"),
    [
        ({"grid": 3}, "grid is 3"),
        ({"grid": [3]}, "point 0 is 3"),
        ({"grid": {"crank": [object()]}}, "a value of 'crank'"),
        ({"grid": {"reason": [1]}}, "'reason' is the column"),
        ({"grid": {"a b": [1]}}, "not a name"),
        ({"grid": {"crnk": [1.0]}}, "build: there is no argument 'crnk', did you mean 'crank'"),
        ({"grid": [{"crank": 0.03, "rocker": 0.09}, {"rokcer": 0.09}]}, "build: there is no argument 'rokcer'"),
        ({"grid": {"a": range(10_000), "b": range(10_000)}}, "100000000 points"),
        ({"grid": {"a": range(10**9)}}, "1000000000 points"),
        ({"grid": {"a": range(10**30), "b": [1, 2]}}, "points; take 10000000 at most"),
        ({"grid": {"a": itertools.count(), "b": [1]}}, "10000001 or more points"),
        ({"measure": lambda m: {"crank": 1.0}}, "measure gives 'crank'"),
        ({"save": "table.xlsx"}, ".parquet or .csv"),
        ({"processes": 0}, "processes is 0"),
        ({"client": 7}, "client is 7"),
        ({"measure": 7}, "measure is 7"),
        ({"client": "tcp://127.0.0.1:9"}, "no scheduler answers at tcp://127.0.0.1:9"),
    ],
)
def test_invalid_requests_are_refused(keywords: dict[str, Any], said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mbsd.dealing.connection.TIMEOUT", 0.2)
    arguments = {"build": build, "grid": LENGTHS, "measure": swing} | keywords
    with pytest.raises(ModelError, match=said.replace("(", r"\(")):
        study(**arguments)


@pytest.mark.parametrize("given", [[1, 2], {"swing": "x"}, {3: 1.0}, {"swing": [1.0, 2.0]}])
def test_wrong_results_of_measure_are_the_reason(given: Any) -> None:
    with pytest.warns(ModelWarning, match="all of 1 point failed, the first for: ModelError: measure"):
        table = study(build, [{"crank": 0.03, "rocker": 0.09}], lambda m: given)
    assert table["reason"][0].startswith("ModelError: measure gives")


def test_numbers_keep_their_kind(tmp_path: Path) -> None:
    def measure(m: Mechanism) -> dict[str, Any]:
        return {"count": 3, "closes": True, "ratio": np.float64(0.5), "far": math.inf}

    for _ in range(2):
        table = study(build, [{"crank": 0.03, "rocker": 0.09}], measure, folder=tmp_path)
        kinds = [str(table[name].dtype) for name in ("count", "closes", "ratio", "far")]
        assert kinds == ["int64", "bool", "float64", "float64"]
    [file] = tmp_path.rglob("*.jsonl")
    _, line = file.read_text().splitlines()
    assert json.loads(line)[1] == {"count": 3, "closes": True, "ratio": 0.5, "far": math.inf}


def test_an_empty_grid_is_an_empty_table() -> None:
    assert study(build, [], swing).empty
