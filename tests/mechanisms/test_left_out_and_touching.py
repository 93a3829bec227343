"""Bodies without solids, and pairs of bodies that touch by design: from parts() to report, film and GLB."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import cadquery as cq
import pytest

from mbsd import Mechanism
from mechanisms.stages import shot as shot_stage
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.parts.bodies import refuse_unfit
from mechanisms.stages.solve import stage as solve_stage
from render import report
from render.film.film import Film
from render.glb.build import glb as glb_of
from shared.contract import read_motion, read_parts
from shared.contract.clearance import read_clearance
from shared.contract.shot import read_shot
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.mechanisms.author_project import Project
from tools.models.linkages import four_bar, hands, slider_crank

MECHANISM = """\
from dataclasses import dataclass
from math import pi
from mbsd import Mechanism, constant_rate

STEPS = 24


@dataclass(frozen=True)
class Params:
    crank: float = 0.03


def build(p):
    m = Mechanism("arm")
    crank, rod, slider = m.bar("crank", p.crank), m.bar("rod", 0.1), m.body("slider")
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(pi))
    m.trace("middle", rod.at(0.05, 0))
    m.start_near(crank=30, rod=-10)
    return m
"""
BLOCKS = """\
import cadquery as cq
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid


def block(name, x, y, z):
    return [Solid(name, cq.Workplane().box(x, y, z), "steel", 0)]


def parts(p):
    made = Bodies(ground=block("base", 30, 30, 4), crank=block("crank", 70, 8, 4), slider=block("slider", 70, 8, 4))
"""
SAID = """\
    made.leave_out("rod")
    made.may_touch("slider", "crank")
    made.may_touch("crank", "ground")
    return made
"""


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Project:
    """A slider-crank of blocks that lie in each other, its rod without a solid."""
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "out"))
    made = Project(tmp_path, monkeypatch, parts_stage)
    (made.folder / "mechanism.py").write_text(MECHANISM)
    (made.folder / "parts.py").write_text(BLOCKS + SAID)
    return made


def test_hand_made_parts_say_what_touches_and_what_has_no_solid(
    project: Project, capsys: pytest.CaptureFixture[str]
) -> None:
    project.run()
    for stage in (solve_stage, clearance_stage, shot_stage):
        stage.run("arm")
    said = capsys.readouterr().out
    assert "bodies without solids are estimated as aluminium bars and plates through the markers: rod" in said
    assert "not compared, as they may touch: crank and ground, crank and slider" in said
    out = Out("arm")
    parts, motion, clearance = read_parts(out.parts), read_motion(out.motion), read_clearance(out.clearance)
    assert parts.without_solids == ["rod"]
    assert (motion.bodies["rod"].mass_from, motion.bodies["rod"].z) == ("estimate", None)
    assert motion.bodies["rod"].mass > 0
    assert clearance.may_touch == [("crank", "ground"), ("crank", "slider")]
    assert {frozenset(pair.bodies) for pair in clearance.pairs} <= {frozenset(("slider", "ground"))}

    text = report.report(motion, parts, clearance)
    assert "Bodies that touch by design were not compared with each other: crank and ground; crank and slider." in text
    assert "Without solids: rod." in text

    film = Film(motion, parts, read_shot(out.shot), out.parts_folder)
    assert film.scene.trails, "its traced point leaves a trail"
    assert film.state(3).trails[0][0][2] > 0.002, "above all solids"
    content = glb_of(film)
    names = {node["name"] for node in json.loads(content[20 : 20 + struct.unpack_from("<I", content, 12)[0]])["nodes"]}
    assert {"crank", "slider", "ground"} <= names
    assert "rod" not in names


def test_pieces_may_touch_and_all_else_of_their_bodies_is_compared(
    project: Project, capsys: pytest.CaptureFixture[str]
) -> None:
    """The base and both blocks lie in each other: named by their bodies or by their pieces, they are left in peace."""
    by_pieces = """\
    made.leave_out("rod")
    made.pieces_may_touch("slider", "crank")
    made.pieces_may_touch("base", "crank")
    made["crank"] += block("knob", 3, 3, 12)
    return made
"""
    (project.folder / "parts.py").write_text(BLOCKS + by_pieces)
    project.run()
    solve_stage.run("arm")
    with pytest.raises(
        UserError, match=r"knob and (ground: base|slider: slider)|(base|slider: slider) and crank: knob"
    ):
        clearance_stage.run("arm")
    lone = by_pieces.replace('    made["crank"] += block("knob", 3, 3, 12)\n', "")
    (project.folder / "parts.py").write_text(BLOCKS + lone)
    project.run()
    solve_stage.run("arm")
    clearance_stage.run("arm")
    assert "not compared, as they may touch: base and crank, crank and slider" in capsys.readouterr().out
    clearance = read_clearance(Out("arm").clearance)
    assert (clearance.may_touch, clearance.pieces_may_touch) == ([], [("base", "crank"), ("crank", "slider")])
    text = report.report(read_motion(Out("arm").motion), read_parts(Out("arm").parts), clearance)
    assert "Pieces that touch by design were not compared with each other: base and crank; crank and slider." in text


def test_pairs_that_are_not_named_are_proven(project: Project) -> None:
    (project.folder / "parts.py").write_text(BLOCKS + SAID.replace('    made.may_touch("slider", "crank")\n', ""))
    project.run()
    solve_stage.run("arm")
    with pytest.raises(UserError, match=r"crank: crank and slider: slider collide|slider: slider and crank: crank"):
        clearance_stage.run("arm")


def test_a_body_without_solids_must_be_left_out(project: Project) -> None:
    (project.folder / "parts.py").write_text(BLOCKS + "    return made\n")
    project.run()
    with pytest.raises(UserError, match=r"parts.py has no body 'rod'.*leave_out"):
        solve_stage.run("arm")


def _solids(*bodies: str) -> Bodies:
    return Bodies({body: [Solid(body, cq.Workplane().box(1, 1, 1), "steel", 0)] for body in bodies})


def test_words_that_fit_nothing_are_refused() -> None:
    made = _solids("crank", "slider")
    made.leave_out("crank")
    with pytest.raises(UserError, match="arm: parts\\(\\) has solids of 'crank' and leaves it out"):
        refuse_unfit("arm", made)
    made = _solids("crank", "slider")
    made.may_touch("crank", "slidre")
    with pytest.raises(UserError, match=r"names 'slidre', which has no solids.*did you mean 'slider'"):
        refuse_unfit("arm", made)
    with pytest.raises(UserError, match="name two bodies"):
        made.may_touch("crank", "crank")
    with pytest.raises(UserError, match="name two solids"):
        made.pieces_may_touch("crank", "crank")
    made = _solids("crank", "slider")
    made.pieces_may_touch("crank", "slidre")
    with pytest.raises(UserError, match=r"names 'slidre', which is no solid.*did you mean 'slider'"):
        refuse_unfit("arm", made)
    made = _solids("crank", "slider")
    made["crank"].append(Solid("knob", made["crank"][0].shape, "steel", 0))
    made.pieces_may_touch("crank", "knob")
    with pytest.raises(UserError, match="two solids of 'crank', which are not compared anyway"):
        refuse_unfit("arm", made)


def test_statements_survive_more_solids() -> None:
    made = _solids("crank", "slider")
    made.leave_out("rod")
    made.may_touch("slider", "crank")
    made.pieces_may_touch("slider", "crank")
    for joined in (made | {"wheel": made["crank"]}, {"wheel": made["crank"]} | made):
        assert isinstance(joined, Bodies)
        assert set(joined) == {"crank", "slider", "wheel"}
        assert (joined.left_out, joined.touching) == (made.left_out, {("crank", "slider")})
        assert joined.pieces_touching == {("crank", "slider")}
    assert set(made) == {"crank", "slider"}


def _planned(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep())


def test_a_body_left_out_of_automatic_parts_leaves_its_eyes() -> None:
    made = _planned(slider_crank())
    assert "rod" in made.levels
    made.leave_out("rod")
    assert set(made.levels) == {"crank", "slider"}, "planned anew"
    plan = made.plan()
    assert not plan.eyes.get("rod")
    reach = [x for x, _, eye in plan.eyes["crank"] if eye.bore > 0]
    assert max(reach) == pytest.approx(made.sizes.of_metres(made.m.bodies["crank"].length or 0.0))
    solids = made.solids(engraved_too=False)
    assert solids.left_out == {"rod"}
    assert set(solids) == {"ground", "crank", "slider"}
    assert all(solid.shape.val().isValid() for solid in (*solids["crank"], *solids["slider"]))


def test_bodies_that_may_touch_may_cross() -> None:
    """Three hands on pivots that all of them sweep: no order of layers keeps them apart."""
    made = _planned(hands())
    with pytest.raises(UserError, match="no order of layers lets"):
        _ = made.levels
    pairs = [("hand0", "hand1"), ("hand0", "hand2"), ("hand1", "hand2"), *((f"hand{k}", "ground") for k in range(3))]
    for pair in pairs:
        made.may_touch(*pair)
    assert made.levels
    assert made.layout.touching == set(map(frozenset, pairs))
    assert ("hand0", "hand1") in made.solids(engraved_too=False).touching


def test_wishes_that_contradict_are_refused() -> None:
    made = _planned(four_bar(0.12, 0.04, 0.12, 0.09))
    made.layer("crank", 0)
    with pytest.raises(UserError, match="'crank' has a material, a layer, a word or solids"):
        made.leave_out("crank")
    made.leave_out("rocker")
    with pytest.raises(UserError, match="'rocker' is left out"):
        made.span("rocker")
    with pytest.raises(UserError, match="'rocker' is left out"):
        made.may_touch("rocker", "crank")
    with pytest.raises(UserError, match=r"no body 'cranck'.*did you mean 'crank'"):
        made.may_touch("cranck", "ground")
    other = _planned(four_bar(0.12, 0.04, 0.12, 0.09))
    other.leave_out("crank")
    other.leave_out("coupler")
    with pytest.raises(UserError, match="without 'rocker' nothing that moves is left"):
        other.leave_out("rocker")
