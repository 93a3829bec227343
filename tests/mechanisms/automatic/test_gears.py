"""Gears of automatic parts: teeth in phase, wheels that an arm carries, and stepped wheels on tubes."""

from __future__ import annotations

import math
from collections.abc import Callable
from math import pi, sin
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import CrossSection

from mbsd import Mechanism, constant_rate, polynomial
from mbsd.cams import Lift, roller_cam
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.gears import module_of
from mechanisms.stages.automatic.wheels.wheels import TUBE, Wheel, wheel_shape
from shared.shapes.involute import foul_inside, longest_tip, shortest_tip, toothed
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import meets
from tests.shared.shape_checks import checked
from tools.models.outlines import gap

# Wheels of automatic parts: whole teeth, standard modules, flanks that pass each other in phase.


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
    return made.layout.select(Wheel)


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


# Gears and pulleys on bodies whose layer a cam, a Geneva, a wheel on a road or an arm has: they lie on tubes.


APART = 0.08

type Machine = Callable[[float, float], Mechanism]
"""Mechanism by the angle by which its world is turned and the radius of its wheel."""


def seen(turn: float, x: float, y: float = 0.0) -> tuple[float, float]:
    """A place in a world that is turned."""
    c, s = math.cos(turn), math.sin(turn)
    return c * x - s * y, s * x + c * y


def camshaft(turn: float, radius: float) -> Mechanism:
    """A belt drives a cam whose disc reaches from 35 to 55 mm."""
    m = Mechanism("camshaft")
    motor, cam, valve = m.body("motor"), m.body("cam"), m.body("valve")
    m.revolute("O", m.ground.origin, cam.origin)
    m.revolute("M", m.ground.at(*seen(turn, 0, -0.2)), motor.origin)
    m.belt("belt", motor.origin, cam.origin, 0.02, radius)
    lift = Lift.of((2 * pi / 3, 0.020, "cycloidal"), (2 * pi / 3, 0.0, "cycloidal"), (2 * pi / 3, 0.0))
    up = turn + pi / 2
    m.prismatic("guide", m.ground.at(*seen(turn, 0, 0.12), up), valve.at(0, 0.06, pi / 2))
    m.cam_roller("contact", cam.origin, valve.origin, roller_cam(lift, base_radius=0.035, roller_radius=0.012))
    m.drive_angle("drive", motor, constant_rate(1.0))
    m.start_near(valve=(*seen(turn, 0, 0.047), math.degrees(turn)))
    return m


def geneva(turn: float, radius: float) -> Mechanism:
    """A gear drives the crank, another one takes the wheel's motion off."""
    m = Mechanism("geneva")
    motor, crank, wheel, out = m.body("motor"), m.body("crank"), m.body("wheel"), m.body("out")
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(*seen(turn, APART)), wheel.origin)
    m.revolute("M", m.ground.at(*seen(turn, -0.02 - radius)), motor.origin)
    m.revolute("X", m.ground.at(*seen(turn, APART + 0.02 + radius)), out.origin)
    m.geneva("index", crank.origin, wheel.origin, slots=4, radius=APART * sin(pi / 4))
    m.gear_pair("in", motor.origin, crank.origin, 0.02, radius)
    m.gear_pair("off", wheel.origin, out.origin, radius, 0.02)
    m.drive_angle("drive", motor, constant_rate(1.0))
    m.start_near(crank=math.degrees(turn), wheel=math.degrees(turn) + 45)
    return m


def cardan(turn: float, radius: float) -> Mechanism:
    """Cardan's straight line: a pin on the pitch circle of a planet that has half of its ring's radius."""
    m = Mechanism("cardan")
    arm, planet, slide = m.bar("arm", radius), m.body("planet"), m.body("slide")
    m.revolute("O", m.ground.origin, arm.start)
    m.revolute("P", arm.end, planet.origin)
    m.gear_pair("ring", m.ground.origin, planet.origin, 2 * radius, radius, internal=True)
    m.revolute("S", planet.at(radius, 0), slide.origin)
    m.prismatic("line", m.ground.at(0, 0, turn), slide.origin)
    m.drive_angle("drive", arm, constant_rate(1.0, turn))
    m.start_near(arm=math.degrees(turn), planet=math.degrees(turn), slide=(*seen(turn, 2 * radius), math.degrees(turn)))
    return m


def toy_car(turn: float, radius: float) -> Mechanism:
    """A pinion on the frame drives a gear on the rear wheel; both wheels roll on one slope."""
    m = Mechanism("toy_car")
    frame, rear, front, pinion = m.body("frame"), m.body("rear"), m.body("front"), m.body("pinion")
    m.revolute("R", frame.origin, rear.origin)
    m.revolute("F", frame.at(0.2, 0), front.origin)
    m.revolute("P", frame.at(0.02 + radius, 0), pinion.origin)
    m.gear_pair("gears", pinion.origin, rear.origin, 0.02, radius)
    for name, wheel in (("rear_road", rear), ("front_road", front)):
        m.rolling_disc(name, m.ground.at(0, 0, turn), wheel.origin, 0.06)
    m.drive_angle("drive", rear, constant_rate(-1.0, turn))
    starts = {"frame": 0.0, "rear": 0.0, "front": 0.2, "pinion": 0.02 + radius}
    m.start_near(**{name: (*seen(turn, x, 0.06), math.degrees(turn)) for name, x in starts.items()})
    return m


def press(turn: float, radius: float) -> Mechanism:
    """A belt and a pinion drive a gear whose crank pin lies 70 mm from its axis: beyond its teeth or within."""
    m = Mechanism("press")
    motor, pinion, gear, rod, ram = m.body("motor"), m.body("pinion"), m.body("gear"), m.bar("rod", 0.2), m.body("ram")
    m.revolute("M", m.ground.at(*seen(turn, -radius - 0.025, 0.15)), motor.origin)
    m.revolute("A", m.ground.at(*seen(turn, -radius - 0.025)), pinion.origin)
    m.revolute("B", m.ground.origin, gear.origin)
    m.belt("belt", motor.origin, pinion.origin, 0.02, 0.04)
    m.gear_pair("gears", pinion.origin, gear.origin, 0.025, radius)
    m.revolute("C", gear.at(0.07, 0), rod.start)
    m.revolute("D", rod.end, ram.origin)
    m.prismatic("way", m.ground.at(0, 0, turn), ram.origin)
    m.drive_angle("drive", motor, constant_rate(1.0))
    degrees = math.degrees(turn)
    m.start_near(gear=degrees, rod=degrees, ram=(*seen(turn, 0.27), degrees))
    return m


def two_valves(turn: float, radius: float) -> Mechanism:
    """A belt drives a cam between two valves that move along one line."""
    m = Mechanism("two_valves")
    motor, cam = m.body("motor"), m.body("cam")
    m.revolute("O", m.ground.origin, cam.origin)
    m.revolute("M", m.ground.at(*seen(turn, -0.25)), motor.origin)
    m.belt("belt", motor.origin, cam.origin, 0.02, radius)
    lift = Lift.of((2 * pi / 3, 0.020, "cycloidal"), (2 * pi / 3, 0.0, "cycloidal"), (2 * pi / 3, 0.0))
    profile = roller_cam(lift, base_radius=0.035, roller_radius=0.012)
    for name, side in (("in", turn), ("out", turn + pi)):
        valve = m.body(name)
        m.prismatic(f"guide_{name}", m.ground.at(*seen(side, 0, 0.12), side + pi / 2), valve.at(0, 0.06, pi / 2))
        m.cam_roller(f"contact_{name}", cam.origin, valve.origin, profile)
        m.start_near(**{name: (*seen(side, 0, 0.047), math.degrees(side))})
    m.drive_angle("drive", motor, constant_rate(1.0))
    return m


MACHINES: tuple[Machine, ...] = (camshaft, geneva, cardan, toy_car, press, two_valves)


def made_of(m: Mechanism) -> tuple[Automatic, dict[str, Wheel]]:
    made = Automatic(m, m.sweep(2 * pi, steps=240))
    return made, {wheel.body: wheel for wheel in made.layout.select(Wheel)}


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.6])
@pytest.mark.parametrize(
    ("machine", "radius", "on_tubes"),
    [
        (camshaft, 0.03, {"cam"}),
        (camshaft, 0.07, {"cam"}),
        (geneva, 0.04, {"crank", "wheel"}),
        (geneva, 0.07, {"wheel"}),  # the crank's arm ends within its gear
        (cardan, 0.05, {"planet"}),
        (toy_car, 0.04, {"rear"}),
    ],
)
def test_what_fills_a_layer_leaves_wheels_to_tubes(
    machine: Machine, radius: float, on_tubes: set[str], turn: float
) -> None:
    made, wheels = made_of(machine(turn, radius))
    moving = {body: wheel for body, wheel in wheels.items() if body != "ground"}
    assert {body for body, wheel in moving.items() if not wheel.shares} == on_tubes
    for wheel in wheels.values():
        for mate in wheel.mates:
            assert made.decided[wheel.layer] == made.decided[mate.layer]  # type: ignore[attr-defined]
    for body in on_tubes:
        assert made.decided[wheels[body].layer] != made.decided[body]
    assert not meets(made)


@settings(max_examples=8, deadline=None)
@given(st.sampled_from(MACHINES), st.integers(6, 18), st.floats(-pi, pi))
def test_machines_of_any_size_get_layers(machine: Machine, fives: int, turn: float) -> None:
    """Radii of whole 5 mm, of which there are gears."""
    m = machine(turn, 0.005 * fives)
    made = Automatic(m, m.sweep(2 * pi, steps=180))
    assert not meets(made)


def test_gear_beside_a_geneva_is_not_passed_by_locking_disc_and_pin() -> None:
    """Both reach from the crank's layer to the wheel's, and the wheel's own gear must not lie between these."""
    made, wheels = made_of(geneva(0.0, 0.04))
    crank, wheel, gear = (made.decided[name] for name in ("crank", "wheel", wheels["wheel"].layer))
    assert not min(crank, wheel) <= gear <= max(crank, wheel)


def test_arm_that_stays_away_from_the_mate_lies_in_the_gears_layer() -> None:
    """A rocker is one piece with a gear that swings by a third of a turn."""
    m = Mechanism("rocker")
    gear, pinion = m.bar("gear", 0.12), m.body("pinion")
    m.revolute("O", m.ground.origin, gear.start)
    m.revolute("P", m.ground.at(-0.08, 0), pinion.origin)
    m.gear_pair("mesh", gear.start, pinion.origin, 0.05, 0.03)
    m.drive_angle("drive", gear, constant_rate(1.0, -1.0))
    made = Automatic(m, m.sweep(2.0, steps=60))
    assert all(wheel.shares for wheel in made.layout.select(Wheel))
    assert set(made.decided.values()) == {0}
    whole = Automatic(m, m.sweep(2 * pi, steps=240))
    assert [wheel.body for wheel in whole.layout.select(Wheel) if not wheel.shares] == ["gear"]


# Rings that turn and stepped gears by themselves: each toothed rim in its layer, carried by its body's plate.


def ring_drive(teeth: tuple[int, int], turn: float = 0.0, module: float = 1e-3) -> Mechanism:
    """A pinion on ground drives a ring on ground around it."""
    m = Mechanism("ring_drive")
    ring, pinion = m.body("ring"), m.body("pinion")
    apart = module * (teeth[0] - teeth[1]) / 2
    m.revolute("R", m.ground.at(0, 0), ring.origin)
    m.revolute("P", m.ground.at(apart * math.cos(turn), apart * math.sin(turn)), pinion.origin)
    m.gear_pair("mesh", ring.origin, pinion.origin, teeth=teeth, module=module, internal=True)
    m.drive_angle("motor", pinion, constant_rate(1.0, turn))
    m.start_near(ring=20, pinion=math.degrees(turn))
    return m


def two_stages(teeth: tuple[int, int, int, int], bend: float = 0.0, module: float = 1e-3) -> Mechanism:
    """Wheel 1 drives 2, 3 is one with 2 and drives 4; at ``bend`` = pi the last turns about the first one's axis."""
    m = Mechanism("two_stages")
    first, middle, last = m.body("first"), m.body("middle"), m.body("last")
    a, b = (module * (teeth[k] + teeth[k + 1]) / 2 for k in (0, 2))
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(a, 0), middle.origin)
    m.revolute("C", m.ground.at(a + b * math.cos(bend), b * math.sin(bend)), last.origin)
    m.gear_pair("one", first.origin, middle.origin, teeth=teeth[:2], module=module)
    m.gear_pair("two", middle.origin, last.origin, teeth=teeth[2:], module=module)
    m.drive_angle("motor", first, constant_rate(1.0))
    return m


def between(meshes: list[Any]) -> float:
    """The height (mm) between two pieces, one above the other."""
    low, high = sorted(meshes, key=lambda mesh: mesh.vertices[:, 2].min())
    return float(high.vertices[:, 2].min() - low.vertices[:, 2].max())


@settings(max_examples=6, deadline=None)
@given(st.integers(12, 24), st.integers(20, 40), st.floats(-3.0, 3.0))
def test_teeth_of_a_ring_that_turns_pass_its_pinion(pinion: int, more: int, turn: float) -> None:
    m = ring_drive((pinion + more, pinion), turn)
    made = Automatic(m, m.sweep(1.0, steps=20))
    ring, small = _wheels(made)
    assert ring.ring
    assert made.decided[ring.layer] == made.decided["pinion"] != made.decided["ring"]
    count = len(made.layout.times)
    assert min(gap(made, ring, small, at) for at in range(0, count, count // 6)) > 0.06


def test_cup_is_rim_and_bottom() -> None:
    m = ring_drive((60, 18))
    made = Automatic(m, m.sweep(1.0, steps=20))
    solids = {solid.name: solid for solid in made.solids(engraved_too=False)["ring"]}
    rim, bottom = solids["ring_mesh"], solids["ring"]
    meshes = [checked(solid.shape, solid.through_holes)[1] for solid in (rim, bottom)]
    assert bottom.through_holes == 6  # windows and the bore
    assert 0 < between(meshes) < 0.1
    assert np.ptp(meshes[0].vertices[:, 0]) == pytest.approx(np.ptp(meshes[1].vertices[:, 0]), rel=1e-3)


@settings(max_examples=6, deadline=None)
@given(st.integers(18, 30), st.integers(36, 60), st.floats(-1.8, 1.8))
def test_stepped_wheels_mesh_in_two_layers(small: int, large: int, bend: float) -> None:
    m = two_stages((small, large, small, large), bend)
    made = Automatic(m, m.sweep(1.0, steps=20))
    pairs = [(wheel, mate) for wheel in _wheels(made) for mate in wheel.mates if isinstance(mate, Wheel)]
    assert len(pairs) == 4
    count = len(made.layout.times)
    for wheel, mate in pairs:
        assert min(gap(made, wheel, mate, at) for at in range(0, count, count // 4)) > 0.06
        assert made.decided[wheel.layer] == made.decided[mate.layer]
    assert made.decided["first"] != made.decided["last"]


@pytest.mark.parametrize("order", [(18, 54, 18, 54), (54, 18, 54, 18)])
@pytest.mark.slow
def test_second_wheel_stands_on_a_tube_that_leaves_the_pin_free(order: tuple[int, int, int, int]) -> None:
    m = two_stages(order)
    made = Automatic(m, m.sweep(1.0, steps=20))
    solids = {solid.name: solid for solid in made.solids(engraved_too=False)["middle"]}
    name = next(name for name in solids if name.startswith("gear_"))
    second, plate = solids[name], solids["middle"]
    meshes = [checked(solid.shape, solid.through_holes)[1] for solid in (second, plate)]
    inner = np.hypot(*meshes[0].vertices[:, :2].T).min()
    assert inner == pytest.approx(TUBE[0] * made.sizes.scale, rel=1e-3)
    assert 0 < between(meshes) < 0.1


def test_two_stages_back_to_the_first_axis() -> None:
    """A clock's motion work: minutes and hours about one axis."""
    m = two_stages((18, 36, 18, 36), math.pi)
    made = Automatic(m, m.sweep(1.0, steps=20))
    assert made.decided["first"] != made.decided["last"]
    assert {solid.name for solid in made.solids(engraved_too=False)["middle"]} >= {"middle", "bushing_B_low"}


@pytest.mark.parametrize("bend", [0.5, 0.9, 2.0, 2.4, -1.2])
def test_pinion_whose_two_mates_overlap_is_two(bend: float) -> None:
    """A pinion of 12 teeth between wheels of 60 and 48: they meet unless they are far round it from each other."""
    module = 1e-3
    m = Mechanism("long_pinion")
    first, middle, last = m.body("first"), m.body("middle"), m.body("last")
    m.revolute("A", m.ground.at(-36 * module, 0), first.origin)
    m.revolute("B", m.ground.origin, middle.origin)
    m.revolute("C", m.ground.at(-30 * module * math.cos(bend), 30 * module * math.sin(bend)), last.origin)
    m.gear_pair("one", first.origin, middle.origin, teeth=(60, 12), module=module)
    m.gear_pair("two", middle.origin, last.origin, teeth=(12, 48), module=module)
    m.drive_angle("motor", first, constant_rate(1.0))
    made = Automatic(m, m.sweep(1.0, steps=40))
    pinions = [wheel for wheel in _wheels(made) if wheel.body == "middle"]
    overlap = math.hypot(36 - 30 * math.cos(bend), 30 * math.sin(bend)) < 57  # with their teeth
    assert len(pinions) == (2 if overlap else 1)
    assert (made.decided["first"] != made.decided["last"]) == overlap
    assert not meets(made)
    count = len(made.layout.times)
    for wheel in pinions:
        for mate in wheel.mates:
            assert isinstance(mate, Wheel)
            assert min(gap(made, wheel, mate, at) for at in range(0, count, count // 4)) > 0.06
