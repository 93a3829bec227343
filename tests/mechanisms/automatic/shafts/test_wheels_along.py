"""Gears and belts of shafts at places along the normal, and machines that need them."""

from __future__ import annotations

import pytest

from mbsd import Mechanism, constant_rate, two_stroke
from mbsd.machines.engines.opposed_pistons import opposed_pistons
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from shared.stage.errors import UserError
from tests.mechanisms.automatic.shafts.proofs import checked
from tools.models import shaft_machines
from tools.models import shaft_machines as models


def along(m: Mechanism, pin: float | None = None) -> Along:
    plan = Automatic(m, m.sweep(steps=60), pin=pin).along
    assert plan is not None
    return plan


@pytest.mark.slow
def test_gears_in_a_train_and_a_belt_are_built_and_nothing_touches() -> None:
    made, bodies = checked(models.geared_shafts())
    assert made.along is not None
    gears = {
        body: [solid.name for solid in solids if solid.name.startswith("gear_")] for body, solids in bodies.items()
    }
    assert [len(gears[f"shaft_{k}"]) for k in (1, 2, 3, 4)] == [1, 1, 1, 0]
    rims = [solid for solids in bodies.values() for solid in solids if solid.holds]
    assert {hold.force for solid in rims for hold in solid.holds} == {"belt"}
    assert all(abs(hold.z - 90.0) < 1e-6 for solid in rims for hold in solid.holds)  # mm: the place of its markers


def test_gears_of_a_train_stand_tooth_in_space() -> None:
    plan = along(models.geared_shafts())
    first, second, third = (plan.wheels.wheels_on(f"shaft_{k}")[0].wheel for k in (1, 2, 3))
    assert (first.teeth, second.teeth, third.teeth) == (20, 30, 25)
    for left, right in ((first, second), (second, third)):
        turned = [plan.machine.poses[wheel.body][0, 2] + (wheel.phase or 0.0) for wheel in (left, right)]
        tooth = turned[0] % left.pitch / left.pitch  # of the way to the next tooth, on the line of centres
        space = (3.141592653589793 - turned[1]) % right.pitch / right.pitch
        assert (tooth + space) % 1.0 == pytest.approx(0.5, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "moved"),
    [
        ("loom", {"sley", "heald_1", "heald_2", "arm_1", "lift_2"}),
        ("sewing_machine", {"needle_bar", "take_up", "feed_rocker"}),
        ("knuckle_press", {"ram", "con_1", "lower_2"}),
        ("triplex_pump", {"plunger_1", "plunger_2", "plunger_3"}),
    ],
)
@pytest.mark.slow
def test_machines_with_a_shaft_are_built_and_nothing_touches(name: str, moved: set[str]) -> None:
    _, bodies = checked(getattr(models, name)())
    assert moved < set(bodies)
    assert all(solids and solids[0].name == body for body, solids in bodies.items() if body != "ground")


@pytest.mark.slow
def test_a_pair_of_legs_is_built_and_nothing_touches() -> None:
    """Those of all six pairs are alike; each pair more takes its 30 s."""
    _, bodies = checked(models.walker(1))
    assert len(bodies) == 2 + 12, "ground, crank, and two legs of six links"


def test_twelve_legs_walk_on_thinner_pins() -> None:
    plan = along(models.walker())
    plan.refuse()
    assert len(plan.machine.links) == 72
    assert plan.sizes.pin < 5.0  # with those that follow from its lengths a bar meets the pivots' pins
    with pytest.raises(UserError, match=r"the pin of 'pivot_1l' meet .*pins thinner"):
        along(models.walker(), pin=5.0).refuse()


def test_opposed_pistons_have_gears_and_no_heads() -> None:
    size = {"bore": 0.08, "stroke": 0.09, "rod": 0.17, "speed": 200.0}
    plan = along(opposed_pistons((0, 120, 240), phase=12, gas=two_stroke(15.0, heat_density=1e6), **size))
    plan.refuse()
    lower, upper = plan.cylinders["piston_1"], plan.cylinders["upper_piston_1"]
    assert lower.against is not None
    assert upper.against is not None
    assert lower.top + upper.top == pytest.approx(abs(lower.origin[1] - upper.origin[1]))
    assert lower.top > lower.highest + lower.crown


def test_crowns_that_would_meet_are_told() -> None:
    with pytest.raises(UserError, match="the crowns of 'piston_1' and 'upper_piston_1'"):
        along(opposed_pistons((0,), bore=0.08, stroke=0.09, rod=0.17, crown=0.03, speed=200.0)).refuse()


def test_a_wheel_among_the_throws_is_told() -> None:
    with pytest.raises(UserError, match="at half is at z = 0 mm, where 'crank_shaft' has its crank pins and bearings"):
        along(models.loom(place=0.0)).refuse()


def test_a_wheel_that_is_too_small_for_its_shaft_is_told() -> None:
    m = shaft_machines.engine(shaft_machines.SINGLE)
    beside = m.body("beside")
    m.revolute("axis", m.ground.at(0.2, 0), beside.origin)
    m.belt("belt", m.bodies["crank"].at(0, 0, z=0.12), beside.at(0, 0, z=0.12), radius_i=0.01, radius_j=0.02)
    m.start_near(beside=0)
    with pytest.raises(UserError, match="the pulley of crank at belt_crank has no room for its shaft"):
        along(m).refuse()


@pytest.mark.filterwarnings("ignore:.*its sides lie in the planes")
def test_wheels_in_two_planes_and_in_none_are_told() -> None:
    m = models.geared_shafts()
    m.bodies["shaft_2"].z = 0.06
    with pytest.raises(UserError, match="'mesh_1' are at z = 50 and 60 mm"):
        along(m).refuse()
    m = Mechanism("two")
    first, second, third = (m.body(name, z=z) for name, z in (("a", None), ("b", None), ("c", 0.01)))
    for k, body in enumerate((first, second, third)):
        m.revolute(f"axis_{k}", m.ground.at(0.05 * k, 0), body.origin)
    m.gear_pair("mesh", first.origin, second.origin, radius_i=0.025, radius_j=0.025)
    m.drive_angle("motor", first, constant_rate(1.0))
    m.drive_angle("other", third, constant_rate(1.0))
    with pytest.raises(UserError, match="the wheels of 'mesh' have no place z"):
        along(m).refuse()
