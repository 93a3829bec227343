"""Machines along a shaft: free places, legs, rams, valves and wheels."""

from __future__ import annotations

import math
import re
from itertools import combinations
from typing import Any

import pytest

from mbsd import Mechanism, constant_rate, four_stroke, harmonic, two_stroke
from mbsd.cams import Lift, flat_cam
from mbsd.machines.engines import engine as engines
from mbsd.machines.engines.opposed_pistons import opposed_pistons
from mbsd.machines.engines.valve_train import ValveTrain
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import checked
from tools.models import shaft_machines
from tools.models.shaft_machines import SINGLE, engine, legs, press

# Links that the model gives no place get one by the search for layers, those with one keep it.


def four_bar(**places: float) -> Mechanism:
    m = Mechanism("four_bar")
    bars = [
        m.bar(name, length, z=places.get(name))
        for name, length in (("crank", 0.04), ("coupler", 0.12), ("rocker", 0.1))
    ]
    m.revolute("O", m.ground.at(0, 0), bars[0].start)
    m.revolute("A", bars[0].end, bars[1].start)
    m.revolute("B", bars[1].end, bars[2].end)
    m.revolute("D", m.ground.at(0.13, 0), bars[2].start)
    m.drive_angle("motor", bars[0], constant_rate(2 * math.pi))
    m.start_near(crank=20, coupler=40, rocker=100)
    return m


def planned(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep(steps=90))


def test_two_of_three_bars_are_placed_beside_the_third() -> None:
    made = planned(four_bar(crank=0.03))
    low, high = made.span("crank")
    assert (low + high) / 2 == pytest.approx(30.0)
    assert made.along is not None
    made.along.refuse()
    spans = {name: made.span(name) for name in ("crank", "coupler", "rocker")}
    assert spans["coupler"][0] > spans["crank"][1], "the pivot of the crank stands on the base"
    for a, b in combinations(spans.values(), 2):
        assert a == b or a[0] > b[1] or b[0] > a[1]


def test_parts_with_two_places_given_are_built_and_nothing_touches() -> None:
    checked(four_bar(crank=0.0, rocker=0.004))


def test_a_machine_beside_an_engine_gets_layers() -> None:
    m = engine(SINGLE)
    arm = m.bar("arm", 0.05)
    m.revolute("hinge", m.ground.at(0.3, 0.0), arm.start)
    m.drive_angle("other", arm, constant_rate(2 * math.pi))
    made = planned(m)
    assert made.along is not None
    made.along.refuse()
    low, high = made.span("rod_1")
    assert (low + high) / 2 == pytest.approx(0.0)
    assert math.isfinite(made.span("arm")[0])


# Legs at several places on one shaft: plates on pins, rockers on one axle.


def refusal(m: Mechanism) -> str:
    with pytest.raises(UserError) as told:
        Automatic(m, m.sweep(steps=90)).solids()
    return str(told.value)


@pytest.mark.slow
def test_three_legs_on_a_shaft_are_built_and_nothing_touches() -> None:
    _, bodies = checked(legs())
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


# Rams: bodies that slide on ground and are driven in several planes, as those of presses.


def test_a_press_is_built_and_nothing_touches() -> None:
    _, bodies = checked(press())
    on_ground = [solid.name for solid in bodies["ground"]]
    assert [name for name in on_ground if "ram" in name] == ["column_ram_1", "column_ram_2", "deck_ram"]
    assert [solid.name for solid in bodies["ram"]] == ["ram", "pin_ram", "pin_ram_2"]
    beam = bodies["ram"][0].shape.val().BoundingBox()
    for k, z in ((1, -30.0), (2, 30.0)):
        rod = bodies[f"rod_{k}"][0].shape.val().BoundingBox()
        assert (rod.zmin + rod.zmax) / 2 == pytest.approx(z, abs=1e-6)
        assert beam.zmin < rod.zmin < rod.zmax < beam.zmax
    assert (beam.zmin + beam.zmax) / 2 == pytest.approx(0.0, abs=1e-6)


def test_the_columns_hold_the_ram_at_its_nearest_and_at_its_farthest_place() -> None:
    m = press()
    solution = m.sweep(steps=90)
    along = Automatic(m, solution).along
    assert along is not None
    plan = along.rams["ram"]
    y = -1000 * solution.body("ram").y
    assert plan.ram.farthest - plan.ram.nearest == pytest.approx(80.0, abs=1e-2)
    assert plan.begin < y.min() + plan.low, "it begins before the beam"
    assert plan.deck[0] > y.max() + plan.high, "the deck is beyond the beam"


@pytest.mark.parametrize(
    ("places", "given"),
    [((-0.03, 0.03), {"rod_z": False}), ((-0.04, 0.0, 0.04), {"ram_z": 0.0}), ((-0.01, 0.01), {"rod_z": False})],
)
@pytest.mark.slow
def test_places_may_be_told_by_the_shaft_and_rods_stand_side_by_side(places: tuple, given: dict) -> None:
    _, bodies = checked(press(places, **given))
    for k, z in enumerate(places, start=1):
        rod = bodies[f"rod_{k}"][0].shape.val().BoundingBox()
        assert (rod.zmin + rod.zmax) / 2 == pytest.approx(1000 * z, abs=1e-6)
    pins = [solid for solid in bodies["ram"] if solid.name.startswith("pin")]
    assert len(pins) == (1 if places == (-0.01, 0.01) else len(places)), "cheeks that touch share a pin"


def with_rocker(link: float) -> Mechanism:
    """The ram moves a rocker, too, by a link in this direction (degrees)."""
    m = press((-0.03,))
    rod, rocker = m.bar("link", 0.12, z=0.03), m.bar("rocker", 0.16, z=0.06)
    m.revolute("eye", m.bodies["ram"].at(0.0, 0.03), rod.start)
    m.revolute("knee", rod.end, rocker.start)
    x, y = 0.03 + 0.12 * math.cos(math.radians(link)), -0.24 + 0.12 * math.sin(math.radians(link))
    side = math.copysign(1.0, link)
    m.revolute("post", m.ground.at(x + side * 0.16, y), rocker.end)
    m.start_near(link=link, rocker=0 if side > 0 else 180)
    return m


def test_a_ram_may_move_a_rocker_beside_it() -> None:
    _, bodies = checked(with_rocker(50))
    assert [solid.name for solid in bodies["ram"]] == ["ram", "pin_ram", "pin_ram_2"]


def test_a_link_that_goes_where_the_beam_is_is_named() -> None:
    said = refusal(with_rocker(-50))
    assert re.search(r"'link' and the (beam|deck) of 'ram' meet at t=", said)


def test_rods_without_room_for_a_cheek_are_named() -> None:
    said = refusal(press((-0.006, 0.006)))
    assert "'rod_1' and 'rod_2' drive 'ram' 12 mm apart along z" in said
    assert "the cheek between them needs" in said


def test_what_drives_a_ram_must_be_links() -> None:
    m = press((-0.03,))
    other = m.body("other", z=0.03)
    m.revolute("turns", m.bodies["ram"].at(0.0, 0.0), other.origin)
    m.prismatic("across", m.ground.at(0.0, 0.0, -math.pi / 2), other.origin)
    assert "'other' in 'turns' is no link" in refusal(m)


# Overhead camshafts, belts and valves by themselves: proven clear of pistons, heads and each other.


def motor(layout: str, **valves: Any) -> Mechanism:
    gas = four_stroke(10.0, heat_density=1.2e6)
    size = {"bore": 0.08, "stroke": 0.08, "rod": 0.15, "spacing": 0.1, "speed": 100.0}
    return engines.engine(layout, **size, gas=gas, valves=ValveTrain(**valves))


def along(m: Mechanism) -> Along:
    plan = Automatic(m, m.sweep(steps=90)).along
    assert plan is not None
    return plan


@pytest.mark.slow
def test_a_single_with_valves_is_built_and_nothing_touches() -> None:
    made, bodies = checked(motor("I1"))
    assert made.along is not None
    for kind in ("intake_1", "exhaust_1"):
        plan = made.along.valves[kind]
        assert plan.valve.lift == pytest.approx(6.4, abs=1e-3)  # mm
        assert 2 * plan.radius == pytest.approx(0.4 * 80.0)
        held = [hold.force for solids in bodies.values() for solid in solids for hold in solid.holds]
        assert held.count(f"spring_{kind}") == 2  # on the head and on the valve, so that the film draws it between
    head = next(solid for solid in bodies["ground"] if solid.name == "head_piston_1")
    assert head.through_holes == 2  # its ports


@pytest.mark.parametrize(("layout", "shafts"), [("I4", 1), ("V2", 2)])
def test_engines_with_several_valves_pass(layout: str, shafts: int) -> None:
    plan = along(motor(layout))
    plan.refuse()
    cams = [shaft for shaft in plan.shafts if shaft.shaft.body.startswith("camshaft")]
    assert len(cams) == shafts
    for shaft in cams:
        assert len(shaft.mounted) == 1 + 2 * len(plan.cylinders) / shafts
        assert shaft.mounted[-1].is_wheel
        assert shaft.mounted[-1].low > shaft.ends[1]  # the pulley hangs beyond the last bearing


def test_a_follower_over_no_cylinder_is_told() -> None:
    lift = Lift.of((2.0, 0.004, "cycloidal"), (2.0, 0.0, "cycloidal"), (2 * math.pi - 4.0, 0.0))
    m = shaft_machines.engine(shaft_machines.SINGLE)
    cam, pushed = m.body("cam"), m.body("pushed", z=0.02)
    m.revolute("axis", m.ground.at(0.3, 0), cam.origin)
    m.prismatic("guide", m.ground.at(0.3, 0, math.pi / 2, z=0.02), pushed.origin)
    m.cam_flat("contact", cam.at(0, 0, z=0.02), pushed.at(0, 0, -math.pi / 2), flat_cam(lift, 0.02))
    m.drive_angle("turn", cam, constant_rate(2 * math.pi))
    m.start_near(cam=0, pushed=(0.3, 0.02, 90))
    with pytest.raises(UserError, match="'pushed' is pushed by the cam of 'contact' and slides over no cylinder"):
        along(m).refuse()


def test_valves_beside_their_bore_are_told() -> None:
    with pytest.raises(UserError, match=r"valve 'intake_1' is 36 mm along z from the middle of its cylinder"):
        along(motor("I1", apart=0.072)).refuse()


# Gears and belts of shafts at places along the normal, and machines that need them.


def along_wheels_along(m: Mechanism, pin: float | None = None) -> Along:
    plan = Automatic(m, m.sweep(steps=60), pin=pin).along
    assert plan is not None
    return plan


@pytest.mark.slow
def test_gears_in_a_train_and_a_belt_are_built_and_nothing_touches() -> None:
    made, bodies = checked(shaft_machines.geared_shafts())
    assert made.along is not None
    gears = {
        body: [solid.name for solid in solids if solid.name.startswith("gear_")] for body, solids in bodies.items()
    }
    assert [len(gears[f"shaft_{k}"]) for k in (1, 2, 3, 4)] == [1, 1, 1, 0]
    rims = [solid for solids in bodies.values() for solid in solids if solid.holds]
    assert {hold.force for solid in rims for hold in solid.holds} == {"belt"}
    assert all(abs(hold.z - 90.0) < 1e-6 for solid in rims for hold in solid.holds)  # mm: the place of its markers


def test_gears_of_a_train_stand_tooth_in_space() -> None:
    plan = along_wheels_along(shaft_machines.geared_shafts())
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
    _, bodies = checked(getattr(shaft_machines, name)())
    assert moved < set(bodies)
    assert all(solids and solids[0].name == body for body, solids in bodies.items() if body != "ground")


@pytest.mark.slow
def test_a_pair_of_legs_is_built_and_nothing_touches() -> None:
    """All six pairs are alike; each further pair takes its 30 s."""
    _, bodies = checked(shaft_machines.walker(1))
    assert len(bodies) == 2 + 12, "ground, crank, and two legs of six links"


def test_twelve_legs_walk_on_thinner_pins() -> None:
    plan = along_wheels_along(shaft_machines.walker())
    plan.refuse()
    assert len(plan.machine.links) == 72
    assert plan.sizes.pin < 5.0  # with those that follow from its lengths a bar meets the pivots' pins
    with pytest.raises(UserError, match=r"the pin of 'pivot_1l' meet .*pins thinner"):
        along_wheels_along(shaft_machines.walker(), pin=5.0).refuse()


def test_opposed_pistons_have_gears_and_no_heads() -> None:
    size = {"bore": 0.08, "stroke": 0.09, "rod": 0.17, "speed": 200.0}
    plan = along_wheels_along(opposed_pistons((0, 120, 240), phase=12, gas=two_stroke(15.0, heat_density=1e6), **size))
    plan.refuse()
    lower, upper = plan.cylinders["piston_1"], plan.cylinders["upper_piston_1"]
    assert lower.against is not None
    assert upper.against is not None
    assert lower.top + upper.top == pytest.approx(abs(lower.origin[1] - upper.origin[1]))
    assert lower.top > lower.highest + lower.crown


def test_crowns_that_would_meet_are_told() -> None:
    with pytest.raises(UserError, match="the crowns of 'piston_1' and 'upper_piston_1'"):
        along_wheels_along(opposed_pistons((0,), bore=0.08, stroke=0.09, rod=0.17, crown=0.03, speed=200.0)).refuse()


def test_a_wheel_among_the_throws_is_told() -> None:
    with pytest.raises(UserError, match="at half is at z = 0 mm, where 'crank_shaft' has its crank pins and bearings"):
        along_wheels_along(shaft_machines.loom(place=0.0)).refuse()


def test_a_wheel_that_is_too_small_for_its_shaft_is_told() -> None:
    m = shaft_machines.engine(shaft_machines.SINGLE)
    beside = m.body("beside")
    m.revolute("axis", m.ground.at(0.2, 0), beside.origin)
    m.belt("belt", m.bodies["crank"].at(0, 0, z=0.12), beside.at(0, 0, z=0.12), radius_i=0.01, radius_j=0.02)
    m.start_near(beside=0)
    with pytest.raises(UserError, match="the pulley of crank at belt_crank has no room for its shaft"):
        along_wheels_along(m).refuse()


@pytest.mark.filterwarnings("ignore:.*its sides lie in the planes")
def test_wheels_in_two_planes_and_in_none_are_told() -> None:
    m = shaft_machines.geared_shafts()
    m.bodies["shaft_2"].z = 0.06
    with pytest.raises(UserError, match="'mesh_1' are at z = 50 and 60 mm"):
        along_wheels_along(m).refuse()
    m = Mechanism("two")
    first, second, third = (m.body(name, z=z) for name, z in (("a", None), ("b", None), ("c", 0.01)))
    for k, body in enumerate((first, second, third)):
        m.revolute(f"axis_{k}", m.ground.at(0.05 * k, 0), body.origin)
    m.gear_pair("mesh", first.origin, second.origin, radius_i=0.025, radius_j=0.025)
    m.drive_angle("motor", first, constant_rate(1.0))
    m.drive_angle("other", third, constant_rate(1.0))
    with pytest.raises(UserError, match="the wheels of 'mesh' have no place z"):
        along_wheels_along(m).refuse()
