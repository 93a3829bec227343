"""A folder with mechanism.py alone: parts, motion, clearance and shot, as a user's stages make them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mechanisms.stages import shot as shot_stage
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.solve import masses
from mechanisms.stages.solve import stage as solve_stage
from mechanisms.stages.solve.masses import bare_solution
from shared.contract import read_parts
from shared.contract.shot import Shot, read_shot
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from tests.mechanisms.author_project import Project

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


def test_motion_goes_on_where_there_are_no_parts(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    """Where layers are refused, ``parts`` says so and ends; what needs no parts goes on with estimated masses."""
    (project.folder / "mechanism.py").write_text(HANDS)
    with pytest.raises(UserError, match="arm: no order of layers lets hand0, hand1 and hand2 pass"):
        project.run()
    parts_stage.run_or_none("arm")
    solve_stage.run("arm")
    said = capsys.readouterr()
    assert "until then there are none" in said.out + said.err
    assert "masses are estimated" in said.out + said.err


def test_a_short_parts_file_changes_what_it_likes(project: Project) -> None:
    (project.folder / "mechanism.py").write_text(ARM)
    (project.folder / "parts.py").write_text(CHANGED)
    project.run()
    bodies = read_parts(Out("arm").parts).bodies
    arm = bodies["arm"].pieces
    assert set(arm) == {"stick"}
    assert arm["stick"].material == "pla_orange"
    assert bodies["ground"].pieces["pin_A"].z_range[1] > arm["stick"].z_range[1]
    assert arm["stick"].z_range[0] > 0.008  # above its pedestal


def test_parts_of_a_variant_follow_from_the_motion_of_the_variant(
    project: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def solved(name: str) -> Any:
        asked.append(name)
        return bare_solution(name)

    monkeypatch.setattr(masses, "bare_solution", solved)
    (project.folder / "mechanism.py").write_text(ARM + 'VARIANTS = {"long": {"length": 0.2}}\n')
    (project.folder / "parts.py").write_text(CHANGED)
    project.run()
    parts_stage.run("arm-long")
    assert asked == ["arm", "arm-long"]


ARM = """
from dataclasses import dataclass

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    length: float = 0.16


def build(p: Params) -> Mechanism:
    m = Mechanism("arm")
    arm = m.bar("arm", p.length)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(1.0))
    return m
"""
HANDS = """
from dataclasses import dataclass

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    apart: float = 0.03


def build(p: Params) -> Mechanism:
    m = Mechanism("arm")
    for k in range(3):
        hand = m.bar(f"hand{k}", 0.1)
        m.revolute(f"O{k}", m.ground.at(p.apart * k, 0), hand.start)
        m.drive_angle(f"motor{k}", hand, constant_rate(6.0, k))
    return m
"""
CHANGED = """
import cadquery as cq

from mechanisms.arm.mechanism import Params, build
from mechanisms.stages.automatic.automatic import automatic
from shared.shapes.solid import Solid
from shared.shapes.units import mm


def parts(p: Params) -> dict[str, list[Solid]]:
    made = automatic(build(p))
    low, high = made.span("arm")
    bar = cq.Workplane(origin=(mm(p.length) / 2, 0, low)).box(mm(p.length) + 20, 16, high - low, (True, True, False))
    made.replace("arm", [Solid("stick", bar.faces(">Z").workplane(origin=(0, 0, 0)).hole(9.0), "pla_orange", 1)])
    return made.solids()
"""
YOKE = """
from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    crank: float = 0.04


def build(p: Params) -> Mechanism:
    m = Mechanism("arm")
    crank, yoke = m.bar("crank", p.crank), m.body("yoke")
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.prismatic("guide", m.ground.at(0.14, 0), yoke.at(0.14, 0))
    m.pin_in_slot("slot", yoke.at(0, 0, pi / 2), crank.end)
    m.drive_angle("motor", crank, constant_rate(2 * pi))
    m.start_near(crank=0, yoke=(0.04, 0, 0))
    return m
"""


def test_slider_and_slot_get_parts_that_never_touch(project: Project, capsys: pytest.CaptureFixture[str]) -> None:
    (project.folder / "mechanism.py").write_text(YOKE)
    project.run()
    solve_stage.run("arm")
    clearance_stage.run("arm")
    assert "none touch" in capsys.readouterr().out
    parts = read_parts(Out("arm").parts)
    assert {"rail_guide", "post_guide_1"} <= set(parts.bodies["ground"].pieces)
    assert set(parts.bodies["yoke"].pieces) == {"yoke", "gib_guide_1", "gib_guide_2"}
    assert {"pin_slot", "roller_slot"} <= set(parts.bodies["crank"].pieces)
