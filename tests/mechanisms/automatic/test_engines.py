"""Shafts of engines: cylinders, counterweights, knuckle pins and masses along the normal."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.machines.engines import engine as engines
from mbsd.machines.engines.master_rod import MasterRod
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from mechanisms.stages.automatic.shafts.bodies import KNUCKLE_EYE, carrier, flange, knuckle_eyes, middle
from mechanisms.stages.automatic.shafts.shaft_solids import Load, balanced_webs, loads, shaft_solid
from mechanisms.stages.parts.bodies import Measured, described_body
from mechanisms.stages.parts.meshes import combined, mass_of
from mechanisms.stages.solve.masses import give_masses
from shared.contract import BodyParts, Mass, Parts, Provenance
from shared.contract.materials import MATERIALS
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.solid import Solid
from shared.shapes.units import mm
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import plan
from tools.models.shaft_machines import INLINE_TWO, THROW, engine

# Engines by hand: a shaft, pistons in liners, each at its place, and nothing touches.


def along_of(made: Automatic) -> Along:
    assert made.along is not None
    return made.along


def test_a_v_four_has_two_rods_on_each_of_two_pins() -> None:
    own = along_of(plan("V_FOUR"))
    own.refuse()
    (shaft,) = own.shafts
    assert [pin.links for pin in shaft.pins] == [("rod_1", "rod_2"), ("rod_3", "rod_4")]
    assert len(shaft.journals) == 3


def test_an_inline_four_gets_a_bearing_between_all_throws() -> None:
    own = along_of(plan("INLINE_FOUR"))
    own.refuse()
    (shaft,) = own.shafts
    assert [pin.links for pin in shaft.pins] == [(f"rod_{k}",) for k in (1, 2, 3, 4)]
    assert len(shaft.journals) == len(own.bearers[0].journals) == 5
    for name, cylinder in own.cylinders.items():
        assert cylinder.outer * 2 < 100.0, name


@pytest.mark.parametrize("of", ["SINGLE", "INLINE_TWO", "INLINE_FOUR", "V_TWO", "V_FOUR"])
def test_pistons_stay_in_their_liners_and_clear_of_the_shaft(of: str) -> None:
    own = along_of(plan(of))
    (shaft,) = own.shafts
    for cylinder in own.cylinders.values():
        assert cylinder.highest - cylinder.lowest == pytest.approx(2000 * THROW, rel=1e-5)
        assert cylinder.highest + cylinder.crown < cylinder.top
        assert cylinder.low < cylinder.lowest
        assert shaft.counterweight < min(cylinder.low, cylinder.lowest - cylinder.skirt)
        assert shaft.swept < cylinder.low


def test_gas_tells_the_bore() -> None:
    m = engine(INLINE_TWO)
    area = math.pi / 4 * 0.07**2
    m.gas("gas", m.ground.at(0, 0, math.pi / 2), m.bodies["piston_1"].origin, area=area, pressure=2e5, at=0.105)
    own = along_of(Automatic(m, m.sweep(steps=90)))
    assert own.cylinders["piston_1"].bore == pytest.approx(70.0)
    m = engine([(0, 90, -0.03), (0, 270, 0.03)])
    m.gas("gas", m.ground.at(0, 0, math.pi / 2), m.bodies["piston_1"].origin, area=area, pressure=2e5, at=0.105)
    with pytest.raises(UserError, match="'piston_1' and 'piston_2' are 60 mm apart along z"):
        along_of(Automatic(m, m.sweep(steps=90))).refuse()


def test_a_flywheel_is_put_on_a_shaft_alone() -> None:
    made = plan("SINGLE")
    before = made.span("crank")[0]
    made.flywheel("crank")
    assert made.span("crank")[0] < before
    own = along_of(made)
    own.refuse()
    (shaft,), (cylinder,) = own.shafts, own.cylinders.values()
    assert own.flywheel(shaft) > cylinder.low, "it would reach the liner,"
    assert shaft.ends[0] < cylinder.piston.z - own.fins["piston_1"], "but turns below it"
    assert all(math.hypot(x, y) > own.flywheel(shaft) for x, y in own.bearers[0].places)
    with pytest.raises(UserError, match="'rod_1' becomes no shaft"):
        made.flywheel("rod_1")


def test_layers_are_not_asked_for_where_bodies_have_places() -> None:
    with pytest.raises(UserError, match="layers follow the places z"):
        plan("SINGLE").layer("rod_1", 2)


# Counterweights of shafts: what the solids weigh cancels what turns, in force and couple.


STEEL = MATERIALS["steel"].density
SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.155, "spacing": 0.1, "speed": 100.0}
V = {"bank_offset": 0.023}
V6 = SIZE | {"spacing": 0.11, "bank_offset": 0.032}


def planned(layout: str, **given) -> Along:
    m = engines.engine(layout, **given)
    made = Automatic(m, m.sweep(steps=90))
    assert made.along is not None
    return made.along


@pytest.mark.parametrize(
    ("layout", "given"),
    [("I1", SIZE), ("I4", SIZE), ("V2", SIZE | V), ("V6", V6), ("V8", SIZE | V), ("flat-4", SIZE | {"spacing": 0.062})],
)
def test_a_shaft_and_what_it_carries_turn_without_force_and_couple(layout: str, given: dict[str, float]) -> None:
    """Masses of rods and half the pistons on the pins, and the solid itself, to a thousandth of one throw."""
    own = planned(layout, **given)
    (plan,) = own.shafts
    carried = [Load(0.45, throw.x, throw.y, throw.z) for throw in plan.shaft.throws]
    shaft = mass_of(shaft_solid(plan, balanced_webs(plan, carried, STEEL)).val(), STEEL, along=True)
    assert shaft.z is not None
    assert shaft.products is not None
    z = mm(shaft.z)
    moment = shaft.mass * np.array([mm(x) for x in shaft.com]) + sum(
        load.mass * np.array([load.x, load.y]) for load in carried
    )
    couple = mm(1.0) ** 2 * np.array(shaft.products) + shaft.mass * z * np.array([mm(x) for x in shaft.com])
    couple += sum(load.mass * load.z * np.array([load.x, load.y]) for load in carried)
    scale = 0.45 * 40.0
    assert np.abs(moment).max() < 1e-3 * scale
    assert np.abs(couple).max() < 1e-3 * scale * 100.0


def test_counterweights_grow_with_what_they_carry_as_far_as_there_is_room() -> None:
    own = planned("V2", **(SIZE | V))
    (plan,) = own.shafts
    throws = plan.shaft.throws

    def left(mass: float) -> float:
        carried = [Load(mass, throw.x, throw.y, throw.z) for throw in throws]
        shaft = mass_of(shaft_solid(plan, balanced_webs(plan, carried, STEEL)).val(), STEEL)
        return shaft.mass * mm(shaft.com[1]) + sum(load.mass * load.y for load in carried)

    assert left(0.1) == pytest.approx(0.0, abs=0.02)
    assert left(0.45) == pytest.approx(0.0, abs=0.02)
    heavy = left(2.0)
    assert heavy > 20.0, "no room for so heavy ones"
    assert left(2.1) == pytest.approx(heavy + 2 * 0.1 * 40.0, rel=1e-6)


def test_what_a_pin_carries_is_the_rods_foot_and_half_of_what_slides() -> None:
    m = engines.engine("V2", piston_mass=0.5, rod_mass=0.6, rod_com=0.3, **(SIZE | V))
    made = Automatic(m, m.sweep(steps=90))
    assert made.along is not None
    (shaft,) = made.along.machine.shafts.values()
    carried = loads(made.along.machine, shaft, {})
    assert [load.mass for load in carried] == pytest.approx(2 * [0.6 * 0.7 + 0.5 * (0.5 + 0.6 * 0.3)])
    assert [load.z for load in carried] == pytest.approx([-11.5, 11.5])
    assert [math.hypot(load.x, load.y) for load in carried] == pytest.approx([40.0, 40.0])


def test_a_v_twin_of_parts_has_no_first_order_left() -> None:
    """At 90 degrees all of it turns with the shaft: the masses of the solids cancel it, and leave the second order."""
    m = engines.engine("V2", **(SIZE | V))
    bodies = Automatic(m, m.sweep(steps=90)).solids()
    masses = {body: _mass(solids) for body, solids in bodies.items()}
    give_masses(m, _parts(masses))
    sol = m.sweep(steps=180)
    piston, rod = masses["piston_1"], masses["rod_1"]
    slides = piston.mass + rod.mass * rod.com[0] / 0.155
    unit = slides * 0.04 * 100.0**2
    orders = sol.orders(sol.shaking().force, crank="crank")
    assert orders.largest[orders.index(1)] < 2e-3 * unit
    second = 0.04 / 0.155
    assert orders.largest[orders.index(2)] == pytest.approx(math.sqrt(2) * second * unit, rel=0.02)


def _mass(solids) -> Mass:
    return combined(mass_of(solid.shape.val(), MATERIALS[solid.material].density, along=True) for solid in solids)


def _parts(masses: dict[str, Mass]) -> Parts:
    return Parts(
        mechanism="engine",
        provenance=Provenance(inputs="x", versions={}),
        bodies={name: BodyParts(pieces={}, mass=mass, z=0.0) for name, mass in masses.items()},
    )


# Rods that carry rods: flanges with knuckle pins, and shafts in pieces for big ends that are not split.


SIZE_OF_KNUCKLES: dict[str, Any] = {"bore": 0.08, "stroke": 0.08, "rod": 0.165, "speed": 100.0}


def radial(name: str = "radial-5", **more: Any) -> Mechanism:
    from mbsd import four_stroke

    return engines.engine(name, **(SIZE_OF_KNUCKLES | {"rods": MasterRod(0.046), "gas": four_stroke(7.0)} | more))


def along_of_knuckles(m: Mechanism) -> Along:
    made = Automatic(m, m.sweep(steps=90)).along
    assert made is not None
    return made


@pytest.fixture(scope="module")
def five() -> Along:
    return along_of_knuckles(radial())


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


def test_a_v_engine_with_a_master_rod_has_a_split_big_end() -> None:
    m = engines.engine("V2", angle=60, **SIZE_OF_KNUCKLES | {"rod": 0.19}, rods=MasterRod(0.048))
    own = along_of_knuckles(m)
    own.refuse()
    names = {solid.name for solid in Automatic(m, m.sweep(steps=90)).solids()["rod_1"]}
    assert {"rod_1", "cap_rod_1", "pin_knuckle_2"} <= names


@pytest.mark.parametrize("count", [3, 7])
def test_other_radial_engines_pass(count: int) -> None:
    longer = 0.18 if count == 3 else 0.26
    along_of_knuckles(radial(f"radial-{count}", rod=longer)).refuse()


def test_knuckle_pins_that_are_too_near_are_refused() -> None:
    with pytest.raises(UserError, match=r"'rod_2' turns on 'rod_1' 35 mm from the crank pin.*needs 42\.4 mm"):
        along_of_knuckles(radial(rods=MasterRod(0.035))).refuse()
    with pytest.raises(UserError, match=r"'rod_2' and 'rod_3' turn on 'rod_1' .* from each other"):
        along_of_knuckles(radial(rods=MasterRod(0.046, angles=(110, 140, 220, 290)))).refuse()


def test_rods_on_rods_in_planes_of_their_own_keep_their_axles() -> None:
    """A rocker on a leg beside it, as before."""
    from tools.models.shaft_machines import legs

    own = along_of_knuckles(legs())
    assert len(own.axles) == 4, "three knees, and one axle for all hips"
    assert not any(knuckle_eyes(own.machine, link) for link in own.machine.links.values())
    assert math.isclose(own.measures.shank(own.machine.links["leg_1"], own.thickness), own.thickness["leg_1"])


# Masses of parts along the normal of the plane: of solids by hand, and what the frame feels of a shaft's.


SPEED = 2 * math.pi


def test_places_and_products_of_two_discs_are_those_of_particles() -> None:
    """Equal discs at (30, 0, 0 .. 4) and (0, 20, 10 .. 14) mm: their middles are particles, they have no products."""
    discs = [extruded(outline.circle(30.0, 0.0, 5.0), 4.0), extruded(outline.circle(0.0, 20.0, 5.0), 4.0, 10.0)]
    each = [mass_of(shape.val(), 1000.0, along=True) for shape in discs]
    together = combined(each)
    mass = math.pi * 25e-6 * 4e-3 * 1000.0
    assert [disc.z for disc in each] == pytest.approx([0.002, 0.012])
    assert together.z == pytest.approx(0.007)
    assert together.products == pytest.approx((2 * mass * -0.005 * 0.015, 2 * mass * 0.005 * 0.010))
    whole = mass_of(
        discs[0].union(extruded(outline.circle(15.0, 10.0, 20.0), 6.0, 4.0)).union(discs[1]).val(), 1.0, True
    )
    assert whole.products is not None
    assert whole.products[0] < 0 < whole.products[1]


def test_masses_without_places_have_none() -> None:
    shape = extruded(outline.circle(30.0, 0.0, 5.0), 4.0)
    plain = mass_of(shape.val(), 1000.0)
    assert plain.z is None
    assert combined([plain, mass_of(shape.val(), 1000.0, along=True)]).z is None
    files: dict[str, bytes] = {}
    assert described_body("arm", "bar", [Solid("bar", shape, "steel", 0)], files, None).mass.z is None
    assert (
        described_body("arm", "bar", [Solid("bar", shape, "steel", 0)], files, None, Measured(along=True)).mass.z
        is not None
    )


def test_the_frame_feels_the_masses_of_the_parts() -> None:
    """Two throws at 180 degrees without counterweights on pistons: their couple turns with the shaft, rods rock it."""
    bodies = plan("INLINE_TWO").solids()
    assert bodies.along
    m = engine(INLINE_TWO)
    masses = {body: _mass_masses_along(solids) for body, solids in bodies.items()}
    crank = masses["crank"]
    assert crank.products is not None
    assert crank.z is not None
    give_masses(m, _parts(masses))
    assert m.bodies["rod_1"].z == pytest.approx(-0.05, abs=1e-9)
    assert m.bodies["crank"].products == pytest.approx(crank.products)
    felt = m.sweep(steps=90).shaking(z=0.0)
    m.bodies["crank"].products = (0.0, 0.0)
    m.bodies["crank"].z = 0.0
    without = m.sweep(steps=90).shaking(z=0.0)
    turn = SPEED * np.asarray(m.sweep(steps=90).t)
    px, py = crank.products
    along = crank.mass * crank.z
    sx, sy = px + along * crank.com[0], py + along * crank.com[1]
    x, y = np.cos(turn) * sx - np.sin(turn) * sy, np.sin(turn) * sx + np.cos(turn) * sy
    scale = SPEED**2 * max(abs(px), abs(py))
    assert np.abs(felt.mx - without.mx + SPEED**2 * y).max() < 1e-9 * scale
    assert np.abs(felt.my - without.my - SPEED**2 * x).max() < 1e-9 * scale
    assert scale > 1e-6


def test_places_that_the_model_gives_stay_where_it_gives_masses() -> None:
    m = engine(INLINE_TWO, mass=0.4)
    mass = Mass(mass=0.3, com=(0.0, 0.0), inertia=1e-4, volume=1e-4, z=0.07, products=(1e-6, 0.0))
    give_masses(m, _parts({body: mass_of_moving(mass, body) for body in m.bodies}))
    assert m.bodies["piston_1"].z == -0.05
    assert m.bodies["piston_1"].mass == 0.4
    assert m.bodies["rod_1"].z == 0.07
    assert m.bodies["rod_1"].products == (1e-6, 0.0)


def mass_of_moving(mass: Mass, body: str) -> Mass:
    """Ground has a mass that nobody asks for."""
    return mass if body != "ground" else Mass(mass=1.0, com=(0.0, 0.0), inertia=1.0, volume=1.0)


def _mass_masses_along(solids: list[Solid]) -> Mass:
    return combined(mass_of(solid.shape.val(), MATERIALS[solid.material].density, along=True) for solid in solids)
