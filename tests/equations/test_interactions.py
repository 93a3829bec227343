"""Contact, tyre, drag and the turning frame against their closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from mbsd import Mechanism, ModelError, constant_rate, curve, polynomial

# -- contact ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("exponent", "damping"), [(1.5, 0.2), (1.0, 0.05), (2.2, 1.5)])
def test_an_impact_returns_with_the_speed_of_hunt_and_crossley(exponent: float, damping: float) -> None:
    m = Mechanism("impact", gravity=None)
    ball = m.body("ball", 0.5, inertia=1.0)
    m.contact("ground", m.ground.at(0, 0), ball.origin, 1e5, exponent=exponent, damping=damping, radius=0.1)
    m.start_near(ball=(0.0, 0.12, 0.0))
    m.start_moving(ball=(0.3, -2.0, 0.0))
    sol = m.simulate(0.2, steps=4000, tolerance=1e-10)

    def gone(speed: float) -> float:
        return speed / damping - math.log(1 + damping * speed) / damping**2

    back = brentq(lambda v: gone(-v) - gone(2.0), 1e-3, min(2.0, 0.999 / damping))
    assert sol.body("ball").vy[-1] == pytest.approx(back, rel=1e-6)
    deepest = (gone(2.0) * (exponent + 1) * 0.5 / 1e5) ** (1 / (exponent + 1))
    assert 0.1 - sol.body("ball").y.min() == pytest.approx(deepest, rel=1e-3)
    np.testing.assert_allclose(sol.body("ball").vx, 0.3, atol=1e-12)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-8


def test_a_sliding_disc_begins_to_roll_at_two_thirds_of_its_speed() -> None:
    g, radius = 9.80665, 0.1
    m = Mechanism("bowling")
    disc = m.body("disc", 2.0, inertia=0.5 * 2.0 * radius**2)
    m.contact("lane", m.ground.at(0, 0), disc.origin, 2e5, exponent=1.0, damping=1.0, friction=0.2, radius=radius)
    m.start_near(disc=(0.0, radius - 2.0 * g / 2e5, 0.0))
    m.start_moving(disc=(3.0, 0.0, 0.0))
    rolls = 3.0 / (3 * 0.2 * g)
    view = m.simulate(1.5 * rolls, steps=300, tolerance=1e-8).body("disc")
    t = np.linspace(0.0, 1.5 * rolls, 301)
    np.testing.assert_allclose(view.vx, np.maximum(3.0 - 0.2 * g * t, 2.0), atol=3e-3)
    np.testing.assert_allclose(view.omega[-1] * radius, -2.0, rtol=2e-3)


def _ramp(straight: bool) -> Mechanism:
    m = Mechanism("ramp")
    disc = m.body("disc", 2.0, inertia=0.01)
    rise = math.tan(0.3)
    if straight:
        m.contact("ramp", m.ground.at(0.2, 0.1, 0.3), disc.origin, 1e5, damping=0.5, friction=0.5, radius=0.1)
    else:
        line = curve([-3.0, -1.0, 2.0], [-3.0 * rise, -rise, 2.0 * rise])
        at = m.ground.at(0.2, 0.1)
        m.contact("ramp", at, disc.origin, 1e5, damping=0.5, friction=0.5, radius=0.1, profile=line)
    m.start_near(disc=(0.3, 0.3, 0.0))
    return m


def test_a_straight_profile_is_a_line() -> None:
    line, profile = _ramp(True).simulate(0.4, tolerance=1e-9), _ramp(False).simulate(0.4, tolerance=1e-9)
    assert line.body("disc").omega[-1] > 1.0
    np.testing.assert_allclose(profile.q, line.q, atol=1e-5)


def test_a_point_on_a_parabola_keeps_its_energy_and_swings_in_its_period() -> None:
    x = np.linspace(-1.0, 1.0, 21)
    m = Mechanism("bowl", gravity=(0.0, -10.0))
    bead = m.body("bead", 1.0, inertia=1.0)
    m.contact("bowl", m.ground.at(0, 0), bead.origin, 1e6, exponent=1.0, profile=curve(x, x**2 / 2, "spline"))
    m.start_near(bead=(0.02, 0.0002 - 1e-5, 0.0))
    sol = m.simulate(2 * math.pi / math.sqrt(10.0), tolerance=1e-9)
    assert sol.body("bead").x[-1] == pytest.approx(0.02, rel=1e-3)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-8


# -- tyre -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("slip", [-0.6, -0.05, 0.0, 0.02, 0.11, 0.8])
def test_a_driven_wheel_pulls_by_the_magic_formula(slip: float) -> None:
    m = Mechanism("tyre", gravity=None)
    wheel, car = m.body("wheel", 10.0, inertia=1.0), m.body("car", 100.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0.29), car.origin)
    m.revolute("hub", car.origin, wheel.origin)
    m.drive_coordinate("drive", m.ground.at(0, 0.29), car.origin, constant_rate(20.0))
    m.drive_angle("motor", wheel, constant_rate(-20.0 * (1 + slip) / 0.29))
    m.tyre("tyre", m.ground.at(0, 0), wheel.origin, 0.3, 2e5, grip=0.9, standstill=1e-6)
    sol = m.sweep(0.2, steps=5)
    stretched = 10.0 * slip
    bent = stretched - 0.97 * (stretched - math.atan(stretched))
    pull = 2000.0 * 0.9 * math.sin(1.65 * math.atan(bent))
    np.testing.assert_allclose(sol.driver("drive").force, -pull, atol=1e-5)
    np.testing.assert_allclose(sol.driver("motor").torque, -0.29 * pull, atol=1e-5)
    np.testing.assert_allclose(sol.joint("rail").fy, -2000.0, atol=1e-6)


def test_a_braked_wheel_stops_the_car_and_stays_finite_at_standstill() -> None:
    m = Mechanism("braking")
    wheel = m.body("wheel", 20.0, inertia=0.8)
    m.tyre("tyre", m.ground.at(0, 0), wheel.origin, 0.3, 1e5, damping=500.0)
    m.start_near(wheel=(0.0, 0.298, 0.0))
    m.start_moving(wheel=(8.0, 0.0, 0.0))
    view = m.simulate(3.0, steps=100, tolerance=1e-7).body("wheel")
    # angular momentum about the road is kept, and in the end the wheel rolls
    height = 0.3 - 20.0 * 9.80665 / 1e5
    expected = 20.0 * 8.0 * height / (20.0 * height + 0.8 / height)
    assert view.vx[-1] == pytest.approx(expected, rel=2e-3)
    assert -view.omega[-1] * height == pytest.approx(expected, rel=2e-3)


# -- drag -------------------------------------------------------------------------------------------------------


def test_a_fall_reaches_its_terminal_speed() -> None:
    m = Mechanism("fall")
    ball = m.body("ball", 2.0, (0.1, 0.0), inertia=1.0)
    m.drag("air", ball.at(*ball.com), 0.05)
    terminal = math.sqrt(2.0 * 9.80665 / 0.05)
    sol = m.simulate(6.0, tolerance=1e-10)
    np.testing.assert_allclose(-sol.body("ball").vy, terminal * np.tanh(9.80665 * sol.t / terminal), atol=1e-7)


@pytest.mark.parametrize("gust", [2.0, constant_rate(0.0, 2.0), lambda t: 2.0])
def test_wind_carries_a_body_along_and_turning_is_braked(gust) -> None:
    m = Mechanism("leaf", gravity=None)
    leaf = m.body("leaf", 2.0, inertia=0.5)
    m.drag("air", leaf.origin, 0.4, turning=0.1, wind=(1.5, -2.0), gust=gust)
    m.start_moving(leaf=(0.0, 0.0, 6.0))
    sol = m.simulate(5.0, tolerance=1e-10)
    left = 1.0 / (1.0 + 0.4 * 5.0 / 2.0 * sol.t)  # speed against the air, 5 m/s at first
    np.testing.assert_allclose(sol.body("leaf").vx, 3.0 * (1 - left), atol=1e-7)
    np.testing.assert_allclose(sol.body("leaf").vy, -4.0 * (1 - left), atol=1e-7)
    np.testing.assert_allclose(sol.body("leaf").omega, 6.0 / (1.0 + 0.2 * 6.0 * sol.t), atol=1e-7)


# -- turning frame ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rate", [2.0, polynomial(2.0, 0.7), lambda t: 2.0 + 0.7 * t])
def test_a_free_body_goes_straight_for_those_who_do_not_turn(rate) -> None:
    bend = 0.0 if rate == 2.0 else 0.7
    m = Mechanism("disc", gravity=None)
    m.body("puck", 3.0, (0.2, 0.1), inertia=0.5)
    m.rotating_frame("disc", rate, centre=(0.5, -0.3))
    m.start_near(puck=(1.0, 0.0, 0.0))
    m.start_moving(puck=(0.4, 0.1, 1.0))
    sol = m.simulate(2.0, tolerance=1e-11)
    q, v = sol.q[:, 1], sol.v[0, 1]
    start = q[0, :2] - (0.5, -0.3)
    speed = v[:2] + 2.0 * np.array([-start[1], start[0]])
    turned = 2.0 * sol.t + bend * sol.t**2 / 2
    c, s = np.cos(turned), np.sin(turned)
    inertial = start + sol.t[:, None] * speed
    np.testing.assert_allclose(q[:, 0] - 0.5, c * inertial[:, 0] + s * inertial[:, 1], atol=1e-8)
    np.testing.assert_allclose(q[:, 1] + 0.3, -s * inertial[:, 0] + c * inertial[:, 1], atol=1e-8)
    np.testing.assert_allclose(q[:, 2], 3.0 * sol.t - turned, atol=1e-9)
    if not bend:  # Jacobi's integral
        np.testing.assert_allclose(sol.energy.total, sol.energy.total[0], atol=1e-8)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-8


# -- what cannot be ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("add", "words"),
    [
        (lambda m, a: m.contact("c", m.ground.origin, a.origin, -1.0), "stiffness is -1"),
        (lambda m, a: m.contact("c", m.ground.origin, a.origin, 1.0, exponent=0.5), "must be 1 or more"),
        (lambda m, a: m.contact("c", m.ground.origin, a.origin, 1.0, slip_speed=0.0), "slip_speed is 0"),
        (lambda m, a: m.contact("c", m.ground.origin, a.origin, 1.0, profile=3), "must be a curve"),
        (lambda m, a: m.tyre("c", m.ground.origin, a.origin, 0.0, 1.0), "radius is 0"),
        (lambda m, a: m.drag("c", a.origin, 1.0, wind=3.0), "two numbers"),
        (lambda m, a: m.drag("c", a, 1.0), "at is the body .* it must be a marker"),
        (lambda m, a: m.rotating_frame("c", math.inf), "finite"),
    ],
)
def test_wrong_ones_are_refused_when_built(add, words: str) -> None:
    m = Mechanism("refused")
    a = m.body("a", 1.0)
    with pytest.raises(ModelError, match=words):
        add(m, a)
    assert not m.forces
