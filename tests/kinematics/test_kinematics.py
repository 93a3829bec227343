"""Positions, velocities, accelerations against closed form; the branch is kept at any step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate, cycloidal, function, harmonic
from tools.models import four_bars


@settings(max_examples=40)
@given(lengths=four_bars.crank_rockers(), steps=st.integers(5, 200))
def test_any_number_of_steps_stays_on_the_branch(lengths: tuple[float, float, float, float], steps: int) -> None:
    sol = four_bars.model(lengths).sweep(steps=steps)
    assert len(sol.t) == steps + 1
    assert sol.stats.inserted_steps > 0 or steps >= 30
    fine = np.linspace(0, 2 * math.pi, 20 * steps + 1)
    coupler, rocker = four_bars.angles(lengths, fine)
    np.testing.assert_allclose(sol.body("coupler").theta, coupler[::20], atol=1e-9)
    np.testing.assert_allclose(sol.body("rocker").theta, rocker[::20], atol=1e-9)


def test_one_turn_closes_and_is_periodic() -> None:
    sol = four_bars.model((0.12, 0.04, 0.12, 0.09), 2 * math.pi).sweep()
    assert sol.period == pytest.approx(1.0)
    assert four_bars.model((0.12, 0.04, 0.12, 0.09), 2 * math.pi).sweep(duration=0.7).period is None


def test_a_law_that_jumps_is_told_with_its_time() -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0))
    m.drivers.clear()
    m.drive_angle("motor", m.bodies["crank"], function(lambda t: 0.0 if t < 0.5 else 2.5, lambda t: 0.0, lambda t: 0.0))
    with pytest.raises(ModelError, match=r"driver 'motor': function: the law jumps by 2\.5 at t = 0\.5 s"):
        m.sweep(duration=1.0, steps=20)


def test_actuators_impose_distance_coordinate_and_relative_angle() -> None:
    m = Mechanism("jack")
    arm = m.bar("arm", 1.0, 2.0)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_distance("ram", m.ground.at(0.8, -0.2), arm.at(0.6, 0.0), harmonic(0.1, 2.0, 0.0, 0.6))
    m.start_near(arm=40)
    sol = m.sweep()
    tip = np.stack([0.6 * np.cos(sol.body("arm").theta), 0.6 * np.sin(sol.body("arm").theta)], axis=1)
    np.testing.assert_allclose(np.hypot(*(tip - [0.8, -0.2]).T), 0.6 + 0.1 * np.sin(2 * sol.t), atol=1e-12)
    assert sol.driver("ram").force.shape == sol.t.shape

    m = Mechanism("slide")
    block = m.body("block", 3.0)
    m.prismatic("guide", m.ground.at(0.1, 0.2, 0.5), block.at(0, 0, 0.0))
    m.drive_coordinate("push", m.ground.at(0.1, 0.2, 0.5), block.origin, cycloidal(0.4, 1.0))
    sol = m.sweep(duration=1.2)
    view, want = sol.body("block"), cycloidal(0.4, 1.0)(sol.t)[:, 0]
    np.testing.assert_allclose(view.x, 0.1 + want * math.cos(0.5), atol=1e-13)
    np.testing.assert_allclose(view.theta, 0.5, atol=1e-13)
    push = 3.0 * cycloidal(0.4, 1.0)(sol.t)[:, 2] + 3.0 * 9.80665 * math.sin(0.5)
    np.testing.assert_allclose(sol.driver("push").force, push, atol=1e-10)

    m = Mechanism("elbow")
    upper, lower = m.bar("upper", 1.0, 1.0), m.bar("lower", 0.5, 1.0)
    m.revolute("shoulder", m.ground.origin, upper.start)
    m.revolute("elbow", upper.end, lower.start)
    m.drive_angle("first", upper, constant_rate(1.0))
    m.drive_relative_angle("second", upper, lower, harmonic(0.5, 3.0))
    sol = m.sweep(duration=2.0)
    bent = sol.body("lower").theta - sol.body("upper").theta
    np.testing.assert_allclose(bent, 0.5 * np.sin(3 * sol.t), atol=1e-12)


def test_welds_and_rods_carry_on_like_the_bodies_they_replace() -> None:
    """A coupler made of two welded halves, and one made of a massless rod, move the rocker as the whole one does."""
    lengths = (4.0, 1.0, 3.5, 3.0)
    _, rocker = four_bars.angles(lengths, np.linspace(0, 2 * math.pi, 361))
    halves = Mechanism("halves")
    bars = {n: halves.bar(n, v) for n, v in (("crank", 1.0), ("first", 1.5), ("second", 2.0), ("rocker", 3.0))}
    halves.revolute("A", halves.ground.origin, bars["crank"].start)
    halves.revolute("B", bars["crank"].end, bars["first"].start)
    halves.weld("W", bars["first"].end, bars["second"].start)
    halves.revolute("C", bars["second"].end, bars["rocker"].end)
    halves.revolute("D", halves.ground.at(4, 0), bars["rocker"].start)
    halves.drive_angle("motor", bars["crank"], constant_rate(1.0))
    halves.start_near(first=50, rocker=110)
    rod = Mechanism("rod")
    crank, swing = rod.bar("crank", 1.0), rod.bar("rocker", 3.0)
    rod.revolute("A", rod.ground.origin, crank.start)
    rod.revolute("D", rod.ground.at(4, 0), swing.start)
    rod.distance("coupler", crank.end, swing.end, 3.5)
    rod.drive_angle("motor", crank, constant_rate(1.0))
    rod.start_near(rocker=110)
    for m in (halves, rod):
        np.testing.assert_allclose(m.sweep().body("rocker").theta, rocker, atol=1e-11)
