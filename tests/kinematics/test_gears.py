"""Gears and belts against Willis' formula, whole turns of the arm included."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import AssemblyError, Mechanism, MobilityError, ModelError, SimulationError, constant_rate
from tools.models.guided import loose_gears

PLANETARY = json.loads((Path(__file__).parents[1] / "published" / "reference" / "analytic_planetary.json").read_text())
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


def _pair(distance: float, **wheels: object) -> Mechanism:
    m = Mechanism("train", gravity=None)
    first, second = m.body("first", 1.0, inertia=1e-3), m.body("second", 1.0, inertia=1e-3)
    m.revolute("A", m.ground.origin, first.origin)
    m.revolute("B", m.ground.at(distance, 0), second.origin)
    m.gear_pair("g", first.origin, second.origin, **wheels)  # pyright: ignore[reportArgumentType]
    m.drive_angle("motor", first, constant_rate(3.0))
    return m


@pytest.mark.parametrize(("internal", "distance"), [(False, 0.060), (True, 0.020)])
def test_gears_by_teeth_are_those_of_their_radii(internal: bool, distance: float, tmp_path: Path) -> None:
    teeth = (40, 20)
    m = _pair(distance, teeth=teeth, module=0.002, internal=internal)
    other = _pair(distance, radius_i=0.040, radius_j=0.020, internal=internal)
    here, there = m.sweep(1.0, steps=10), other.sweep(1.0, steps=10)
    np.testing.assert_array_equal(here.q, there.q)
    np.testing.assert_allclose(here.body("second").omega, 3.0 * 2 * (1 if internal else -1))
    assert here.packed.size == there.packed.size
    assert m.joints["g"].params == {"teeth": teeth, "module": 0.002, "internal": internal, "phase": None}
    m.save(tmp_path / "train.json")
    loaded = Mechanism.load(tmp_path / "train.json")
    assert loaded.joints["g"].params == m.joints["g"].params
    np.testing.assert_array_equal(loaded.sweep(1.0, steps=10).q, here.q)
    m.draw().save(tmp_path / "train.svg")
    m.change("g", teeth=(48, 24) if internal else (36, 24))
    if internal:
        m.change("g", module=0.020 * 2 / 24)
    np.testing.assert_allclose(m.sweep(1.0, steps=10).body("second").omega, 6.0 if internal else -4.5)
    m.change("g", teeth=None, module=None, radius_i=0.025 if internal else 0.05, radius_j=0.005 if internal else 0.01)
    np.testing.assert_allclose(m.sweep(1.0, steps=10).body("second").omega, 15.0 if internal else -15.0)


@pytest.mark.parametrize("method", ["sweep", "simulate", "equilibrium"])
def test_a_centre_distance_that_does_not_fit_the_teeth_is_told(method: str) -> None:
    m = _pair(0.0601, teeth=(20, 40), module=0.002)
    says = r"train: gear_pair 'g': its centres are 0\.0601 m apart, but .* and 20 \+ 40 teeth need .* = 0\.06 m\."
    with pytest.raises(AssemblyError, match=says):
        getattr(m, method)(*([1.0] if method != "equilibrium" else []))
    with pytest.raises(AssemblyError, match=r"40 - 20 teeth need 0\.002 \* \(40 - 20\) / 2 = 0\.02 m"):
        _pair(0.06, teeth=(40, 20), module=0.002, internal=True).sweep(1.0)
    with pytest.raises(AssemblyError, match=r"0\.06 m apart.*= 60 m"):  # a module in millimetres
        _pair(0.06, teeth=(20, 40), module=2.0).sweep(1.0)


@pytest.mark.parametrize(
    ("wheels", "says"),
    [
        ({}, r"needs radius_i= and radius_j= \(m\), or teeth= and module= \(m\)"),
        ({"radius_i": 0.1}, "needs radius_i= and radius_j="),
        ({"teeth": (20, 40)}, "needs radius_i= and radius_j="),
        ({"module": 0.002}, "needs radius_i= and radius_j="),
        ({"radius_i": 0.1, "radius_j": 0.1, "teeth": (20, 40), "module": 0.002}, "has radius_i, radius_j and teeth"),
        ({"radius_i": 0.1, "radius_j": 0.1, "module": 0.002}, "has radius_i, radius_j and teeth= and module=; give"),
        ({"teeth": (20, 40.5), "module": 0.002}, r"has 40\.5 teeth; give two whole numbers .* from 3 on"),
        ({"teeth": (2, 40), "module": 0.002}, "has 2 teeth"),
        ({"teeth": (True, 40), "module": 0.002}, "has True teeth"),
        ({"teeth": 20, "module": 0.002}, "teeth 20; give two whole numbers"),
        ({"teeth": (20, 30, 40), "module": 0.002}, r"teeth \(20, 30, 40\); give two whole numbers"),
        ({"teeth": "ab", "module": 0.002}, "teeth 'ab'"),
        ({"teeth": (20, 40), "module": 0.0}, "module 0 m; it must be positive"),
        (
            {"teeth": (20, 40), "module": 0.002, "internal": True},
            "internal, so 20 teeth is the ring's .*above 40 teeth",
        ),
    ],
)
def test_teeth_that_cannot_be_are_refused(wheels: dict[str, object], says: str) -> None:
    with pytest.raises(ModelError, match=f"train: .*'g'.*{says}"):
        _pair(0.06, **wheels)


def test_a_rack_and_a_toothed_belt_by_teeth(tmp_path: Path) -> None:
    def steering(height: float) -> Mechanism:
        m = Mechanism("steering")
        pinion, rack = m.body("pinion"), m.body("rack")
        m.revolute("axle", m.ground.origin, pinion.origin)
        m.prismatic("guide", m.ground.at(0, -height), rack.origin)
        m.rack_and_pinion("teeth", rack.origin, pinion.origin, teeth=20, module=0.003)
        m.drive_angle("wheel", pinion, constant_rate(1.0))
        return m

    m = steering(0.030)
    m.save(tmp_path / "steering.json")
    m.draw().save(tmp_path / "steering.svg")
    for mechanism in (m, Mechanism.load(tmp_path / "steering.json")):
        way = mechanism.sweep(2.0).body("rack").x
        assert way[-1] - way[0] == pytest.approx(0.030 * 2.0, abs=1e-12)
    says = (
        r"steering: rack_and_pinion 'teeth': the pinion's centre is 0\.031 m above .* need 0\.003 \* 20 / 2 = 0\.03 m"
    )
    with pytest.raises(AssemblyError, match=says):
        steering(0.031).sweep(1.0)
    with pytest.raises(ModelError, match=r"teeth is 2\.5; it must be a whole number"):
        m.rack_and_pinion("again", m.bodies["rack"].origin, m.bodies["pinion"].origin, teeth=2.5, module=1.0)  # pyright: ignore[reportArgumentType]

    b = Mechanism("belt")
    small, large = b.body("small"), b.body("large")
    b.revolute("A", b.ground.at(0, 0), small.origin)
    b.revolute("B", b.ground.at(0.2, 0), large.origin)
    b.belt("strap", small.origin, large.origin, teeth=(18, 60), pitch=0.005)
    b.drive_angle("motor", small, constant_rate(10.0))
    sol = b.sweep(1.0)
    np.testing.assert_allclose(sol.body("large").omega, 3.0)
    b.change("strap", teeth=None, pitch=None, radius_i=18 * 0.005 / (2 * math.pi), radius_j=60 * 0.005 / (2 * math.pi))
    np.testing.assert_allclose(b.sweep(1.0).q, sol.q, atol=1e-14)
    b.draw().save(tmp_path / "belt.svg")


@pytest.mark.parametrize(
    ("method", "options"),
    [("dop853", {"tolerance": 1e-3}), ("dop853", {"tolerance": 1e-9}), ("radau", {}), ("rk4", {"step": 0.01})]
    + [(method, {"step": 0.01}) for method in ("rattle", "symplectic", "generalized_alpha")],
)
@pytest.mark.parametrize(("stiffness", "when"), [(0.0, "(0.99|1)"), (3.0, "1.8")])
def test_centres_that_meet_end_the_motion(method: str, options: dict, stiffness: float, when: str) -> None:
    """Nothing holds the centres apart, and their line keeps its direction: they run into each other."""
    m = loose_gears(stiffness)
    with pytest.raises(SimulationError, match=f"loose: the centres of gear_pair 'mesh' meet at t = {when}"):
        m.simulate(2.0, method=method, **options)
