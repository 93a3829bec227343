"""Gears and belts against Willis' formula, whole turns of the arm included."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, MobilityError, ModelError, constant_rate

PLANETARY = json.loads((Path(__file__).parent / "reference" / "analytic_planetary.json").read_text())
SUN, PLANET, RING = 0.020, 0.030, 0.080  # radii in the ratio of the teeth


def _planetary(fixed: str, **speeds: float) -> Mechanism:
    """Sun, planet, ring and carrier; one of them fixed, one driven."""
    m = Mechanism("planetary", gravity=None)
    sun, ring, carrier, planet = m.body("sun"), m.body("ring"), m.body("carrier"), m.body("planet", 0.1)
    for body in (sun, ring, carrier):
        m.revolute(f"{body.name} axle", m.ground.origin, body.origin)
    m.revolute("planet axle", carrier.at(SUN + PLANET, 0), planet.origin)
    m.gear_pair("sun-planet", sun.origin, planet.origin, SUN, PLANET)
    m.gear_pair("ring-planet", ring.origin, planet.origin, RING, PLANET, internal=True)
    m.drive_angle("brake", m.bodies[fixed], constant_rate(0.0))
    for name, speed in speeds.items():
        m.drive_angle("motor", m.bodies[name], constant_rate(speed))
    m.start_near(carrier=20, planet=7)
    return m


@pytest.mark.parametrize(
    ("key", "fixed", "driven"),
    [
        ("ring_fixed_ws=100", "ring", {"sun": 100.0}),
        ("carrier_fixed_ws=100", "carrier", {"sun": 100.0}),
        ("sun_fixed_wr=100", "sun", {"ring": 100.0}),
    ],
)
def test_planetary_train_by_willis(key: str, fixed: str, driven: dict[str, float]) -> None:
    expected = PLANETARY["expected"]["zs=20,zp=30,zr=80"][key]
    sol = _planetary(fixed, **driven).sweep(duration=1.0, steps=2000)  # sixteen turns of the sun
    for letter, name in (("c", "carrier"), ("p", "planet"), ("r", "ring"), ("s", "sun")):
        if f"w_{letter}" in expected:
            body = sol.body(name)
            np.testing.assert_allclose(body.omega, expected[f"w_{letter}"], rtol=1e-12)
            np.testing.assert_allclose(body.theta - body.theta[0], expected[f"w_{letter}"] * sol.t, atol=1e-9)
    assert sol.stats.acceleration_residual < 1e-6


def test_torques_of_a_planetary_train_balance() -> None:
    """Ring fixed: the carrier gives 5 times the sun's torque; ring, sun and load add up to nothing."""
    m = _planetary("ring", sun=100.0)
    m.gravity = (0.0, -9.81)  # the planet's weight must be carried
    sol = m.sweep(duration=0.6, steps=200)
    sun, ring = sol.driver("motor").torque, sol.driver("brake").torque
    weight = 0.1 * 9.81 * (SUN + PLANET) * np.cos(sol.body("carrier").theta)  # torque wanted by the load at the carrier
    np.testing.assert_allclose(5 * sun, weight, atol=1e-12)
    np.testing.assert_allclose(sun + ring, weight, atol=1e-12)


@settings(max_examples=20)
@given(
    r_i=st.floats(0.05, 0.4),
    r_j=st.floats(0.05, 0.4),
    crossed=st.booleans(),
    turned=st.floats(-3, 3),
    phase=st.floats(-2, 2),
)
def test_belts_on_fixed_centres(r_i: float, r_j: float, crossed: bool, turned: float, phase: float) -> None:
    m = Mechanism("belt")
    first, second = m.body("first"), m.body("second", 1.0, (0.0, 0.0), 0.3)
    m.revolute("A", m.ground.at(0.1, 0.2), first.at(0, 0, 0.4))
    m.revolute("B", m.ground.at(0.1 + math.cos(turned), 0.2 + math.sin(turned)), second.origin)
    m.belt("belt", first.at(0, 0, 1.0), second.at(0, 0, -2.0), r_i, r_j, crossed=crossed, phase=(0.3, phase))
    m.drive_angle("motor", first, lambda t: 0.3 + 40.0 * t * t)
    sol = m.sweep(duration=1.0, steps=60)
    ratio = -r_i / r_j if crossed else r_i / r_j
    second_view = sol.body("second")
    np.testing.assert_allclose(second_view.theta, phase + ratio * 40.0 * sol.t**2, atol=1e-9)
    np.testing.assert_allclose(second_view.alpha, ratio * 80.0, rtol=1e-6)
    np.testing.assert_allclose(sol.driver("motor").torque, 0.3 * 80.0 * ratio**2, rtol=1e-6)
    np.testing.assert_allclose(sol.joint("belt").torque, 0.3 * 80.0 * ratio, rtol=1e-6)


def test_a_geared_five_bar_closes_with_its_phase() -> None:
    """Both cranks turn; their gears say how. The coupler curve closes after two turns for a ratio of 2."""
    m = Mechanism("geared_five_bar")
    left, right = m.bar("left", 0.05), m.bar("right", 0.04)
    a, b = m.bar("a", 0.15, 1.0), m.bar("b", 0.15, 1.0)
    m.revolute("O", m.ground.at(0, 0), left.start)
    m.revolute("P", m.ground.at(0.15, 0), right.start)
    m.revolute("A", left.end, a.start)
    m.revolute("B", right.end, b.start)
    m.revolute("C", a.end, b.end)
    m.gear_pair("gears", left.start, right.start, 0.10, 0.05, phase=(0.0, math.radians(60)))
    m.drive_angle("motor", left, constant_rate(2 * math.pi))
    m.trace("C", a.end)
    m.start_near(left=0, right=60, a=50, b=130)
    sol = m.sweep(duration=1.0, steps=720)
    np.testing.assert_allclose(sol.body("right").theta, math.radians(60) - 2 * sol.body("left").theta, atol=1e-11)
    assert abs(sol.point("C").x[-1] - sol.point("C").x[0]) < 1e-9
    assert sol.stats.power_residual < 1e-8


def test_gears_that_cannot_be_are_refused() -> None:
    m = Mechanism("train")
    first, second = m.body("first"), m.body("second")
    with pytest.raises(ModelError, match=r"train: joint 'g' has radius_j -0.1 m; it must be positive"):
        m.gear_pair("g", first.origin, second.origin, 0.1, -0.1)
    with pytest.raises(ModelError, match=r"gear_pair 'g' is internal.*give the ring first"):
        m.gear_pair("g", first.origin, second.origin, 0.1, 0.2, internal=True)
    with pytest.raises(ModelError, match="phase"):
        m.gear_pair("g", first.origin, second.origin, 0.1, 0.2, phase=(1.0,))


def test_a_planetary_train_moves_freely_with_its_energy_and_ratios() -> None:
    """Ring braked by a weld, a rod on the carrier swings: the gears add their inertia, energy stays."""
    m = Mechanism("swinging_train", gravity=(0.0, -9.81))
    sun, carrier = m.body("sun", 0.3, (0, 0), 1e-3), m.body("carrier", 1.0, (0.2, 0.0), 0.01)
    planet, ring = m.body("planet", 0.1, (0, 0), 2e-4), m.body("ring", 1.0)
    m.weld("brake", m.ground.origin, ring.origin)
    m.revolute("sun axle", m.ground.origin, sun.origin)
    m.revolute("carrier axle", m.ground.origin, carrier.origin)
    m.revolute("planet axle", carrier.at(SUN + PLANET, 0), planet.origin)
    m.gear_pair("sun-planet", sun.origin, planet.origin, SUN, PLANET)
    m.gear_pair("ring-planet", ring.origin, planet.origin, RING, PLANET, internal=True)
    m.start_near(carrier=0, sun=10, planet=20)
    sol = m.simulate(duration=2.0, steps=200, tolerance=1e-10)
    reduced = 1.0 * 0.2**2 + 0.01 + 0.1 * 0.05**2 + 25 * 1e-3 + (5 / 3) ** 2 * 2e-4  # on the carrier, by Willis
    load = 9.81 * (1.0 * 0.2 + 0.1 * 0.05)
    carrier_view = sol.body("carrier")
    np.testing.assert_allclose(carrier_view.alpha, -load * np.cos(carrier_view.theta) / reduced, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(sol.body("sun").theta, math.radians(10) + 5 * carrier_view.theta, atol=1e-9)
    assert np.ptp(sol.energy.total) < 1e-7


def test_two_motors_on_geared_shafts_are_refused() -> None:
    m = Mechanism("train")
    first, second = m.body("first"), m.body("second")
    m.revolute("A", m.ground.origin, first.origin)
    m.revolute("B", m.ground.at(0.3, 0), second.origin)
    m.gear_pair("teeth", first.origin, second.origin, 0.1, 0.2)
    m.drive_angle("one", first, constant_rate(1.0))
    assert m.mobility().dof == 1
    m.drive_angle("two", second, constant_rate(1.0, 0.3))
    with pytest.raises(
        MobilityError, match="driver 'two' drives a freedom that the joints and driver 'one' already fix"
    ):
        m.sweep()
