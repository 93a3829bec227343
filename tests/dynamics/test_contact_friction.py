"""Rigid contacts with friction, sticking, sliding and rolling, and bodies on several feet, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, harmonic
from tools.models.contact_models import G, balance, ball, box, disc, times_of


def incline(angle: float, friction: float, up: float = 0.0) -> Mechanism:
    m = Mechanism("incline", gravity=(0.0, -G))
    block = m.body("block", 2.0, inertia=1.0)
    m.rigid_contact("slope", m.ground.at(0, 0, angle), block.origin, friction=friction)
    m.start_near(block=(0, 0, 0))
    m.start_moving(block=(up * math.cos(angle), up * math.sin(angle), 0))
    return m


@pytest.mark.parametrize("over", [0.99, 1.01])
def test_a_block_holds_up_to_the_angle_of_friction(over: float) -> None:
    angle, friction = math.atan(0.4 * over), 0.4
    sol = incline(angle, friction).simulate(1.0)
    a = max(0.0, G * (math.sin(angle) - friction * math.cos(angle)))
    along = sol.body("block").x * math.cos(angle) + sol.body("block").y * math.sin(angle)
    np.testing.assert_allclose(along, -0.5 * a * sol.t**2, atol=1e-11)
    slope = sol.contact("slope")
    np.testing.assert_allclose(slope.normal, 2 * G * math.cos(angle), rtol=1e-12)
    held = 2 * G * math.sin(angle) if over < 1 else 2 * G * friction * math.cos(angle)
    np.testing.assert_allclose(slope.friction, held, rtol=1e-12)
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-9)


@pytest.mark.parametrize("friction", [0.3, 0.7])
def test_a_block_pushed_uphill_stops_and_stays_or_comes_back(friction: float) -> None:
    angle, up = math.radians(30), 4.0
    sol = incline(angle, friction, up).simulate(2.0, tolerance=1e-9)
    slow = G * (math.sin(angle) + friction * math.cos(angle))
    back = max(0.0, G * (math.sin(angle) - friction * math.cos(angle)))
    stop = up / slow
    assert times_of(sol, "slope", "sticks")[:1] == ([pytest.approx(stop, abs=1e-10)] if friction == 0.7 else [])
    along = sol.body("block").x * math.cos(angle) + sol.body("block").y * math.sin(angle)
    top = up**2 / (2 * slow)
    assert along[-1] == pytest.approx(top - 0.5 * back * (2.0 - stop) ** 2, abs=1e-9)
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-8)


@pytest.mark.parametrize("of_a_joint", [False, True])
def test_how_far_a_block_has_slid_is_no_residual_of_a_joint(of_a_joint: bool) -> None:
    """Sticking holds a speed of zero and no position; see Stats."""
    m = Mechanism("shoved")
    block = m.body("block", 2.0, inertia=1.0)
    if of_a_joint:
        m.prismatic("floor", m.ground.at(0, 0), block.origin)
        m.friction("rub", "floor", 0.4, sticks=True)
    else:
        m.rigid_contact("floor", m.ground.at(0, 0), block.origin, friction=0.4)
    m.start_near(block=(0, 0, 0))
    m.force("shove", block.origin, harmonic(7.0, 2 * math.pi, -math.pi / 2, 7.0))  # 0 .. 14 N once a second
    sol = m.simulate(2.0)
    assert sol.body("block").x[-1] > 0.1
    assert {event.what for event in sol.events} >= {"sticks", "slides"}
    assert sol.stats.position_residual < 1e-12
    assert sol.stats.velocity_residual < 1e-9


def test_a_sliding_disc_ends_up_rolling() -> None:
    m = disc(0.25)
    m.start_moving(wheel=(3.0, 0.0, 0.0))
    sol = m.simulate(1.0)
    rolls = 3.0 / (3 * 0.25 * G)
    assert times_of(sol, "road", "sticks") == [pytest.approx(rolls, abs=1e-10)]
    after = sol.t > rolls
    np.testing.assert_allclose(sol.body("wheel").vx[after], 2.0, atol=1e-10)
    np.testing.assert_allclose(sol.body("wheel").omega[after], -10.0, atol=1e-9)
    assert sol.energy.kinetic[-1] == pytest.approx(13.5 * 2 / 3, rel=1e-10)
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-9)


@pytest.mark.parametrize("friction", [0.15, 0.25])
def test_a_disc_rolls_downhill_where_friction_is_a_third_of_the_slope(friction: float) -> None:
    slope = math.atan(0.6)
    sol = disc(friction, slope).simulate(1.0)
    rolling = friction > 0.2
    a = G * (2 / 3 * math.sin(slope) if rolling else math.sin(slope) - friction * math.cos(slope))
    spin = a / 0.2 if rolling else 2 * friction * G * math.cos(slope) / 0.2
    wheel = sol.body("wheel")
    assert math.hypot(wheel.vx[-1], wheel.vy[-1]) == pytest.approx(a, rel=1e-10)
    assert wheel.omega[-1] == pytest.approx(spin, rel=1e-10)


def test_a_spinning_ball_bounces_off_with_the_impulse_of_friction() -> None:
    m = ball(0.7)
    m.contacts["floor"].params["friction"] = m.contacts["floor"].params["static_friction"] = 0.2  # type: ignore[index]
    m.start_moving(ball=(0.0, 0.0, 50.0))
    sol = m.simulate(0.6)
    impulse = 2.0 * math.sqrt(2 * G) * 1.7
    assert sol.events[0].impulse == pytest.approx(impulse, rel=1e-10)
    assert sol.body("ball").vx[-1] == pytest.approx(-0.2 * impulse / 2.0, rel=1e-10), "it slides all the time"
    assert sol.body("ball").omega[-1] == pytest.approx(50.0 - 0.2 * impulse * 0.1 / 0.1, rel=1e-10)


def test_dry_friction_takes_the_same_from_each_swing() -> None:
    m = Mechanism("oscillator", gravity=(0.0, -10.0))
    block = m.body("block", 1.0, inertia=1.0)
    m.rigid_contact("table", m.ground.origin, block.origin, friction=0.1)
    m.spring("spring", m.ground.at(-5, 0), block.origin, 100.0, free_length=5.0)
    m.start_near(block=(0.095, 0, 0))
    sol = m.simulate(3.0, tolerance=1e-10)
    half, drop = math.pi / 10, 2 * 0.1 * 10 / 100
    turns = [(k + 1) * half for k in range(4)]
    for k, time in enumerate(turns):
        assert sol.at(time).body("block").x[0] == pytest.approx((-1) ** (k + 1) * (0.095 - (k + 1) * drop), abs=1e-8)
    assert times_of(sol, "table", "sticks")[-1] == pytest.approx(5 * half, abs=1e-7), "below drop / 2 it stays"
    assert sol.body("block").x[-1] == pytest.approx(0.005, abs=1e-8)
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-8)


def test_stick_slip_has_its_analytic_period() -> None:
    """A block on a belt, held by a spring; static friction above sliding friction.

    With d = (mu_s - mu_k) N / k, w^2 = k / m, belt speed u: period 2 d / u + 2 (pi - atan(d w / u)) / w.
    """
    k, mass, speed, static, kinetic = 50.0, 1.0, 0.1, 0.6, 0.4
    m = Mechanism("belt", gravity=(0.0, -10.0))
    belt, block = m.body("belt", 1.0, inertia=1.0), m.body("block", mass, inertia=1.0)
    m.prismatic("rail", m.ground.origin, belt.origin)
    m.drive_coordinate("motor", m.ground.origin, belt.origin, constant_rate(speed))
    m.rigid_contact("touch", belt.origin, block.origin, friction=kinetic, static_friction=static)
    m.spring("spring", m.ground.at(-3, 0), block.origin, k, free_length=3.0)
    m.start_moving(block=(speed, 0, 0))
    sol = m.simulate(6.0, tolerance=1e-10)
    d, w = (static - kinetic) * mass * 10 / k, math.sqrt(k / mass)
    period = 2 * d / speed + 2 / w * (math.pi - math.atan(d * w / speed))
    slips = times_of(sol, "touch", "slides")
    assert slips[0] == pytest.approx(static * mass * 10 / k / speed, abs=1e-8)
    np.testing.assert_allclose(np.diff(slips), period, atol=1e-7)
    assert len(slips) >= 3
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-7)


def test_a_box_that_falls_flat_bounces_flat() -> None:
    m = box(0.5, 0.3)
    m.start_near(box=(0, 1.25, 0))
    sol = m.simulate(1.0)
    fall = math.sqrt(2 / G)
    assert times_of(sol, "foot 0", "impact") == times_of(sol, "foot 1", "impact")
    assert times_of(sol, "foot 0", "impact") == pytest.approx([fall, 2 * fall], abs=1e-10)
    assert np.abs(sol.body("box").theta).max() < 1e-12


@pytest.mark.parametrize("points", [2, 3])
def test_a_box_stands_on_more_feet_than_it_needs(points: int) -> None:
    sol = box(0.3, 0.5, points).simulate(0.5)
    total = sum(sol.contact(f"foot {k}").normal for k in range(points))
    np.testing.assert_allclose(total, 4 * G, rtol=1e-12)
    assert np.abs(sol.body("box").vy).max() < 1e-14
    assert sol.stats.acceleration_residual < 1e-12


@pytest.mark.parametrize("push", [15.0, 25.0])
def test_a_box_with_both_feet_on_the_ground_is_pushed(push: float) -> None:
    m = box(0.0, 0.5)
    m.force("push", m.bodies["box"].at(0, -0.25), lambda t: push * t)
    sol = m.simulate(1.0, tolerance=1e-10)
    limit = 0.5 * 4 * G
    if push < limit:
        assert np.abs(sol.body("box").x).max() < 1e-12
    else:
        starts = limit / push
        assert times_of(sol, "foot 0", "slides") + times_of(sol, "foot 1", "slides") != []
        assert sol.body("box").vx[-1] == pytest.approx(push * (1 - starts) ** 2 / 2 / 4, abs=1e-8)
    np.testing.assert_allclose(sum(sol.contact(f"foot {k}").normal for k in range(2)), 4 * G, rtol=1e-9)


@pytest.mark.parametrize("turning", np.linspace(-3e-4, 3e-4, 8))
def test_a_box_whose_rocking_is_too_slow_to_count_is_at_rest_at_once(turning: float) -> None:
    """One foot stands, the other goes up slower than what ends the bouncing, and no foot slides."""
    m = box(0.4, 0.355)
    m.start_moving(box=(-0.25 * turning, 0.5 * abs(turning), turning))
    sol = m.simulate(0.05, steps=2)
    assert [(event.time, event.what) for event in sol.events] == [(0.0, "closes")] * 2
    np.testing.assert_allclose(sol.v, 0.0, atol=1e-15)
    np.testing.assert_allclose(sol.q[-1], sol.q[0], atol=1e-15)


def test_a_box_tips_when_it_is_pushed_high() -> None:
    """It tips about its foot as soon as push x height exceeds weight x half the width."""
    m = box(0.0, 2.0)
    m.force("push", m.bodies["box"].at(0, 0.25), lambda t: 100.0 * t)
    sol = m.simulate(0.5, tolerance=1e-9)
    assert times_of(sol, "foot 0", "opens") == [pytest.approx(4 * G * 0.5 / 0.5 / 100.0, abs=1e-8)]
    assert sol.body("box").theta[-1] < -1e-3
    assert np.abs(sol.contact("foot 1").gap).max() < 1e-12
