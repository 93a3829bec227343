"""Bodies that look like what they are, by their names or by a keyword."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.looks import WORDS, looks_of
from render.film.pieces import axis_of
from render.film.solids import prism
from shared.stage.errors import UserError
from tests.mechanisms.automatic import proofs


def pump(wheel: str = "flywheel", piston: str = "piston", looks: str = "", unit: float = 1.0) -> Mechanism:
    m = Mechanism("pump")
    crank, rod = m.bar(wheel, 0.03 * unit), m.bar("rod", 0.1 * unit)
    block = m.body(piston, looks=looks)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.origin)
    m.prismatic("bore", m.ground.at(0, 0, math.pi / 2), block.origin)
    m.drive_angle("motor", crank, constant_rate(10.0))
    m.start_near(**{wheel: 30, "rod": 90, piston: 0})
    return m


def names(bodies: dict, body: str) -> set[str]:
    return {solid.name for solid in bodies[body]}


@pytest.mark.parametrize("unit", [1.0, 30.0])
def test_a_piston_has_a_cylinder_and_a_flywheel_a_rim_and_nothing_touches(unit: float) -> None:
    made, bodies = proofs.checked(pump(unit=unit))
    assert "cylinder_piston" in names(bodies, "ground")
    assert proofs.meets(made) == []
    plates = {body: next(s for s in bodies[body] if s.name == body).shape.val().BoundingBox() for body in made.m.bodies
              if body != "ground"}  # fmt: skip
    pin = made.sizes.pin
    assert plates["flywheel"].xlen == pytest.approx(plates["flywheel"].ylen, rel=1e-6)
    assert plates["flywheel"].xlen > 2 * (30 * unit + pin)  # its rim goes round the crank pin
    assert plates["piston"].ylen > 4 * pin


def test_the_keyword_beats_the_name_and_a_plate_is_a_plate() -> None:
    assert looks_of(pump("crank", "ram")) == {}
    assert looks_of(pump("crank", "ram", looks="piston")) == {"ram": "piston"}
    assert looks_of(pump("crank", "piston_2")) == {"piston_2": "piston"}
    assert looks_of(pump("crank", "piston", looks="plate")) == {}
    assert looks_of(pump("wheelhouse", "piston_guide")) == {}
    m = pump("crank", "ram", looks="pistn")
    with pytest.raises(UserError, match=r"pump: body 'ram' looks like 'pistn'; .*did you mean 'piston'\?"):
        looks_of(m)
    with pytest.raises(ModelError, match="pump: body 'ram': looks is 3; it must be a text"):
        pump("crank", "ram", looks=3)  # pyright: ignore[reportArgumentType]


def test_looks_go_along_with_the_model(tmp_path: Path) -> None:
    m = pump("crank", "ram", looks="piston")
    m.save(tmp_path / "pump.json")
    for same in (pickle.loads(pickle.dumps(m)), copy.deepcopy(m), Mechanism.load(tmp_path / "pump.json")):
        assert same.bodies["ram"].looks == "piston"
        assert looks_of(same) == {"ram": "piston"}
    m.change("ram", mass=2.0)
    assert m.bodies["ram"].looks == "piston"


def test_where_there_is_no_room_bodies_are_plates() -> None:
    """A second crank beside the flywheel's pivot, whose pedestal stands where the rim would be."""
    m = pump()
    other = m.bar("other", 0.02)
    m.revolute("P", m.ground.at(-0.035, 0.0), other.start)
    m.drive_angle("second", other, constant_rate(10.0))
    m.start_near(other=180)
    made = Automatic(m, m.sweep(steps=60))
    assert made.solids().keys() >= {"flywheel", "other", "piston"}


def hanging(body: str) -> Mechanism:
    """A pendulum of this name with its mass at its end."""
    m = Mechanism("hanging")
    rod = m.bar(body, 0.12, mass=0.2)
    m.revolute("O", m.ground.at(0, 0), rod.origin)
    m.drive_angle("motor", rod, constant_rate(1.0))
    m.start_near(**{body: -90})
    return m


@pytest.mark.parametrize("look", WORDS)
def test_every_look_makes_closed_solids_that_do_not_touch(look: str) -> None:
    for word in WORDS[look]:
        if look == "piston":
            assert looks_of(pump("crank", word)) == {word: "piston"}
            continue
        _, bodies = proofs.checked(hanging(word))
        if look == "tyre":
            assert f"tyre_{word}" in names(bodies, word)
        break


def test_a_look_changes_the_mass() -> None:
    masses = []
    for name in ("bar", "bob"):
        m = hanging(name)
        body = Automatic(m, m.sweep(steps=30)).solids()[name][0]
        masses.append(body.shape.val().Volume())
    assert masses[1] > 1.1 * masses[0]


def test_discs_are_turned_about_their_axis_and_bars_are_brushed() -> None:
    turn = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    disc = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn])
    cut = disc[disc[:, 0] < 0.6]  # the hull of a locking disc has a chord
    bar = np.concatenate([disc * [0.2, 0.2, 1] + [x, 0, 0] for x in (-1, 1)])
    square = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0, 1)], float)
    for points in (disc, cut):
        assert axis_of(prism(points + np.array([0.3, -2.0, 0.0]))[:, :2]) == pytest.approx((0.3, -2.0), abs=1e-5)
    for points in (bar, square):
        assert axis_of(prism(points)[:, :2]) is None
