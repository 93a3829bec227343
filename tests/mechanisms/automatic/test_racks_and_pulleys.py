"""Racks with pinions, and pulleys with belts, as automatic parts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, harmonic, polynomial
from mechanisms.belt_drive import mechanism as belt_drive
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.racks import Rack
from mechanisms.stages.automatic.wheels.wheels import TUBE, Wheel, shape_of
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.build import extruded
from shared.shapes.involute import longest_rack_tip, rack_outline
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.stage.errors import UserError
from tests.shared.shape_checks import checked
from tools.models.outlines import gap

# Racks by themselves: in phase with their pinions wherever these go, on moving bodies and on ground.


def drive(
    teeth: int = 20, module: float = 2e-3, ground: bool = False, turn: float = 0.0, start: float = 0.3, low: float = 0.0
) -> Mechanism:
    """A pinion that a driver swings: on ground it moves a rack, on a carriage it goes along one on ground.

    All is turned by ``turn`` (rad); ``low`` (m) is how far the moving slide is from the pitch line.
    """
    m = Mechanism("drive")
    pinion, slider = m.body("pinion"), m.body("slider")
    radius, (c, s) = module * teeth / 2, (math.cos(turn), math.sin(turn))
    guide = m.ground.at(s * low, -c * low, turn)
    if ground:
        m.prismatic("guide", m.ground.at(-s * radius, c * radius, turn), slider.origin)
        m.revolute("axle", slider.origin, pinion.origin)
        m.rack_and_pinion("mesh", m.ground.at(0, 0, turn), pinion.origin, teeth=teeth, module=module)
        m.drive_angle("motor", pinion, harmonic(1.0, 2.0, 0.0, turn + start))
        m.start_near(slider=(-s * radius, c * radius, math.degrees(turn)), pinion=math.degrees(turn + start))
    else:
        m.revolute("axle", m.ground.at(-s * radius, c * radius), pinion.origin)
        m.prismatic("guide", guide, slider.at(0, -low))
        m.rack_and_pinion("mesh", slider.origin, pinion.origin, teeth=teeth, module=module)
        m.drive_angle("motor", pinion, harmonic(1.0, 2.0, 0.0, start))
        m.start_near(slider=(0, 0, math.degrees(turn)), pinion=math.degrees(start))
    return m


def made_of(m: Mechanism) -> tuple[Automatic, Rack, Wheel]:
    made = Automatic(m, m.sweep(steps=40))
    return made, made.layout.select(Rack)[0], made.layout.select(Wheel)[0]


@settings(max_examples=10, deadline=None)
@given(
    st.integers(12, 40), st.booleans(), st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.sampled_from([3e-4, 2e-3, 0.05])
)
def test_teeth_pass_each_other_at_all_times(teeth: int, ground: bool, turn: float, start: float, module: float) -> None:
    made, rack, pinion = made_of(drive(teeth, module, ground, turn, start))
    assert pinion.teeth == teeth
    assert made.decided[rack.layer] == made.decided["pinion"]
    count = len(made.layout.times)
    gaps = [gap(made, rack, pinion, at) for at in range(0, count, count // 6)]
    flank = pinion.play / 2 * math.cos(math.radians(20.0)) * made.sizes.scale
    root = 0.25 * module * 1e3  # between tips and roots of fine teeth there is less room than between flanks
    assert 0.98 * min(flank, root) < min(gaps) < 1.06 * flank  # looked at in some poses
    assert max(gaps) < 1.2 * flank


@pytest.mark.parametrize("ground", [False, True])
@pytest.mark.parametrize("low", [0.0, 0.03])
def test_bar_and_what_carries_it_are_sound(ground: bool, low: float) -> None:
    made, rack, _ = made_of(drive(ground=ground, low=low))
    plan = made.plan()
    named = {solid.name: solid for solid in plan.solids["ground" if ground else "slider"]}
    bar = named["rack_mesh"]
    checked(bar.shape, 0)
    first, last = rack.teeth
    box = bar.shape.val().BoundingBox()
    assert box.xlen == pytest.approx((last - first + 1) * rack.pitch)
    assert box.zmax == pytest.approx(made.heights.top("pinion"))
    studs = [solid for name, solid in named.items() if name.startswith("stud_")]
    assert len(studs) == 2
    if not ground:
        plate = made.span("slider")
        between = sorted((*plate, made.heights.top(rack.layer) * made.sizes.scale, box.zmin * made.sizes.scale))
        stud = studs[0].shape.val().BoundingBox()
        assert stud.zmin * made.sizes.scale == pytest.approx(between[1], abs=0.05)
        assert stud.zmax * made.sizes.scale == pytest.approx(between[2], abs=0.05)


def test_a_pinion_off_the_pitch_line_is_told_with_its_distance() -> None:
    m = Mechanism("off")
    pinion, slider, lift = m.body("pinion"), m.body("slider"), m.body("lift")
    upright = m.ground.at(0, 0, math.pi / 2)
    m.prismatic("column", upright, lift.at(0, 0, math.pi / 2))
    m.drive_coordinate("jack", upright, lift.origin, polynomial(0.02, 0.01))
    m.revolute("axle", lift.origin, pinion.origin)
    m.prismatic("guide", m.ground.origin, slider.origin)
    m.rack_and_pinion("mesh", slider.origin, pinion.origin, radius=0.02)
    m.drive_angle("motor", pinion, harmonic(1.0, 2.0))
    with pytest.raises(UserError, match=r"'mesh': at t=.* s the pinion's centre is 25 mm above .* radius, 20 mm"):
        _ = Automatic(m, m.sweep(0.5, steps=20)).levels


def test_a_small_pinion_shortens_the_teeth_of_its_rack() -> None:
    """They end where they would meet the flank below the base circle: h = r sin(20 deg)^2."""
    assert longest_rack_tip(8.0) == pytest.approx(8.0 * math.sin(math.radians(20)) ** 2)
    _, rack, pinion = made_of(drive(12))
    assert rack.tip == pytest.approx(longest_rack_tip(pinion.radius))
    _, rack, _ = made_of(drive(30))
    assert rack.tip == pytest.approx(rack.module)


def test_outline_of_a_rack() -> None:
    points = rack_outline(3, 2.0, 2.0, -2.5, 8.0, 0.1, 5.0)
    x, y = points.T
    area = 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    pitch = 2.0 * math.pi
    middle, tan = pitch / 2 - 0.1, math.tan(math.radians(20.0))
    tooth = 4.5 * (middle + tan * (2.5 - 2.0))
    assert area == pytest.approx(3 * (pitch * 8.0 + tooth))
    assert np.ptp(x) == pytest.approx(3 * pitch)


# Pulleys by themselves: one sees them turn, by windows or by small holes.


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


@pytest.mark.parametrize("root", [13.95, 14.5, 16.0, 18.0])
def test_holes_of_a_pulley_on_a_tube_stay_clear_of_the_tube(root: float) -> None:
    """A tube stands on the disc and closes what it covers, so that holes under it would be blind."""
    m = belt_drive.build(belt_drive.Params())
    (pulley,) = Automatic(m, m.sweep(steps=12)).layout.wheels["small"]
    pulley.radius += root - pulley.root
    inner, outer = TUBE
    shape, windows = shape_of(pulley, 7.0, [(0.0, 0.0, Eye(outer, 0.0))])
    shape = shape.union(extruded(circle(0, 0, outer), 11.0, -10.0)).cut(extruded(circle(0, 0, inner), 30.0, -15.0))
    solid = only_solid(shape, "disc")
    check_mesh(read_mesh(stl_bytes(solid)), solid.Volume(), 1 + windows, "disc")
    marks = [face.BoundingBox() for face in solid.Faces() if face.geomType() == "CYLINDER"]
    aside = [math.hypot(*box.center.toTuple()[:2]) - max(box.xlen, box.ylen) / 2 for box in marks]
    assert all(place >= outer for place in aside if place > 0.0)


@pytest.mark.parametrize("teeth", [6, 8, 9, 12])
def test_sprockets_of_few_teeth_keep_a_disc_round_their_tube(teeth: int) -> None:
    """Where a chain's spaces are deep, pins are thinner, so that the disc is not lost in its tube or its pin."""
    m, pitch = Mechanism("chains"), 0.0125
    wheels = [m.body(name) for name in "abc"]
    for k, wheel in enumerate(wheels):
        m.revolute(f"shaft{k}", m.ground.at(0.8 * k, 0.05 * k), wheel.origin)
    m.belt("first", wheels[0].origin, wheels[1].origin, teeth=(12, teeth), pitch=pitch)
    m.belt("second", wheels[1].origin, wheels[2].origin, teeth=(teeth, 12), pitch=pitch)
    m.drive_angle("motor", wheels[0], polynomial(0.0, 1.0))
    made = Automatic(m, m.sweep(1.0, steps=12))
    pulleys = made.layout.wheels["b"]
    assert len(pulleys) == 2
    assert all(pulley.root > TUBE[1] for pulley in pulleys)


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
