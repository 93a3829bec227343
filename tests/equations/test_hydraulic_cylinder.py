"""Hydraulic cylinders: natural frequency of the oil column, steady motion, power of the supply, loads held, ends, oil
that tears, and what is refused."""

from __future__ import annotations

import math
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, Solution, constant_rate
from mbsd.base.errors import ModelWarning
from mbsd.model.oil_cylinder import LEAST, OilCylinder
from mbsd.results.fluids import HydraulicView

BORE, ROD, STROKE, RETRACTED, SUPPLY = 0.1, 0.06, 1.0, 0.6, 20e6
FLOW, BULK = 1e-3, 1.4e9
A, B = math.pi * BORE**2 / 4, math.pi * (BORE**2 - ROD**2) / 4
AIR = 101325.0


def press(mass: float = 1000.0, place: float = 1.0, **more: Any) -> Mechanism:
    """A carriage on a cylinder from the origin."""
    m = Mechanism("press", gravity=None)
    carriage = m.body("carriage", mass, inertia=1.0)
    m.prismatic("rail", m.ground.origin, carriage.origin)
    known = {"rated_flow": FLOW} if "orifice" not in more else {}
    m.hydraulic_cylinder("ram", m.ground.origin, carriage.origin, BORE, ROD, STROKE, RETRACTED, SUPPLY, **known | more)
    m.start_near(carriage=(place, 0.0, 0.0))
    return m


def boom(**more: Any) -> Mechanism:
    """A boom on one cylinder with a stick on another; valves are closed if nothing else is said."""
    m = Mechanism("boom")
    arm, stick = m.bar("arm", 3.0, mass=400.0), m.bar("stick", 2.0, mass=300.0)
    m.revolute("foot", m.ground.origin, arm.start)
    m.revolute("elbow", arm.end, stick.start)
    known = {"stroke": 1.2, "supply": 25e6, "rated_flow": 1e-3, "bore": 0.12, "rod": 0.08} | more
    m.hydraulic_cylinder("lift", m.ground.at(0.6, -0.8), arm.at(1.5, -0.1), retracted=1.0, **known)
    m.hydraulic_cylinder("crowd", arm.at(1.6, 0.4), stick.at(-0.4, 0.2), retracted=0.7, **known)
    m.start_near(arm=30.0, stick=-50.0)
    return m


def oil_of(m: Mechanism, name: str = "ram") -> OilCylinder:
    of = m.forces[name].kind.oil
    assert of is not None
    return of(m.forces[name])


def view_of(sol: Solution, name: str = "ram") -> HydraulicView:
    view = sol.force(name)
    assert isinstance(view, HydraulicView)
    return view


def own_frequency(m: Mechanism, mass: float, place: float) -> float:
    """sqrt(E (A_a^2 / V_a + A_b^2 / V_b) / m)  (rad/s)"""
    volume_a, volume_b = oil_of(m).volumes(place)
    return math.sqrt(BULK * (A**2 / volume_a + B**2 / volume_b) / mass)


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("place", [0.7, 1.0, 1.5])
def test_a_mass_on_a_locked_cylinder_swings_at_the_frequency_of_its_oil(method: str, place: float) -> None:
    m = press(place=place, air=0.0, pressure_a=8e6, pressure_b=(8e6 * A - AIR * (A - B)) / B)
    m.start_moving(carriage=(1e-4, 0.0, 0.0))
    omega = own_frequency(m, 1000.0, place)
    end = 6.5 * math.pi / omega
    sol = m.simulate(end, steps=2000, method=method, tolerance=1e-9)
    v = sol.body("carriage").vx
    k = np.flatnonzero(np.diff(np.sign(v)))
    zeros = sol.t[k] - v[k] * (sol.t[k + 1] - sol.t[k]) / (v[k + 1] - v[k])
    assert math.pi / np.diff(zeros).mean() == pytest.approx(omega, rel=1e-6)


def test_linearised_a_locked_cylinder_has_the_frequency_of_its_oil() -> None:
    m = press(place=1.2, air=0.0)
    linear = m.linearise("start")
    assert linear.states == ("ram.pressure_a", "ram.pressure_b")
    assert linear.modes[-1].omega == pytest.approx(own_frequency(m, 1000.0, 1.2), rel=1e-9)
    assert linear.modes[-1].damping_ratio == pytest.approx(0.0, abs=1e-9)


def test_linearised_at_a_moment_of_a_motion_the_pressures_are_those_of_that_moment() -> None:
    m = press(valve=0.4, leak=1e-11)
    sol = m.simulate(0.4, steps=40)
    omega = m.linearise(sol, t=0.4).modes[-1].omega
    fresh = press(valve=0.4, leak=1e-11, place=float(sol.body("carriage").x[-1]))
    fresh.change("ram", pressure_a=float(view_of(sol).pressure_a[-1]), pressure_b=float(view_of(sol).pressure_b[-1]))
    fresh.start_moving(carriage=(float(sol.body("carriage").vx[-1]), 0.0, 0.0))
    assert omega == pytest.approx(fresh.linearise("start").modes[-1].omega, rel=1e-6)


@pytest.mark.parametrize("opening", [0.3, -0.6])
@pytest.mark.parametrize("load", [-4e4, 0.0, 2e4])
def test_steady_motion_is_the_closed_form_of_two_orifices(opening: float, load: float) -> None:
    m = press(valve=opening, air=0.0, transition=1.0, place=0.8 if opening > 0 else 1.5, leak=0.0, mass=50.0)
    m.force("load", m.bodies["carriage"].origin, load, direction=0.0)
    way = FLOW / math.sqrt(3.5e6) * abs(opening)
    atmosphere = AIR * (A - B)
    if opening > 0:
        push = SUPPLY * A - AIR * B - atmosphere + load
    else:
        push = SUPPLY * B - AIR * A + atmosphere - load
    speed = math.copysign(way * math.sqrt(push / (A**3 + B**3)), opening)
    m.start_moving(carriage=(speed, 0.0, 0.0))
    sol = m.simulate(1.0, method="radau", tolerance=1e-9)
    assert sol.body("carriage").vx == pytest.approx(speed, rel=1e-7)
    view = view_of(sol)
    assert view.flow_a == pytest.approx(A * speed, rel=1e-6)
    assert view.flow_b == pytest.approx(-B * speed, rel=1e-6)
    drop = (A * speed / way) ** 2
    expected = SUPPLY - drop if opening > 0 else AIR + drop
    assert view.pressure_a == pytest.approx(expected, rel=1e-6)


def test_the_rated_flow_and_the_orifice_say_the_same() -> None:
    rated = oil_of(press(transition=1e3))
    assert rated.conductance * rated.orifice(np.array(3.5e6)) == pytest.approx(FLOW, rel=1e-14)
    area = rated.conductance * math.sqrt(860.0 / 2.0)
    assert oil_of(press(orifice=area)).conductance == pytest.approx(rated.conductance, rel=1e-14)


def test_the_power_of_the_supply_is_all_accounted_for() -> None:
    m = press(valve=lambda t: 0.5 * math.sin(6.0 * t), leak=2e-12, friction=300.0, slip_speed=1e-2, place=1.0)
    sol = m.simulate(1.0, steps=2000, tolerance=1e-9)
    view = view_of(sol)
    left = view.supply_power - view.valve_loss - view.leak_loss - view.oil_power - view.piston_power
    assert np.abs(left).max() < 1e-12 * np.abs(view.supply_power).max()
    assert (view.valve_loss >= 0.0).all()
    assert (view.leak_loss >= 0.0).all()
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-7 * np.abs(sol.energy.kinetic).max() + 1e-6
    # what goes into compressing the oil is what its pressures tell
    stored = 0.0
    for pressure, volume in ((view.pressure_a, view.volume_a), (view.pressure_b, view.volume_b)):
        bulk = oil_of(m).bulk(pressure, np.ones_like(pressure))
        stored += np.trapezoid(volume * pressure * np.gradient(pressure, sol.t) / bulk, sol.t)
    assert np.trapezoid(view.oil_power, sol.t) == pytest.approx(stored, rel=2e-3)


def test_a_boom_is_held_where_it_stands_by_closed_valves() -> None:
    m = boom()
    sol = m.simulate(2.0, steps=50)
    assert np.ptp(sol.body("arm").theta) < 1e-9
    assert np.ptp(sol.body("stick").theta) < 1e-9
    lift = view_of(sol, "lift")
    assert lift.pressure_a[0] > 1e6
    assert lift.pressure_b[0] == pytest.approx(AIR)
    rigid = boom()
    for name in ("lift", "crowd"):
        force = rigid.forces.pop(name)
        rigid.drive_distance(name, force.i, force.j, constant_rate(0.0, float(view_of(sol, name).length[0])))
    held = rigid.sweep(times=[0.0])
    for name in ("lift", "crowd"):
        assert np.array(view_of(sol, name).effort)[0] == pytest.approx(held.driver(name).effort[0], rel=1e-8)


def test_a_piston_meets_its_ends_and_stays_there() -> None:
    sol = press(mass=2000.0, valve=1.0, place=1.5).simulate(1.0, steps=200)
    view = view_of(sol)
    assert sol.body("carriage").x[-1] == pytest.approx(RETRACTED + STROKE, abs=1.2e-3 * STROKE)
    assert sol.body("carriage").x.max() < RETRACTED + 1.02 * STROKE
    assert view.pressure_a[-1] == pytest.approx(SUPPLY, rel=1e-3)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-6 * sol.energy.total.max()


def test_oil_without_air_may_not_be_pulled_and_with_air_it_is_told() -> None:
    with pytest.raises(ModelError, match=r"press: force 'ram': at t = .* s the pressure in chamber A is −.*air=0\.005"):
        press(mass=2000.0, valve=0.5, air=0.0).simulate(0.5)
    pulled = press(place=0.8)
    pulled.force("pull", pulled.bodies["carriage"].origin, 1.2e5, direction=0.0)
    with pytest.warns(ModelWarning, match=r"chamber A is .*Pa: the oil cavitates"):
        sol = _from(pulled, 1.0e6).simulate(0.05, steps=100)
    assert (view_of(sol).pressure_a > 0.0).all()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        press(mass=2000.0, valve=0.5).simulate(0.5)


def _from(m: Mechanism, pressure: float) -> Mechanism:
    m.change("ram", pressure_a=pressure, pressure_b=pressure)
    return m


def test_results_are_columns_with_units() -> None:
    columns = press(valve=0.4).simulate(0.1, steps=4).columns()
    assert {
        "ram.pressure_a [Pa]",
        "ram.pressure_b [Pa]",
        "ram.flow_a [m^3/s]",
        "ram.supply_power [W]",
    } <= columns.keys()


@given(
    opening=st.sampled_from([-1.0, -0.2, 0.1, 1.0]), rate=st.floats(-0.02, 0.02),
    leak=st.sampled_from([0.0, 1e-12, 1e-9]),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_a_motion_begins_with_pressures_of_a_steady_flow(opening: float, rate: float, leak: float) -> None:
    oil = oil_of(press(leak=leak))
    a, b = (np.array([value]) for value in oil.steady(opening, rate, 0.0))
    flows = oil.flows(np.array([opening]), a, b)
    left = np.concatenate(oil.compressing(flows, np.array([rate])))
    if min(a[0], b[0]) > LEAST:  # else oil that tears would have to follow
        assert np.abs(left).max() < 1e-9 * FLOW + 1e-9 * leak * SUPPLY


@given(root=st.floats(-1e5, 1e5), transition=st.floats(1.0, 1e6))
@settings(max_examples=60, deadline=None)
def test_the_pressure_drop_of_a_flow_gives_this_flow(root: float, transition: float) -> None:
    oil = oil_of(press(transition=transition))
    assert float(oil.orifice(np.array(oil.drop(root)))) == pytest.approx(root, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"bore": -0.1}, "bore is -0.1; it must be positive"),
        ({"rod": 0.1}, "rod is 0.1 m, but the bore only 0.1 m"),
        ({"bore": math.nan}, "bore is nan"),
        ({"stroke": 0.0}, "stroke is 0"),
        ({"stroke": 0.3}, r"1 m apart at the start; with a stroke of 0.3 m they are 0.6 .. 0.9 m apart"),
        ({"valve": 1.4}, r"valve is 1.4; its opening is -1 .. 1"),
        ({"supply": 200.0}, r"in pascals \(200 bar are 2e7\); make the supply's the higher one"),
        ({"orifice": 1e-4}, "a rated_flow and an orifice"),
        ({"rated_flow": None}, "neither rated_flow nor orifice"),
        ({"air": 1.0}, "air is 1; it is a part of the volume"),
        ({"leak": -1e-12}, "leak is -1e-12; it cannot be negative"),
        ({"pressure_a": 0.0}, "pressure_a is 0; it must be positive"),
        ({"bulk_modulus": math.inf}, "bulk_modulus is inf"),
    ],
)
def test_invalid_cylinders_are_refused(more: dict[str, Any], said: str) -> None:
    m = Mechanism("press", gravity=None)
    carriage = m.body("carriage", 10.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, carriage.origin)
    known = {"bore": BORE, "rod": ROD, "stroke": STROKE, "retracted": RETRACTED, "supply": SUPPLY, "rated_flow": FLOW}
    m.start_near(carriage=(1.0, 0.0, 0.0))
    with pytest.raises(ModelError, match=f"press: .*'ram': .*{said}"):
        m.hydraulic_cylinder("ram", m.ground.origin, carriage.origin, **known | more)
        m.simulate(0.01)


def test_a_driver_that_pushes_a_piston_through_its_end_is_refused() -> None:
    m = press(place=1.5, valve=0.2)
    m.drive_coordinate("push", m.ground.origin, m.bodies["carriage"].origin, constant_rate(1.0, 1.5))
    with pytest.raises(ModelError, match=r"press: force 'ram': at t = .* s its points are .* chamber B has no volume"):
        m.sweep(0.5)


def test_millimetres_and_litres_a_minute_are_told() -> None:
    m = Mechanism("press", gravity=None)
    carriage = m.body("carriage", 10.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, carriage.origin)
    m.hydraulic_cylinder("ram", m.ground.origin, carriage.origin, 100.0, 60.0, 1.0, 0.6, SUPPLY, rated_flow=60.0)
    assert [finding.problem[:14] for finding in m.check()] == ["its bore is 10"]
    m.change("ram", bore=0.1, rod=0.06)
    assert [finding.problem[:26] for finding in m.check()] == ["its valve lets 60 m^3/s th"]
    m.change("ram", rated_flow=60 / 60000)
    assert not m.check()


def test_analyses_of_poses_alone_refuse_pressures() -> None:
    with pytest.raises(ModelError, match=r"force 'ram' .* carries pressure_a and pressure_b"):
        press().equilibrium()
