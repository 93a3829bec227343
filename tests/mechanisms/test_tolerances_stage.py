"""mbsd tolerances: its files agree with mbsd.tolerances, follow what they are made of, and bad input is refused."""

from __future__ import annotations

import csv
import errno
import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Clearance, tolerances
from mbsd.measures import largest, samples
from mechanisms.slider_crank import tolerances as author
from mechanisms.slider_crank.mechanism import Params, build
from mechanisms.stages import tolerances as tolerances_stage
from mechanisms.stages.solve.masses import give_masses
from mechanisms.stages.tolerances import advice, wished_results
from shared.stage.errors import UserError
from tests.studio.command.test_own_folder import mbsd

HEAD = '''"""A press."""
from dataclasses import dataclass
from mbsd import Clearance, Mechanism, constant_rate
from mbsd.measures import largest, samples
VARIANTS = {"long": {"rod": 0.20}}

@dataclass(frozen=True)
class Params:
    rod: float = 0.12

def build(p):
    m = Mechanism("press")
    crank, rod, slider = m.bar("crank", 0.04, mass=1.0), m.bar("rod", p.rod, mass=1.0), m.body("slider", mass=1.0)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("pin, of $steel", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(2 * 3.141592653589793))
    m.start_near(crank=0, rod=0, slider=0)
    return m

'''
ASKED = """def tolerances(p):
    sizes = {"crank": 3e-4, "pin, of $steel": Clearance(2e-5, 1e-5)}
    return {
        "far": {"sizes": sizes, "result": largest("slider.x"), "limits": (p.rod + 0.0399, p.rod + 0.0402), "n": 200},
        "later": {"sizes": {"rod": "m"}, "result": samples("slider.x", [0.25]), "n": 200, "sobol": True},
    }
"""


def rows(file: Path) -> list[dict[str, str]]:
    with file.open(newline="") as lines:
        return list(csv.DictReader(lines))


def test_a_full_disk_is_a_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It was a traceback, after all machines were solved."""
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(UserError, match=r"slider_crank-offset: cannot write .*\.csv: No space left on device"):
        tolerances_stage.run("slider_crank-offset")
    assert [path.name for path in (tmp_path / "slider_crank-offset").iterdir()] == ["tolerances"]
    assert not list((tmp_path / "slider_crank-offset" / "tolerances").iterdir())


def test_the_example_of_the_gallery_is_what_the_library_finds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    tolerances_stage.run("slider_crank-offset")
    folder = tmp_path / "slider_crank-offset" / "tolerances"
    assert sorted(file.name for file in folder.iterdir()) == ["end_of_stroke.csv", "end_of_stroke.svg", "summary.md"]
    m = build(Params(offset=0.020))
    give_masses(m, None)
    pin = Clearance.from_fit(0.008, "H7/g6")
    sizes = {"crank": "m", "rod": "m", "guide": {"y": 1e-4}, "O": pin, "A": pin, "B": pin}
    end = float(np.sqrt(0.16**2 - 0.02**2))
    t = tolerances(m, sizes, largest("slider.x"), (end - 3e-4, end + 3e-4))
    table = rows(folder / "end_of_stroke.csv")
    assert [row["name"] for row in table] == [row.name for row in t.tighten]
    assert [float(row["std_halved"]) for row in table] == [row.std_halved for row in t.tighten]
    assert t.yields is not None
    assert f"within limits {t.yields.part:.2%}" in (folder / "summary.md").read_text()
    said = capsys.readouterr().out
    assert f"tighten '{t.tighten[0].name}' first" in said
    assert "nothing to do" not in said
    before = (folder / "end_of_stroke.svg").read_bytes()
    tolerances_stage.run("slider_crank-offset")
    assert "nothing to do" in capsys.readouterr().out
    (folder / "end_of_stroke.svg").write_text("cut short")
    tolerances_stage.run("slider_crank-offset")
    assert (folder / "end_of_stroke.svg").read_bytes() == before


def test_a_single_file_in_a_folder_of_ones_own(tmp_path: Path) -> None:
    (tmp_path / "press.py").write_text(HEAD + ASKED)
    folder = tmp_path / "out" / "press" / "tolerances"
    done = mbsd("tolerances", "press", at=tmp_path)
    assert done.returncode == 0, done.stderr
    assert [row["name"] for row in rows(folder / "far.csv")] == ["crank", "pin, of $steel"]
    assert [float(row["sobol_total"]) for row in rows(folder / "later.csv")] == [pytest.approx(1.0, abs=0.1)]
    (tmp_path / "press.py").write_text(HEAD + ASKED.replace('"later"', '"soon"'))
    assert "far:" in mbsd("tolerances", "press", at=tmp_path).stdout
    assert {file.stem for file in folder.iterdir()} == {"far", "soon", "summary"}
    assert "nothing to do" in mbsd("tolerances", "press", at=tmp_path).stdout
    longer = mbsd("tolerances", "press-long", at=tmp_path)
    assert "far: 0.24" in longer.stdout, longer.stderr


def test_errors_of_the_file_are_reported_by_line_and_nothing_is_written(tmp_path: Path) -> None:
    (tmp_path / "press.py").write_text(HEAD + ASKED.replace("1e-5)", "1 / 0)"))
    done = mbsd("tolerances", "press", at=tmp_path)
    assert done.returncode == 1
    assert "press.py:23: ZeroDivisionError: division by zero, in tolerances()" in done.stderr
    (tmp_path / "press.py").write_text(HEAD)
    assert "press.py says nothing of tolerances; write def tolerances" in mbsd("tolerances", at=tmp_path).stderr
    assert not list(tmp_path.rglob("*.csv"))


GOOD: dict[str, Any] = {"sizes": {"crank": "m"}, "result": largest("slider.x"), "n": 50}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"far": GOOD, "late": GOOD | {"limits": (0.3, 0.1)}}, r"'late': slider_crank: tolerances: limits are from"),
        ({"far": GOOD | {"result": largest("slidr.x")}}, "did you mean 'slider.x'"),
        ({"far": GOOD | {"soboll": True}}, "'far' takes no 'soboll'.*did you mean 'sobol'"),
        ({"far": GOOD | {"threads": 2}}, "'far' takes no 'threads'"),
        ({"far": GOOD | {"sobol": "x"}}, "sobol is 'x'; it must be True or False"),
        ({"far": GOOD | {"n": 1}}, "n is 1; it must be a whole number from 2 on"),
        ({"far": GOOD | {"sizes": {"crank": "q"}}}, "tolerance of 'crank' is 'q'"),
        ({"far": GOOD | {"result": samples("slider.x", [0.25, 0.5])}}, "gives 2 numbers"),
        ({"../far": GOOD}, "'../far' is no name of a result"),
        ({"far": {"sizes": "m"}}, "'far' says no 'result'"),
        ({"far": 3}, "'far' is 3; it takes a dict"),
        ({}, r"tolerances\(\) returned .*; it names results"),
        (5, r"tolerances\(\) returned 5; it names results"),
    ],
)
def test_bad_input_is_refused_before_any_result_is_found(
    given: Any, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(author, "tolerances", lambda p: given)
    m = build(Params())
    give_masses(m, None)
    with pytest.raises(UserError, match=rf"mechanisms/slider_crank/tolerances\.py: .*{said}"):
        wished_results("slider_crank", m, Params())


def test_a_function_of_other_arguments_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(author, "tolerances", lambda p, more: {"far": GOOD})
    with pytest.raises(UserError, match=r"tolerances\.py: .*\(p, more\) is called with 1 argument: missing a required"):
        wished_results("slider_crank", build(Params()), Params())


def test_a_mechanism_without_one_says_what_to_write() -> None:
    with pytest.raises(UserError, match=r"four_bar/tolerances\.py is missing; write def tolerances"):
        tolerances_stage.run("four_bar")


def test_advice_knows_when_there_is_nothing_to_tighten() -> None:
    def gap(a: float = 3.0, b: float = 1.0) -> float:
        return a - b

    assert "nothing is to be tightened" in advice(tolerances(gap, {"a": 0.1, "b": 0.1}, limits=(0.0, None), n=100))
    assert advice(tolerances(gap, {"a": 0.1, "b": 0.01}, n=100)).startswith("tighten 'a' first: with half")
    constant = tolerances(lambda a=1.0: 2.0 + 0.0 * a, {"a": 0.1}, limits=(None, 1.0), n=100)
    assert advice(constant) == "no dimension alone makes a difference if its tolerance is halved"


def test_the_duration_of_mechanism_py_holds_where_nothing_else_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    from mechanisms.slider_crank import mechanism

    monkeypatch.setattr(mechanism, "DURATION", 0.25, raising=False)
    m = build(Params())
    give_masses(m, None)
    t = wished_results("slider_crank", m, Params())["end_of_stroke"]()
    assert t.nominal == pytest.approx(0.16)
    monkeypatch.setattr(mechanism, "DURATION", -1.0)
    with pytest.raises(UserError, match=r"'end_of_stroke': slider_crank: duration is -1"):
        wished_results("slider_crank", m, Params())


def test_long_runs_report_their_progress(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(author, "tolerances", lambda p: {"far": GOOD | {"way": "sweep", "steps": 4, "n": 130}})
    monkeypatch.setattr("shared.stage.console.SHORTEST", 0.0)
    m = build(Params())
    give_masses(m, None)
    wished_results("slider_crank", m, Params())["far"]()
    said = capsys.readouterr().out
    parts = [int(part) for part in re.findall(r"far: (\d+) of 100 per cent of its machines", said)]
    assert parts == sorted(parts)
    assert len(parts) > 2
    assert 0 < parts[0] < parts[-1] <= 100
