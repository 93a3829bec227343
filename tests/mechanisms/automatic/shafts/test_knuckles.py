"""Rods that carry rods: flanges with knuckle pins, and shafts in pieces for big ends that are not split."""

from __future__ import annotations

import math
from typing import Any

import pytest

from mbsd import Mechanism
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.master_rod import MasterRod
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from mechanisms.stages.automatic.shafts.bodies import KNUCKLE_EYE, carrier, flange, knuckle_eyes, middle
from shared.stage.errors import UserError
from tests.mechanisms.automatic.shafts.proofs import box

SIZE: dict[str, Any] = {"bore": 0.08, "stroke": 0.08, "rod": 0.165, "speed": 100.0}


def radial(name: str = "radial-5", **more: Any) -> Mechanism:
    from mbsd import four_stroke

    return engine(name, **(SIZE | {"rods": MasterRod(0.046), "gas": four_stroke(7.0)} | more))


def along_of(m: Mechanism) -> Along:
    made = Automatic(m, m.sweep(steps=90)).along
    assert made is not None
    return made


@pytest.fixture(scope="module")
def five() -> Along:
    return along_of(radial())


def test_the_master_rod_carries_the_others_between_its_flanges(five: Along) -> None:
    links = five.machine.links
    assert carrier(five.machine, links["rod_1"]) is None
    assert all(carrier(five.machine, links[f"rod_{k}"]) is links["rod_1"] for k in (2, 3, 4, 5))
    assert [eye.on for eye in knuckle_eyes(five.machine, links["rod_1"])] == ["rod_2", "rod_3", "rod_4", "rod_5"]
    height, gap = five.thickness["rod_1"], five.measures.axial
    assert five.thickness["rod_2"] == pytest.approx(middle(height, gap))
    assert 2 * flange(height, gap) + 2 * gap + five.thickness["rod_2"] == pytest.approx(height)
    assert not five.axles, "knuckle pins are no axles beside the rods"
    five.refuse()


def test_all_liners_stay_clear_of_what_the_ring_of_knuckle_pins_sweeps(five: Along) -> None:
    swept = 40.0 + 46.0 + KNUCKLE_EYE * 80.0
    assert {own.shaft for own in five.cylinders.values()} == {five.machine.shafts["crank"]}
    assert all(own.low > swept for own in five.cylinders.values())
    strokes = [own.highest - own.lowest for own in five.cylinders.values()]
    assert strokes[0] == pytest.approx(80.0, rel=1e-4)
    assert all(1.0 < stroke / strokes[0] < 1.03 for stroke in strokes[1:])


@pytest.mark.slow
def test_a_radial_engine_is_built() -> None:
    """That nothing touches is proven of mechanisms/radial_five."""
    m = radial()
    made = Automatic(m, m.sweep(steps=90))
    bodies = made.solids()
    names = {name: [solid.name for solid in solids] for name, solids in bodies.items()}
    assert names["crank"] == ["crank", "rear_crank"], "the master rod's eye is closed, so its pin is pressed in"
    assert names["rod_1"] == ["rod_1", *(f"pin_knuckle_{k}" for k in (2, 3, 4, 5))]
    assert names["rod_3"] == ["rod_3"]
    rod = box(bodies["rod_1"][0])
    assert made.span("rod_1") == pytest.approx((rod.zmin, rod.zmax), abs=0.1)
    assert bodies["rod_1"][0].through_holes == 2 + 2 * 4, "knuckle pins go through two flanges"
    lower, upper = (box(solid) for solid in bodies["crank"])
    assert upper.zmin < lower.zmax < upper.zmax, "the pin goes through the web above"


def test_a_v_engine_with_a_master_rod_has_a_split_big_end() -> None:
    m = engine("V2", angle=60, **SIZE | {"rod": 0.19}, rods=MasterRod(0.048))
    own = along_of(m)
    own.refuse()
    names = {solid.name for solid in Automatic(m, m.sweep(steps=90)).solids()["rod_1"]}
    assert {"rod_1", "cap_rod_1", "pin_knuckle_2"} <= names


@pytest.mark.parametrize("count", [3, 7])
def test_other_radial_engines_pass(count: int) -> None:
    longer = 0.18 if count == 3 else 0.26
    along_of(radial(f"radial-{count}", rod=longer)).refuse()


def test_knuckle_pins_that_are_too_near_are_refused() -> None:
    with pytest.raises(UserError, match=r"'rod_2' turns on 'rod_1' 35 mm from the crank pin.*needs 42\.4 mm"):
        along_of(radial(rods=MasterRod(0.035))).refuse()
    with pytest.raises(UserError, match=r"'rod_2' and 'rod_3' turn on 'rod_1' .* from each other"):
        along_of(radial(rods=MasterRod(0.046, angles=(110, 140, 220, 290)))).refuse()


def test_rods_on_rods_in_planes_of_their_own_keep_their_axles() -> None:
    """A rocker on a leg beside it, as before."""
    from tools.models.shaft_machines import legs

    own = along_of(legs())
    assert len(own.axles) == 4, "three knees, and one axle for all hips"
    assert not any(knuckle_eyes(own.machine, link) for link in own.machine.links.values())
    assert math.isclose(own.measures.shank(own.machine.links["leg_1"], own.thickness), own.thickness["leg_1"])
