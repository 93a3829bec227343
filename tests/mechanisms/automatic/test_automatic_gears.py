"""Wheels of automatic parts: whole teeth, standard modules, flanks that pass each other in phase."""

from __future__ import annotations

import math

import numpy as np
import pytest
from manifold3d import CrossSection

from mbsd import Mechanism, constant_rate, polynomial
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.gears import module_of
from mechanisms.stages.automatic.wheels.wheels import Wheel, wheel_shape
from shared.shapes.involute import foul_inside, longest_tip, shortest_tip, toothed
from shared.stage.errors import UserError
from tests.shared.shape_checks import checked
from tools.models.outlines import gap

SUN, PLANET, RING = 24, 18, 60


def pair(teeth: tuple[int, int], module: float = 1e-3, internal: bool = False) -> Mechanism:
    """Two wheels on pins of the ground, the first a ring around the second where ``internal``."""
    m = Mechanism("pair")
    a, b = m.body("a"), m.body("b")
    apart = module * (teeth[0] - teeth[1] if internal else teeth[0] + teeth[1]) / 2
    m.revolute("A", m.ground.at(0, 0), a.origin)
    m.revolute("B", m.ground.at(apart * math.cos(0.7), apart * math.sin(0.7)), b.origin)
    m.gear_pair("mesh", a.origin, b.origin, teeth=teeth, module=module, internal=internal)
    m.drive_angle("motor", a, constant_rate(1.0))
    m.start_near(a=20, b=50)
    return m


def planetary(planets: int, sun: int = SUN, planet: int = PLANET, module: float = 1e-3) -> Mechanism:
    """Sun driven, ring on ground."""
    m = Mechanism("planetary")
    hub, carrier = m.body("sun"), m.body("carrier")
    m.revolute("S", m.ground.at(0, 0), hub.origin)
    m.revolute("K", m.ground.at(0, 0), carrier.origin)
    apart = module * (sun + planet) / 2
    for k in range(planets):
        wheel, turn = m.body(f"planet_{k}"), 2 * math.pi * k / planets
        m.revolute(f"P{k}", carrier.at(apart * math.cos(turn), apart * math.sin(turn)), wheel.origin)
        m.gear_pair(f"sun_{k}", hub.origin, wheel.origin, teeth=(sun, planet), module=module)
        ring = m.ground.at(0, 0)
        m.gear_pair(f"ring_{k}", ring, wheel.origin, teeth=(sun + 2 * planet, planet), module=module, internal=True)
    m.drive_angle("motor", hub, constant_rate(1.0))
    m.start_near(sun=0, carrier=0, **{f"planet_{k}": 0 for k in range(planets)})
    return m


def _wheels(made: Automatic) -> list[Wheel]:
    return [feature for feature in made.layout.features if isinstance(feature, Wheel)]


@pytest.mark.parametrize("teeth", [(12, 30), (20, 20), (45, 17)])
def test_teeth_pass_each_other_with_play_and_in_phase(teeth: tuple[int, int]) -> None:
    m = pair(teeth)
    made = Automatic(m, m.sweep(2 * 2 * math.pi / teeth[0], steps=40))
    first, second = _wheels(made)
    assert (first.teeth, second.teeth) == teeth
    count = len(made.layout.times)
    gaps = [gap(made, first, second, at) for at in range(0, count, count // 25)]
    assert min(gaps) > 0.06
    assert max(gaps) < 0.2


def test_planets_between_sun_and_ring_mesh_with_both() -> None:
    m = planetary(3)
    made = Automatic(m, m.sweep(1.0, steps=20))  # in which the sun's teeth go on by more than a pitch
    wheels = _wheels(made)
    assert len(wheels) == 5
    for wheel in wheels:
        for mate in wheel.mates:
            if wheel.ring or not mate.ring:
                assert min(gap(made, wheel, mate, at) for at in range(0, 950, 90)) > 0.06
    levels = made.levels
    assert len({levels["sun"], *(levels[f"planet_{k}"] for k in range(3))}) == 1
    assert levels["carrier"] != levels["sun"]


def test_planets_that_cannot_be_assembled_are_refused() -> None:
    """25 + 61 teeth do not divide by three planets."""
    m = planetary(3, sun=25)
    with pytest.raises(UserError, match=r"miss each other by \d+ % of a pitch .* space equal planets"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).levels


def test_radii_get_a_standard_module_where_one_fits() -> None:
    assert module_of([20.0, 40.0]) in (2, 2.5)
    assert module_of([10.0, 15.0]) == 1
    odd = module_of([7.0, 11.0])
    assert odd is not None
    assert all(abs(2 * r / odd - round(2 * r / odd)) < 1e-9 for r in (7.0, 11.0))
    assert module_of([10.0, 10.0 * math.sqrt(2)]) is None


def test_radii_without_whole_teeth_are_told() -> None:
    m = Mechanism("odd")
    a, b = m.body("a"), m.body("b")
    m.revolute("A", m.ground.at(0, 0), a.origin)
    m.revolute("B", m.ground.at(0.05 + 0.05 * math.sqrt(2), 0), b.origin)
    m.gear_pair("mesh", a.origin, b.origin, radius_i=0.05, radius_j=0.05 * math.sqrt(2))
    m.drive_angle("motor", a, constant_rate(1.0))
    with pytest.raises(UserError, match=r"pitch radii a 50 mm, b 70\.71 mm have no whole numbers of teeth"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).levels


@pytest.mark.parametrize(("pinion", "less", "fits"), [(20, 4, False), (20, 7, False), (20, 8, True), (40, 8, True)])
def test_a_pinion_with_nearly_as_many_teeth_as_its_ring_is_refused(pinion: int, less: int, fits: bool) -> None:
    """Their tips would cross away from where they mesh."""
    m = pair((pinion + less, pinion), internal=True)
    made = Automatic(m, m.sweep(0.5, steps=20))
    if fits:
        assert set(made.levels) == {"a", "b"}
        return
    with pytest.raises(
        UserError, match=rf"b with {pinion} teeth cross .* ring gear of a with {pinion + less} .* 8 teeth"
    ):
        _ = made.levels


@pytest.mark.parametrize("pinion", [12, 20, 57, 200])
def test_tips_that_do_not_foul_overlap_nowhere(pinion: int) -> None:
    """The formula beside the outlines themselves, for every difference of teeth that may be in doubt."""
    fouls = []
    for ring in range(pinion + 3, pinion + 11):
        tip, inner = pinion / 2 + 1.0, max(ring / 2 - 0.9, shortest_tip(ring / 2, pinion / 2))
        fouls.append(foul_inside(pinion / 2, tip, ring / 2, inner))
        if not fouls[-1]:
            hole = toothed(ring, 1.0, ring / 2 + 1.25, inner, -0.03, 0.0)
            gear = toothed(pinion, 1.0, tip, pinion / 2 - 1.25, 0.06, 0.0) + np.array([(ring - pinion) / 2, 0.0])
            assert (CrossSection([gear]) - CrossSection([hole])).area() < 1e-9
    assert fouls == sorted(fouls, reverse=True)
    assert not fouls[5]


def test_wheels_whose_centres_nothing_holds_are_refused() -> None:
    m = Mechanism("loose")
    a, b, carriage = m.body("a"), m.body("b"), m.body("carriage")
    m.revolute("A", m.ground.at(0, 0), a.origin)
    m.prismatic("rail", m.ground.at(0, 0), carriage.origin)
    m.drive_coordinate("screw", m.ground.at(0, 0), carriage.origin, polynomial(0.1, 0.1))
    m.revolute("B", carriage.origin, b.origin)
    m.gear_pair("mesh", a.origin, b.origin, radius_i=0.05, radius_j=0.05)
    m.drive_angle("motor", a, constant_rate(1.0))
    with pytest.raises(UserError, match=r"'mesh': the centres of a and b are 100 to 200 mm apart .* mesh at 100 mm"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).levels


def test_a_small_pinion_shortens_the_teeth_of_its_mate() -> None:
    """The tip must not reach under the base circle: r_tip^2 = r_base^2 + (a sin 20)^2."""
    assert longest_tip(30.0, 6.0) == pytest.approx(
        math.hypot(30 * math.cos(math.radians(20)), 36 * math.sin(math.radians(20)))
    )
    made = Automatic(m := pair((30, 12)), m.sweep(1.0, steps=20))
    large = _wheels(made)[0]
    assert large.tip < large.radius + large.module


def test_wheels_are_sound_solids() -> None:
    wheel = Wheel("mesh", "a", 0, 0, 36.0, ring=False, teeth=24, module=3.0, tip=39.0, play=0.2)
    shape, holes = wheel_shape(wheel, 7.0, [])
    _, mesh = checked(shape, holes)
    assert holes >= 3
    assert np.linalg.norm(mesh.vertices[:, :2], axis=1).max() == pytest.approx(39.0)
    ring = Wheel("mesh", "a", 0, 0, 60.0, ring=True, teeth=40, module=3.0, tip=57.3, play=0.2)
    shape, holes = wheel_shape(ring, 7.0, [])
    _, mesh = checked(shape, holes)
    assert np.linalg.norm(mesh.vertices[:, :2], axis=1).min() > 57.0


def test_posts_of_a_ring_stay_under_its_rim() -> None:
    """Planets pass at the height where posts end, so these must not reach under the teeth."""
    m = planetary(3)
    made = Automatic(m, m.sweep(1.0, steps=20))
    ring = next(wheel for wheel in _wheels(made) if wheel.ring)
    plan = made.plan()
    posts = [solid for solid in plan.solids["ground"] if solid.name.startswith("post_")]
    assert len(posts) == 4
    for post in posts:
        box = post.shape.val().BoundingBox()
        centre = np.array([box.center.x, box.center.y])
        assert np.linalg.norm(centre - [ring.x, ring.y]) - box.xlen / 2 > ring.root + 0.2


def test_a_pivot_on_the_axis_of_a_wheel_of_ground_stands_on_that_wheel() -> None:
    m = Mechanism("standing", gravity=None)
    carrier, planet = m.bar("carrier", 0.1), m.body("planet")
    m.revolute("O", m.ground.origin, carrier.start)
    m.revolute("P", carrier.end, planet.origin)
    m.gear_pair("g", m.ground.origin, planet.origin, teeth=(30, 20), module=0.004)
    m.drive_angle("motor", carrier, constant_rate(2.0))
    m.start_near(carrier=0, planet=(0.1, 0, 0))
    made = Automatic(m, m.sweep(steps=90))
    boxes = {solid.name: solid.shape.val().BoundingBox() for solid in made.solids(engraved_too=False)["ground"]}
    assert boxes["pedestal_O"].zmin > boxes["gear_g"].zmax
    assert boxes["pedestal_O"].zmax < made.span("carrier")[0]
    assert boxes["pedestal_O"].zlen > made.sizes.scale
