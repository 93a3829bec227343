"""Results in space: continuous quaternions, counted turns, balance of powers, wrenches of all joints, derivatives."""

from __future__ import annotations

import math

import numpy as np
import pytest

import mbsd.mechanism  # noqa: F401  planar names for checks of arguments do not reach into space
from mbsd.base.errors import ModelError
from mbsd.spatial import Mechanism, constant_rate, harmonic
from tests.spatial import machines

MACHINES = [machines.slider_crank, machines.four_link, machines.bennett, lambda: machines.hooke_joint(0.5)]


@pytest.mark.parametrize("build", MACHINES)
def test_efforts_times_rates_balance_the_power_of_inertia_and_weight(build) -> None:
    sol = build().sweep(duration=1.0, steps=2000)
    supplied = np.sum([sol.driver(name).power for name in sol.mechanism.drivers], axis=0)
    energy = sol.energy.total
    change = np.gradient(energy, sol.t, edge_order=2)[5:-5]
    assert np.allclose(supplied[5:-5], change, rtol=0, atol=2e-4 * max(np.abs(change).max(), 1.0))
    assert sol.stats.power_residual < 1e-9 * max(np.abs(supplied).max(), 1.0)
    assert sol.stats.position_residual < 1e-12
    assert sol.stats.velocity_residual < 1e-10
    assert sol.stats.acceleration_residual < 1e-8


@pytest.mark.parametrize("build", MACHINES)
def test_rates_are_derivatives_of_places_and_orientations(build) -> None:
    sol = build().sweep(duration=0.4, steps=4000)
    h = sol.t[1] - sol.t[0]
    for name in list(sol.mechanism.bodies)[1:]:
        body = sol.body(name)
        for value, rate in ((body.place, body.velocity), (body.velocity, body.acceleration), (body.w, body.alpha)):
            slope = (value[2:] - value[:-2]) / (2 * h)
            assert np.allclose(slope, rate[1:-1], rtol=0, atol=1e-4 * max(1.0, np.abs(rate).max()))
        assert np.linalg.norm(np.diff(body.orientation, axis=0), axis=1).max() < 0.1


def test_forces_on_a_body_are_its_mass_times_its_acceleration() -> None:
    sol = machines.slider_crank().sweep(duration=1.0, steps=100)
    rod = sol.mechanism.bodies["rod"]
    centre = sol.place(rod.marker(rod.com))
    ball, cross = sol.joint("ball"), sol.joint("cross")
    force = ball.force + cross.force + 0.5 * np.array(sol.mechanism.gravity)
    assert np.allclose(force, 0.5 * centre.acceleration, rtol=0, atol=1e-10)


def test_signs_of_quaternions_are_continuous_and_turns_are_counted() -> None:
    m = Mechanism("spindle")
    wheel = m.disc("wheel", (0, 0, 0), (1, 1, 1), radius=0.1, mass=1.0)
    m.revolute("bearing", m.ground, wheel, at=(0, 0, 0), axis=(1, 1, 1))
    m.drive_turn("motor", "bearing", constant_rate(-5.0))
    sol = m.sweep(duration=10.0, steps=30)  # 50 rad: a step is 1.7 rad
    assert np.allclose(sol.joint("bearing").turn, -5.0 * sol.t, rtol=0, atol=1e-11)
    assert sol.inserted_steps > 200
    fine = m.sweep(duration=10.0, steps=3000).body("wheel").orientation
    assert np.linalg.norm(np.diff(fine, axis=0), axis=1).max() < 0.02
    assert fine[:, 0].min() < -0.5


def test_reactions_of_redundant_joints_share_evenly() -> None:
    m = Mechanism("door", gravity=(0, 0, -9.81))
    leaf = m.body("leaf", 30.0, com=(0.4, 0, 0), inertia=(1.0, 2.0, 2.0))
    for name, z in (("upper", 0.8), ("lower", -0.8)):
        m.revolute(name, m.ground, leaf, at=(0, 0, z), axis=(0, 0, 1))
    m.drive_turn("hand", "upper", harmonic(0.5, 1.0))
    sol = m.sweep(steps=20)
    assert sol.mobility.redundant_rows == 5
    upper, lower = sol.joint("upper"), sol.joint("lower")
    assert np.allclose(upper.force[:, 2], lower.force[:, 2], rtol=1e-9)
    assert np.allclose(upper.force[:, 2] + lower.force[:, 2], 30 * 9.81, rtol=1e-9)


def test_start_near_turns_joints_from_the_design_pose() -> None:
    free = Mechanism("arm")
    arm = free.rod("arm", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.01)
    free.revolute("shoulder", free.ground, arm, at=(0, 0, 0), axis=(0, 0, 1))
    slider = free.body("slider", 1.0, com=(1, 0, 0), inertia=(1, 1, 1))
    free.prismatic("rail", arm, slider, at=(1, 0, 0), axis=(1, 0, 0))
    free.drive_turn("motor", "shoulder", harmonic(0.2, 1.0, 0.0, math.pi / 2))
    free.drive_slide("jack", "rail", harmonic(0.1, 1.0, 0.0, 0.3))
    free.trace("tip", slider, at=(1, 0, 0))
    tip = free.sweep(steps=12).point("tip")
    assert tip.place[0] == pytest.approx([0.0, 1.3, 0.0], abs=1e-12)


def test_start_near_leads_to_the_other_assembly() -> None:
    """A rod of fixed length between two arms has two assemblies; start_near leads to the other."""
    first, other = (_arms(start) for start in (None, 150.0))
    assert first.joint("right").turn[0] == pytest.approx(0.0, abs=1e-12)
    assert math.degrees(other.joint("right").turn[0]) == pytest.approx(180.0, abs=1e-9)


def _arms(start: float | None):
    m = Mechanism("two arms")
    left = m.rod("left", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.01)
    right = m.rod("right", (2, 0, 0), (2, 1, 0), mass=1.0, radius=0.01)
    m.revolute("left", m.ground, left, at=(0, 0, 0), axis=(0, 0, 1))
    m.revolute("right", m.ground, right, at=(2, 0, 0), axis=(0, 0, 1))
    m.distance("rod", left, right, start=(1, 0, 0), end=(2, 1, 0))
    m.drive_turn("motor", "left", harmonic(0.1, 1.0, -math.pi / 2, 0.1))
    if start is not None:
        m.start_near({"right": start})
    return m.sweep(steps=10)


def test_unknown_names_of_results_are_refused() -> None:
    sol = machines.slider_crank().sweep(steps=4)
    for call in (sol.body, sol.joint, sol.driver, sol.point):
        with pytest.raises(ModelError, match=r"there is no (body|joint|driver|traced point)"):
            call("bearin")
    with pytest.raises(ModelError, match="has no turn"):
        _ = sol.joint("rail").turn
