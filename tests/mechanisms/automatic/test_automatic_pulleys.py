"""Pulleys by themselves: one sees them turn, by windows or by small holes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mechanisms.belt_drive import mechanism as belt_drive
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.wheels import shape_of
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.link import Eye


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
def test_both_pulleys_show_that_they_turn(scale: float) -> None:
    p = belt_drive.Params()
    m = belt_drive.build(replace(p, radius=scale * p.radius, distance=scale * p.distance))
    made = Automatic(m, m.sweep(steps=12))
    for body, holes in (("small", 4), ("large", 7)):
        (pulley,) = made.layout.wheels[body]
        shape, through_holes = shape_of(pulley, 7.0, [(0.0, 0.0, Eye(13.0, 11.0))])
        assert through_holes == holes
        solid = only_solid(shape, body)
        check_mesh(read_mesh(stl_bytes(solid)), solid.Volume(), holes, body)


def test_a_pulley_without_room_has_none() -> None:
    m = belt_drive.build(belt_drive.Params())
    (pulley,) = Automatic(m, m.sweep(steps=12)).layout.wheels["small"]
    pulley.radius -= 3.0
    assert pulley.root < 12.0
    assert shape_of(pulley, 7.0, [(0.0, 0.0, Eye(13.0, 11.0))])[1] == 1


def test_a_pulley_whose_body_reaches_beyond_it_lies_in_a_layer_of_its_own() -> None:
    """A belt would run through the plate that reaches to the traced point."""
    m = belt_drive.build(belt_drive.Params())
    far = 2.0 * m.joints["belt"].params["radius_i"]
    m.trace("far", m.bodies["small"].at(far, 0.0))
    made = Automatic(m, m.sweep(steps=12))
    levels = made.decided
    (pulley,) = made.layout.wheels["small"]
    assert not pulley.shares
    assert levels[pulley.layer] != levels["small"]
    (disc,) = [solid for solid in made.solids(False)["small"] if solid.name.startswith("gear_")]
    solid = only_solid(disc.shape, disc.name)
    check_mesh(read_mesh(stl_bytes(solid)), solid.Volume(), disc.through_holes, disc.name)
