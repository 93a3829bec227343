"""Legs at several places on one shaft: plates on pins, rockers on one axle."""

from __future__ import annotations

import pytest

from mbsd import Mechanism, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from shared.stage.errors import UserError
from tests.mechanisms.automatic.shafts.proofs import proven
from tools.models.shaft_machines import SINGLE, engine, legs


def refusal(m: Mechanism) -> str:
    with pytest.raises(UserError) as told:
        Automatic(m, m.sweep(steps=90)).solids()
    return str(told.value)


@pytest.mark.slow
def test_three_legs_on_a_shaft_are_built_and_nothing_touches() -> None:
    _, bodies = proven("LEGS")
    on_ground = [solid.name for solid in bodies["ground"]]
    assert on_ground.count("pin_hip_1") == 1, "one axle for all rockers"
    assert not [name for name in on_ground if name.startswith("liner")]
    for k, z in ((1, -60.0), (2, 0.0), (3, 60.0)):
        for body, place in ((f"leg_{k}", z), (f"rocker_{k}", z + 14.0)):
            bounds = bodies[body][0].shape.val().BoundingBox()
            assert (bounds.zmin + bounds.zmax) / 2 == pytest.approx(place, abs=1e-6)
    assert "pin_knee_1" in [solid.name for solid in bodies["leg_1"]]


def test_plates_that_are_too_near_are_named_with_their_distance() -> None:
    said = refusal(legs(beside=0.001))
    assert "'leg_1' and 'rocker_1'" in said
    assert "1 mm apart along z" in said
    assert "move one of them along z" in said


def test_plates_in_one_plane_are_told() -> None:
    assert "0 mm apart along z" in refusal(legs(beside=0.0))


def test_throws_that_leave_no_web_are_named() -> None:
    said = refusal(engine([(90, 90, 0.0), (-90, 270, 0.012)]))
    assert "'rod_1' and 'rod_2'" in said
    assert "12 mm apart along z" in said


def test_a_piston_beside_its_rod_is_told() -> None:
    m = engine(SINGLE)
    m.bodies["piston_1"].z = 0.02
    assert "give both the same z" in refusal(m)


def test_a_body_that_slides_on_one_that_moves_is_told() -> None:
    m = engine(SINGLE)
    block = m.body("block", z=0.03)
    m.prismatic("guide", m.bodies["crank"].at(0, 0), block.origin)
    m.drive_coordinate("ram", m.bodies["crank"].origin, block.origin, harmonic(0.01, 6.0))
    assert "guides 'block' on a body that moves" in refusal(m)
