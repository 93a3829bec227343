"""Masses of parts along the normal of the plane: of solids by hand, and what the frame feels of a shaft's."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mechanisms.stages.parts.bodies import described_body
from mechanisms.stages.parts.meshes import combined, mass_of
from mechanisms.stages.solve.masses import give_masses
from shared.contract import BodyParts, Mass, Parts, Provenance
from shared.contract.materials import MATERIALS
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.solid import Solid
from tests.mechanisms.automatic.shafts.proofs import plan
from tools.models.shaft_machines import INLINE_TWO, engine

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
    assert described_body("arm", "bar", [Solid("bar", shape, "steel", 0)], files, None, along=True).mass.z is not None


def test_the_frame_feels_the_masses_of_the_parts() -> None:
    """Two throws at 180 degrees without counterweights on pistons: their couple turns with the shaft, rods rock it."""
    bodies = plan("INLINE_TWO").solids()
    assert bodies.along
    m = engine(INLINE_TWO)
    masses = {body: _mass(solids) for body, solids in bodies.items()}
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


def _mass(solids: list[Solid]) -> Mass:
    return combined(mass_of(solid.shape.val(), MATERIALS[solid.material].density, along=True) for solid in solids)


def _parts(masses: dict[str, Mass]) -> Parts:
    return Parts(
        mechanism="engine",
        provenance=Provenance(inputs="x", versions={}),
        bodies={name: BodyParts(pieces={}, mass=mass, z=0.0) for name, mass in masses.items()},
    )
