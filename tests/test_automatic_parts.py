"""A folder with mechanism.py alone: parts, motion, clearance and shot, as a user's stages make them."""

from __future__ import annotations

from pathlib import Path

import pytest

from mechanisms import clearance_stage, parts_stage, shot_stage, solve_stage
from shared.contract import read_parts
from shared.paths import ROOT, Out
from shared.shot import Shot, read_shot
from tests.author_project import Project

MECHANISM = (ROOT / "mechanisms" / "four_bar" / "mechanism.py").read_text().replace('"four_bar"', '"arm"')


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    """The gallery's four-bar as ``arm``, its mechanism.py alone."""
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "out"))
    made = Project(tmp_path, monkeypatch, parts_stage)
    (made.folder / "mechanism.py").write_text(MECHANISM)
    return made


def test_mechanism_alone_reaches_the_film(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    project.run()
    for stage in (solve_stage, clearance_stage, shot_stage):
        stage.run("arm")
    said = capsys.readouterr().out
    assert "none touch" in said
    out = Out("arm")
    parts = read_parts(out.parts)
    assert set(parts.bodies) == {"ground", "crank", "coupler", "rocker"}
    for body in ("crank", "coupler", "rocker"):
        assert next(iter(parts.bodies[body].pieces)) == body
    pieces = {name for body in parts.bodies.values() for name in body.pieces}
    assert {"base_plate", "pedestal_A", "pin_A", "circlip_A", "bushing_B_low", "washer_C", "stylus_P"} <= pieces
    assert read_shot(out.shot) == Shot()

    project.run()
    assert capsys.readouterr().out == "parts: arm: nothing to do\n"
    (project.folder / "mechanism.py").write_text(MECHANISM.replace("rocker: float = 0.090", "rocker: float = 0.095"))
    project.run()
    assert "solids of 4 bodies" in capsys.readouterr().out
    assert read_parts(out.parts).bodies["rocker"].mass.com[0] > parts.bodies["rocker"].mass.com[0]
