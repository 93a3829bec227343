"""Machines without an order of layers, and solids that are not closed, are shown as panes of glass."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import cadquery as cq
import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.glass import sentence_of
from mechanisms.stages.clearance import stage as clearance
from mechanisms.stages.parts.bodies import described_body
from mechanisms.stages.print import stage as printing
from render.film.composing import EDGE, sides
from render.film.film import Film
from shared.contract import Parts, read_motion, read_parts, write_parts
from shared.contract.shot import Shot, Title
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.stage.errors import UserError
from tests.shared.shape_checks import checked
from tools.fixtures import film_fixture
from tools.models.linkages import bank, four_bar, walker

BARS = (0.12, 0.04, 0.12, 0.09)
"""Ground, crank, coupler, rocker (m)."""


def shown(m: Mechanism, steps: int = 60) -> Bodies:
    return Automatic(m, m.sweep(steps=steps)).shown()


def panes(made: Bodies) -> dict[str, Solid]:
    """The pane of each body that has one."""
    return {body: s for body, solids in made.items() for s in solids if s.material.startswith("acrylic")}


def sound(made: Bodies) -> None:
    for solids in made.values():
        for solid in solids:
            checked(solid.shape, solid.through_holes)


def cut(made: Bodies, m: Mechanism, steps: int = 12) -> list[tuple[str, str]]:
    """Pairs of panes with common volume at some pose of the motion."""
    sol, pairs = m.sweep(steps=steps), []
    for (first, a), (second, b) in combinations(panes(made).items(), 2):
        spans = [(s.shape.val().BoundingBox().zmin, s.shape.val().BoundingBox().zmax) for s in (a, b)]
        if spans[0][1] <= spans[1][0] or spans[1][1] <= spans[0][0]:
            continue
        for k in range(len(sol.t)):
            placed = [
                s.shape.rotate((0, 0, 0), (0, 0, 1), np.degrees(sol.body(body).theta[k])).translate(
                    (1e3 * sol.body(body).x[k], 1e3 * sol.body(body).y[k], 0)
                )
                for body, s in ((first, a), (second, b))
            ]
            common = placed[0].intersect(placed[1])
            if common.solids().size() and common.val().Volume() > 1e-6:
                pairs.append((first, second))
                break
    return pairs


@pytest.mark.parametrize("name", ["bank", "Bank 2"])
def test_pistons_on_one_axis_are_panes_that_never_cut_each_other(name: str) -> None:
    m = bank(2)
    m.name = name
    made = shown(m)
    assert made.schematic == "Glass plates that may overlap: rod1, piston1 and piston2 cannot pass each other in layers"
    assert any("no order of layers lets rod1, piston1 and piston2" in note for note in made.notes)
    assert panes(made).keys() == m.bodies.keys() - {"ground"}
    sound(made)
    assert cut(made, m) == []
    assert [solid.name for solid in made["ground"][:1]] == ["base_plate"]


def test_a_machine_that_has_an_order_of_layers_has_no_glass() -> None:
    made = shown(four_bar(*BARS))
    assert (made.schematic, panes(made)) == ("", {})


def test_one_body_of_glass_leaves_the_others_as_they_are() -> None:
    m = four_bar(*BARS)
    plan = Automatic(m, m.sweep(steps=60))
    plan.show_as_glass("coupler")
    made = plan.solids()
    assert panes(made).keys() == {"coupler"}
    assert "coupler" in made.schematic
    lowest = panes(made)["coupler"].shape.val().BoundingBox().zmin
    others = [solid for body in ("crank", "rocker") for solid in made[body] if solid.name == body]
    assert all(solid.shape.val().BoundingBox().zmax < lowest for solid in others)
    sound(made)
    assert not made.left_out


@pytest.mark.slow
def test_six_legs_of_a_walker_are_shown() -> None:
    m = walker(6)
    made = shown(m)
    assert panes(made).keys() == m.bodies.keys() - {"ground"}
    assert "cannot pass each other in layers" in made.schematic
    sound(made)


def escapement() -> Mechanism:
    """A wheel with eight waves that a torque turns, and a pendulum whose two pallets let it pass."""
    m = Mechanism("escapement")
    m.gravity = (0.0, -9.81)
    wheel = m.body("wheel", mass=0.1, inertia=2e-5)
    anchor = m.body("anchor", mass=0.2, com=(0, -0.12), inertia=5e-4)
    m.revolute("O", m.ground.at(0, 0), wheel.origin)
    m.revolute("A", m.ground.at(0, 0.055), anchor.origin)
    turn = np.linspace(2 * np.pi, 0.0, 240, endpoint=False)
    radius = 0.03 + 0.004 * np.cos(8 * turn)
    points = np.stack([radius * np.cos(turn), radius * np.sin(turn)], axis=1).tolist()
    for name, side in (("entry_pallet", -1), ("exit_pallet", 1)):
        m.rigid_terrain(name, wheel.origin, anchor.at(side * 0.027, -0.0285), points, radius=0.002, closed=True)
    m.torque("spring", wheel, 0.02)
    m.start_near(wheel=22.5, anchor=4)
    return m


@pytest.mark.slow
def test_an_escapement_has_parts_that_are_closed() -> None:
    m = escapement()
    made = Automatic(m, m.simulate(0.2)).shown()
    assert {"wheel", "anchor"} <= made.keys()
    sound(made)


def test_rods_and_bodies_without_joints_get_panes_too() -> None:
    m = Mechanism("held")
    crank, ball = m.bar("crank", 0.04), m.body("ball", mass=0.1, com=(0.02, 0.01))
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.prismatic("way", m.ground.at(0, 0, 0.0), ball.origin)
    m.distance("rod", crank.end, ball.origin, 0.12)
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.start_near(crank=20, ball=0)
    plan = Automatic(m, m.sweep(steps=40))
    for body in ("crank", "ball"):
        plan.show_as_glass(body)
    made = plan.shown()
    assert panes(made).keys() == {"crank", "ball", "rod"}
    assert made.rods["rod"][0] == ("crank", pytest.approx(40.0), 0.0)
    sound(made)


def edge_to_edge(fitted: bool) -> Solid:
    """Two boxes that share an edge, and are no one solid."""
    shape = cq.Workplane().box(2, 2, 2).union(cq.Workplane().box(2, 2, 2).translate((2, 2, 0)))
    return Solid("roller_entry", shape, "bronze", 0, fitted=fitted)


def test_a_solid_that_is_not_closed_becomes_a_pane_and_is_told() -> None:
    unsound: dict[str, UserError] = {}
    files: dict[str, bytes] = {}
    body = described_body("clock", "anchor", [edge_to_edge(fitted=True)], files, None, unsound=unsound)
    piece = body.pieces["roller_entry"]
    assert piece.material == "acrylic"
    assert piece.mass.volume > 16e-9 + 7e-9
    assert piece.z_range == pytest.approx((-1e-3, 1e-3))
    assert set(files) == {"roller_entry.stl", "roller_entry.step"}
    assert "roller_entry" in str(unsound["roller_entry"])
    with pytest.raises(UserError, match="clock: anchor: roller_entry"):
        described_body("clock", "anchor", [edge_to_edge(fitted=False)], {}, None, unsound={})
    with pytest.raises(UserError, match="clock: anchor: roller_entry"):
        described_body("clock", "anchor", [edge_to_edge(fitted=True)], {}, None)


@pytest.fixture
def schematic(out_root: Path) -> Parts:
    out = film_fixture.write(Shot(title=Title()))
    parts = read_parts(out.parts)
    parts.schematic = sentence_of(["crank", "coupler", "rocker", "ram", "link"])
    write_parts(out.parts, parts)
    return read_parts(out.parts)


def test_long_lists_are_short_in_a_picture() -> None:
    words = sentence_of([f"body{k}" for k in range(9)])
    assert words == "Glass plates that may overlap: body0, body1, body2 and 6 more cannot pass each other in layers"


def test_proof_and_print_are_refused_and_pictures_go_on(schematic: Parts, capsys: pytest.CaptureFixture[str]) -> None:
    for stage, nothing in ((clearance, "nothing to prove"), (printing, "nothing to print")):
        with pytest.raises(UserError, match=f"four_bar: Glass plates that may overlap: .*; so there is {nothing}"):
            stage.run("four_bar")
    clearance.run_or_warn("four_bar")
    assert "warning: four_bar: Glass plates that may overlap" in capsys.readouterr().err


@pytest.mark.parametrize("shape", [(16, 9), (9, 16), (1, 1)])
def test_the_sentence_stands_in_the_corner_of_every_picture(schematic: Parts, shape: tuple[int, int]) -> None:
    from shared.stage.paths import Out

    out, aspect = Out("four_bar"), shape[0] / shape[1]
    film = Film(read_motion(out.motion), schematic, Shot(title=Title()), out.parts_folder, aspect)
    lines = [line for line in film.scene.writing.lines if line.quiet]
    assert schematic.schematic in " ".join(line.words for line in lines)
    for line in film.scene.writing.lines:
        assert line.x + line.width <= sides(aspect)[0] - EDGE + 1e-6
