"""Variants: named replacements of parameters, found without running the file, refused where they are misspelt."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from mechanisms.stages.loading.loading import checked_variants, constant, replaced
from mechanisms.stages.new import new
from mechanisms.stages.solve import stage as solve_stage
from shared.contract import read_motion
from shared.contract.skeleton import read_skeleton
from shared.stage import paths
from shared.stage.errors import UserError
from shared.stage.paths import Out, known_name, mechanism_name, variants_in
from tests.mechanisms.author_project import Project, write_file

MECHANISM = """
from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 0.2
VARIANTS = {"no_gravity": {"gravity": 0.0}, "long": {"length": 0.6, "DURATION": 0.4}}


@dataclass(frozen=True)
class Params:
    length: float = 0.3
    gravity: float = 9.81
    damped: bool = False


def build(p):
    m = Mechanism("arm", gravity=(0.0, -p.gravity))
    arm = m.bar("arm", p.length, mass=0.5)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.start_near(arm=0)
    return m
"""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Project:
    made = Project(tmp_path / "project", monkeypatch, solve_stage)
    write_file("mechanisms/arm/mechanism.py", MECHANISM)(made)
    return made


@pytest.mark.parametrize("name", ["arm-no-gravity", "arm-no_gravity", "arm_no_gravity"])
def test_a_variant_is_found_however_it_is_written(project: Project, name: str) -> None:
    assert mechanism_name(name) == known_name(name) == "arm-no_gravity"
    assert Out(name).motion == paths.out_root() / "arm-no_gravity" / "data.json"
    assert Out("arm").folder.name == "arm"
    assert Out(name).film("preview").name == "arm-no_gravity-preview.mp4"


def test_an_unknown_variant_is_told_with_those_there_are(project: Project) -> None:
    words = r"arm has no variant 'no_gravty'; its VARIANTS are: no_gravity, long; did you mean 'no_gravity'\?"
    with pytest.raises(UserError, match=words):
        known_name("arm-no-gravty")
    with pytest.raises(UserError, match=r"there is no mechanism 'leg'"):
        known_name("leg")


def test_a_name_that_may_be_two_variants_is_refused(project: Project) -> None:
    write_file("mechanisms/arm_no/mechanism.py", 'VARIANTS = {"gravity": {}}\n')(project)
    with pytest.raises(UserError, match=r"may be arm-no_gravity or arm_no-gravity; give one of these variants"):
        mechanism_name("arm-no-gravity")
    write_file("mechanisms/arm_no_gravity/mechanism.py", "")(project)
    assert mechanism_name("arm-no-gravity") == "arm_no_gravity"  # a folder's name comes first


def test_each_variant_is_solved_by_itself(project: Project) -> None:
    for name in ("arm", "arm-no_gravity", "arm-long"):
        solve_stage.run(name)
    plain, free, long = (read_motion(Out(name).motion, name) for name in ("arm", "arm-no_gravity", "arm-long"))
    assert (plain.mechanism, free.mechanism, long.mechanism) == ("arm", "arm-no_gravity", "arm-long")
    assert plain.gravity == (0.0, -9.81)
    assert free.gravity == (0.0, 0.0)
    assert plain.bodies["arm"].omega[-1] < -1.0
    assert free.bodies["arm"].omega[-1] == 0.0
    assert plain.time[-1] == 0.2
    assert long.time[-1] == 0.4
    assert read_skeleton(Out("arm-no_gravity").skeleton).mechanism == "arm-no_gravity"


def test_a_solved_variant_has_nothing_to_do_until_its_values_change(
    project: Project, capsys: pytest.CaptureFixture[str]
) -> None:
    solve_stage.run("arm-long")
    capsys.readouterr()
    solve_stage.run("arm-long")
    assert "arm-long: nothing to do" in capsys.readouterr().out


@dataclasses.dataclass(frozen=True)
class _Params:
    length: float = 0.3
    gravity: float = 9.81


REFUSED: dict[str, tuple[Any, str]] = {
    "no dict": ([], r"VARIANTS must be a dict of dicts by name, as in VARIANTS = "),
    "no dict in it": ({"no_gravity": 0.0}, r"VARIANTS must be a dict of dicts"),
    "unfit name": ({"No Gravity": {}}, r"'No Gravity' cannot name a variant: write lower-case letters"),
    "unknown field": (
        {"no_gravity": {"gravty": 0.0}, "long": {}},
        r"VARIANTS\['no_gravity'\] has 'gravty', which Params has not; .*; did you mean 'gravity'\?",
    ),
    "not written out": ({"other": {}}, r"VARIANTS must be written out with its names in quotes"),
}


@pytest.mark.parametrize(("given", "words"), REFUSED.values(), ids=REFUSED)
def test_invalid_variants_are_refused(project: Project, given: Any, words: str) -> None:
    with pytest.raises(UserError, match=words):
        checked_variants("arm", SimpleNamespace(VARIANTS=given, Params=_Params))


def test_a_misspelt_field_is_told_before_the_mechanism_itself_is_solved(project: Project) -> None:
    write_file("mechanisms/arm/mechanism.py", MECHANISM.replace('"gravity": 0.0', '"gravty": 0.0'))(project)
    with pytest.raises(UserError, match="did you mean 'gravity'"):
        project.run()


def test_only_what_a_variant_names_is_replaced(project: Project) -> None:
    values = {"no_gravity": {"gravity": 0.0}, "long": {"length": 0.6, "DURATION": 0.4}}
    module: Any = SimpleNamespace(VARIANTS=values, Params=_Params, DURATION=0.2)
    assert replaced("arm-no_gravity", module, _Params()) == _Params(gravity=0.0)
    assert replaced("arm", module, _Params()) == _Params()
    assert constant("arm-long", module, "DURATION") == 0.4
    assert constant("arm-no_gravity", module, "DURATION") == 0.2
    assert constant("arm", module, "STEPS") is None


def test_names_are_read_without_running_the_file(tmp_path: Path) -> None:
    file = tmp_path / "mechanism.py"
    for text, names in {
        'VARIANTS = {"a": {}, "b_2": {"x": f()}}': ["a", "b_2"],
        'VARIANTS: dict = {"a": {}}': ["a"],
        "VARIANTS = made()": [],
        'VARIANTS = {"A b": {}, **more}': [],
        "def broken(": [],
        "": [],
    }.items():
        file.write_text(text)
        assert variants_in(file) == names, text
    assert variants_in(tmp_path / "none.py") == []


def test_a_new_simulated_mechanism_is_solved_and_so_are_its_variants(
    project: Project, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(new, "MECHANISMS", project.root / "mechanisms")
    new.run("my-swing", "simulated")
    assert "a double pendulum moved by weight and a spring, to change; make run-my-swing runs it" in (
        capsys.readouterr().out
    )
    file = project.root / "mechanisms" / "my_swing" / "mechanism.py"
    assert "run-my-swing-no-spring" in file.read_text()
    assert variants_in(file) == ["no_spring", "damped"]
    for name in ("my_swing", "my_swing-no_spring", "my_swing-damped"):
        solve_stage.run(name)
        assert "481 times over 4 s" in capsys.readouterr().out
    loss = [np.ptp(read_motion(Out(f"my_swing{v}").motion).forces["spring"].power) for v in ("", "-damped")]
    assert loss[1] != loss[0]
