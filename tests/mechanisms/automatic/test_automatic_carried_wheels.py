"""Gears and pulleys on bodies whose layer a cam, a Geneva, a wheel on a road or an arm has: they lie on tubes."""

from __future__ import annotations

import math
from collections.abc import Callable
from math import pi, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, roller_cam
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.wheels import Wheel
from tests.mechanisms.automatic.layouts import meets

APART = 0.08

type Machine = Callable[[float, float], Mechanism]
"""Of the angle by which its world is turned and the radius of its wheel."""


def at(turn: float, x: float, y: float = 0.0) -> tuple[float, float]:
    """A place in a world that is turned."""
    c, s = math.cos(turn), math.sin(turn)
    return c * x - s * y, s * x + c * y


def camshaft(turn: float, radius: float) -> Mechanism:
    """A belt drives a cam whose disc reaches from 35 to 55 mm."""
    m = Mechanism("camshaft")
    motor, cam, valve = m.body("motor"), m.body("cam"), m.body("valve")
    m.revolute("O", m.ground.origin, cam.origin)
    m.revolute("M", m.ground.at(*at(turn, 0, -0.2)), motor.origin)
    m.belt("belt", motor.origin, cam.origin, 0.02, radius)
    lift = Lift.of((2 * pi / 3, 0.020, "cycloidal"), (2 * pi / 3, 0.0, "cycloidal"), (2 * pi / 3, 0.0))
    up = turn + pi / 2
    m.prismatic("guide", m.ground.at(*at(turn, 0, 0.12), up), valve.at(0, 0.06, pi / 2))
    m.cam_roller("contact", cam.origin, valve.origin, roller_cam(lift, base_radius=0.035, roller_radius=0.012))
    m.drive_angle("drive", motor, constant_rate(1.0))
    m.start_near(valve=(*at(turn, 0, 0.047), math.degrees(turn)))
    return m


def geneva(turn: float, radius: float) -> Mechanism:
    """A gear drives the crank, another one takes the wheel's motion off."""
    m = Mechanism("geneva")
    motor, crank, wheel, out = m.body("motor"), m.body("crank"), m.body("wheel"), m.body("out")
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(*at(turn, APART)), wheel.origin)
    m.revolute("M", m.ground.at(*at(turn, -0.02 - radius)), motor.origin)
    m.revolute("X", m.ground.at(*at(turn, APART + 0.02 + radius)), out.origin)
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
    m.start_near(arm=math.degrees(turn), planet=math.degrees(turn), slide=(*at(turn, 2 * radius), math.degrees(turn)))
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
    m.start_near(**{name: (*at(turn, x, 0.06), math.degrees(turn)) for name, x in starts.items()})
    return m


def press(turn: float, radius: float) -> Mechanism:
    """A belt and a pinion drive a gear whose crank pin lies 70 mm from its axis: beyond its teeth or within."""
    m = Mechanism("press")
    motor, pinion, gear, rod, ram = m.body("motor"), m.body("pinion"), m.body("gear"), m.bar("rod", 0.2), m.body("ram")
    m.revolute("M", m.ground.at(*at(turn, -radius - 0.025, 0.15)), motor.origin)
    m.revolute("A", m.ground.at(*at(turn, -radius - 0.025)), pinion.origin)
    m.revolute("B", m.ground.origin, gear.origin)
    m.belt("belt", motor.origin, pinion.origin, 0.02, 0.04)
    m.gear_pair("gears", pinion.origin, gear.origin, 0.025, radius)
    m.revolute("C", gear.at(0.07, 0), rod.start)
    m.revolute("D", rod.end, ram.origin)
    m.prismatic("way", m.ground.at(0, 0, turn), ram.origin)
    m.drive_angle("drive", motor, constant_rate(1.0))
    degrees = math.degrees(turn)
    m.start_near(gear=degrees, rod=degrees, ram=(*at(turn, 0.27), degrees))
    return m


def two_valves(turn: float, radius: float) -> Mechanism:
    """A belt drives a cam between two valves that move along one line."""
    m = Mechanism("two_valves")
    motor, cam = m.body("motor"), m.body("cam")
    m.revolute("O", m.ground.origin, cam.origin)
    m.revolute("M", m.ground.at(*at(turn, -0.25)), motor.origin)
    m.belt("belt", motor.origin, cam.origin, 0.02, radius)
    lift = Lift.of((2 * pi / 3, 0.020, "cycloidal"), (2 * pi / 3, 0.0, "cycloidal"), (2 * pi / 3, 0.0))
    profile = roller_cam(lift, base_radius=0.035, roller_radius=0.012)
    for name, side in (("in", turn), ("out", turn + pi)):
        valve = m.body(name)
        m.prismatic(f"guide_{name}", m.ground.at(*at(side, 0, 0.12), side + pi / 2), valve.at(0, 0.06, pi / 2))
        m.cam_roller(f"contact_{name}", cam.origin, valve.origin, profile)
        m.start_near(**{name: (*at(side, 0, 0.047), math.degrees(side))})
    m.drive_angle("drive", motor, constant_rate(1.0))
    return m


MACHINES: tuple[Machine, ...] = (camshaft, geneva, cardan, toy_car, press, two_valves)


def made_of(m: Mechanism) -> tuple[Automatic, dict[str, Wheel]]:
    made = Automatic(m, m.sweep(2 * pi, steps=240))
    return made, {wheel.body: wheel for wheel in made.layout.features if isinstance(wheel, Wheel)}


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
    assert all(wheel.shares for wheel in made.layout.features if isinstance(wheel, Wheel))
    assert set(made.decided.values()) == {0}
    whole = Automatic(m, m.sweep(2 * pi, steps=240))
    assert [wheel.body for wheel in whole.layout.features if isinstance(wheel, Wheel) and not wheel.shares] == ["gear"]
