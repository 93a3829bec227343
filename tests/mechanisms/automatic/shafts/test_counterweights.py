"""Counterweights of shafts: what the solids weigh cancels what turns, in force and couple."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.machines.engines.engine import engine
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from mechanisms.stages.automatic.shafts.shaft_solids import Load, balanced_webs, loads, shaft_solid
from mechanisms.stages.parts.meshes import combined, mass_of
from mechanisms.stages.solve.masses import give_masses
from shared.contract import BodyParts, Mass, Parts, Provenance
from shared.contract.materials import MATERIALS
from shared.shapes.units import mm

STEEL = MATERIALS["steel"].density
SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.155, "spacing": 0.1, "speed": 100.0}
V = {"bank_offset": 0.023}
V6 = SIZE | {"spacing": 0.11, "bank_offset": 0.032}


def planned(layout: str, **given) -> Along:
    m = engine(layout, **given)
    made = Automatic(m, m.sweep(steps=90))
    assert made.along is not None
    return made.along


@pytest.mark.parametrize(
    ("layout", "given"),
    [
        ("I1", SIZE),
        ("I4", SIZE),
        ("V2", SIZE | V),
        ("V6", V6),
        ("V8", SIZE | V),
        ("flat-4", SIZE | {"spacing": 0.062}),
    ],
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
    m = engine("V2", piston_mass=0.5, rod_mass=0.6, rod_com=0.3, **(SIZE | V))
    made = Automatic(m, m.sweep(steps=90))
    assert made.along is not None
    (shaft,) = made.along.machine.shafts.values()
    carried = loads(made.along.machine, shaft, {})
    assert [load.mass for load in carried] == pytest.approx(2 * [0.6 * 0.7 + 0.5 * (0.5 + 0.6 * 0.3)])
    assert [load.z for load in carried] == pytest.approx([-11.5, 11.5])
    assert [math.hypot(load.x, load.y) for load in carried] == pytest.approx([40.0, 40.0])


def test_a_v_twin_of_parts_has_no_first_order_left() -> None:
    """At 90 degrees all of it turns with the shaft: the masses of the solids cancel it, and leave the second order."""
    m = engine("V2", **(SIZE | V))
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
