"""Contacts, stops, friction and events of simulations against closed forms."""

from __future__ import annotations

import importlib
import itertools
import math
import pkgutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import mbsd.integrators
from mbsd import (
    Mechanism,
    ModelError,
    SimulationError,
    angle_reaches,
    constant_rate,
    distance_reaches,
    speed_reaches,
)
from mbsd.assembly import tabulate
from mbsd.contacts.kind import CONTACT_KINDS
from mbsd.dynamics.lcp import lemke
from mbsd.integrators.kind import INTEGRATORS
from mbsd.packing import pack
from mbsd.solution import Solution

G = 9.81
for module in pkgutil.iter_modules(mbsd.integrators.__path__):
    importlib.import_module(f"mbsd.integrators.{module.name}")
METHODS = sorted(name for name in INTEGRATORS if INTEGRATORS[name].installed)


def ball(restitution: float, height: float = 1.0) -> Mechanism:
    m = Mechanism("ball", gravity=(0.0, -G))
    body = m.body("ball", 2.0, inertia=0.1)
    m.rigid_contact("floor", m.ground.at(0, 0), body.origin, radius=0.1, restitution=restitution)
    m.start_near(ball=(0, 0.1 + height, 0))
    return m


def times_of(sol: Solution, name: str, what: str) -> list[float]:
    return [one.time for one in sol.events if one.name == name and one.what == what]


def balance(sol: Solution) -> np.ndarray:
    """Energy less work less what impacts took: constant."""
    assert sol.audit is not None
    return sol.audit - sum(np.where(sol.t > one.time, one.energy, 0.0) for one in sol.events)


@pytest.mark.parametrize("restitution", [0.5, 0.8])
def test_a_bouncing_ball_keeps_to_the_geometric_series_and_comes_to_rest(restitution: float) -> None:
    fall = math.sqrt(2 / G)
    sol = ball(restitution).simulate(5.0)
    hits = times_of(sol, "floor", "impact")
    expected, time = [], fall
    for k in range(len(hits)):
        expected.append(time)
        time += 2 * fall * restitution ** (k + 1)
    np.testing.assert_allclose(hits, expected, atol=1e-10)
    assert fall * (1 + restitution) / (1 - restitution) - hits[-1] < 1e-3, "bounces to the end of the series"
    tops = [sol.at(0.5 * (a + b)).body("ball").y[0] - 0.1 for a, b in itertools.pairwise(hits[:5])]
    np.testing.assert_allclose(tops, restitution ** (2.0 * np.arange(1, 5)), atol=1e-9)
    floor = sol.contact("floor")
    assert floor.normal[-1] == pytest.approx(2 * G, rel=1e-12)
    assert floor.gap[-1] == pytest.approx(0.0, abs=1e-14)
    assert floor.gap.min() > -1e-12
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-9)


def test_an_elastic_ball_bounces_for_ever() -> None:
    sol = ball(1.0).simulate(20.0, steps=50)
    fall = math.sqrt(2 / G)
    hits = times_of(sol, "floor", "impact")
    np.testing.assert_allclose(hits, fall * (1 + 2 * np.arange(len(hits))), atol=1e-9)
    assert len(hits) == 22
    np.testing.assert_allclose(sol.energy.total, sol.energy.total[0], rtol=1e-11)


def test_a_plastic_ball_stays() -> None:
    sol = ball(0.0).simulate(1.0)
    assert [one.what for one in sol.events] == ["impact", "closes"]
    assert sol.events[0].time == pytest.approx(math.sqrt(2 / G), abs=1e-12)
    assert sol.events[0].impulse == pytest.approx(2 * math.sqrt(2 * G), rel=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_every_integrator_meets_the_same_event(method: str) -> None:
    m = ball(0.8)
    m.start_moving(ball=(1.0, 0.0, 3.0))
    sol = m.simulate(2.0, method=method)
    fall = math.sqrt(2 / G)
    near = 1e-10 if INTEGRATORS[method].order else 1e-4  # where the order begins at 1, a parabola is not exact
    np.testing.assert_allclose(times_of(sol, "floor", "impact"), [fall, 2.6 * fall, 3.88 * fall], atol=near)
    assert sol.body("ball").x[-1] == pytest.approx(2.0, abs=near), "without friction it goes on"


def test_newtons_cradle_hands_the_speed_on() -> None:
    m = Mechanism("cradle", gravity=None)
    balls = [m.body(f"ball {k}", 0.5, inertia=0.01) for k in range(3)]
    for k, body in enumerate(balls):
        m.prismatic(f"rail {k}", m.ground.origin, body.origin)
        m.start_near(**{f"ball {k}": (0.1 * k if k else -0.4, 0.0, 0.0)})
    for k in range(2):
        m.rigid_discs(f"touch {k}", balls[k].origin, balls[k + 1].origin, 0.05, 0.05, restitution=1.0)
    m.start_moving(**{"ball 0": (1.0, 0.0, 0.0)})
    sol = m.simulate(1.0)
    np.testing.assert_allclose([sol.body(f"ball {k}").vx[-1] for k in range(3)], [0, 0, 1], atol=1e-12)
    assert sol.body("ball 0").x[-1] == pytest.approx(0.0, abs=1e-12)
    assert times_of(sol, "touch 0", "impact") == times_of(sol, "touch 1", "impact") == [pytest.approx(0.4, abs=1e-12)]
    assert [one.impulse for one in sol.events if one.what == "impact"] == [pytest.approx(0.5), pytest.approx(0.5)]


def test_a_method_that_does_not_know_friction_says_so() -> None:
    m = disc(0.2)
    with pytest.raises(ModelError, match="does not know the friction of rigid contacts"):
        m.simulate(1.0, method="rattle")


@pytest.mark.parametrize("restitution", [0.0, 0.6, 1.0])
def test_a_pendulum_loses_what_its_stop_takes(restitution: float) -> None:
    m = Mechanism("pendulum", gravity=(0.0, -G))
    rod = m.bar("rod", 1.0, mass=3.0)
    hinge = m.revolute("A", m.ground.at(0, 0), rod.start)
    m.stop("post", hinge, lower=math.radians(-90), restitution=restitution)
    m.start_near(rod=0)
    sol = m.simulate(1.0, tolerance=1e-10)
    hit = sol.events[0]
    swing = 3.0 * G * 0.5
    assert (hit.name, hit.what) == ("post lower", "impact")
    assert hit.energy == pytest.approx(-(1 - restitution**2) * swing, abs=1e-8)
    assert hit.impulse == pytest.approx((1 + restitution) * math.sqrt(2 * swing * 1.0), rel=1e-9)
    assert sol.body("rod").theta.min() > math.radians(-90) - 1e-12
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-7)
    if restitution == 1.0:
        again = sol.at(2 * hit.time - 1e-12 if 2 * hit.time < 1.0 else 1.0)
        assert again.energy.total[0] == pytest.approx(sol.energy.total[0], abs=1e-7)


def test_a_slider_goes_to_and_fro_between_its_ends() -> None:
    m = Mechanism("shuttle", gravity=None)
    block = m.body("block", 1.0, inertia=1.0)
    guide = m.prismatic("guide", m.ground.origin, block.origin)
    m.stop("end", guide, lower=-0.25, upper=0.75, restitution=1.0)
    m.start_moving(block=(1.0, 0.0, 0.0))
    sol = m.simulate(4.0, steps=100)
    saw = np.abs((sol.t + 0.25) % 2.0 - 1.0)
    np.testing.assert_allclose(sol.body("block").x, 0.75 - saw, atol=1e-11)
    assert times_of(sol, "end upper", "impact") == pytest.approx([0.75, 2.75], abs=1e-11)
    assert times_of(sol, "end lower", "impact") == pytest.approx([1.75, 3.75], abs=1e-11)


def test_a_one_way_clutch_holds_and_overruns() -> None:
    m = Mechanism("freewheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=2.0)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel)
    m.torque("load", wheel, lambda t: 3.0 * math.cos(t))
    sol = m.simulate(2.0 * math.pi, tolerance=1e-10)
    assert [(one.what, one.name) for one in sol.events] == [("closes", "clutch"), ("opens", "clutch")]
    np.testing.assert_allclose(
        [one.time for one in sol.events], [math.pi, 1.5 * math.pi], atol=1e-8, err_msg="omega = 1.5 sin t"
    )
    wheel_of = sol.body("wheel")
    expected = np.where(
        sol.t < math.pi, 1.5 * np.sin(sol.t), np.where(sol.t < 1.5 * math.pi, 0, 1.5 + 1.5 * np.sin(sol.t))
    )
    np.testing.assert_allclose(wheel_of.omega, expected, atol=1e-7)
    locked = (sol.t > math.pi + 1e-6) & (sol.t < 1.5 * math.pi - 1e-6)
    np.testing.assert_allclose(sol.contact("clutch").normal[locked], -3.0 * np.cos(sol.t[locked]), atol=1e-9)


def test_a_clutch_takes_up_a_forbidden_start() -> None:
    m = Mechanism("freewheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=2.0)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel, clockwise=True)
    m.start_moving(wheel=3.0)
    sol = m.simulate(1.0)
    assert sol.events[0].impulse == pytest.approx(6.0)
    assert np.abs(sol.body("wheel").theta).max() < 1e-12


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


def disc(friction: float, slope: float = 0.0) -> Mechanism:
    m = Mechanism("disc", gravity=(0.0, -G))
    wheel = m.body("wheel", 3.0, inertia=0.5 * 3.0 * 0.2**2)
    m.rigid_contact("road", m.ground.at(0, 0, slope), wheel.origin, radius=0.2, friction=friction)
    m.start_near(wheel=(-0.2 * math.sin(slope), 0.2 * math.cos(slope), 0))
    return m


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


def box(restitution: float, friction: float, points: int = 2) -> Mechanism:
    m = Mechanism("box", gravity=(0.0, -G))
    body = m.body("box", 4.0, inertia=4.0 * (1 + 0.25) / 12)
    for k, x in enumerate(np.linspace(-0.5, 0.5, points)):
        m.rigid_contact(
            f"foot {k}", m.ground.origin, body.at(float(x), -0.25), restitution=restitution, friction=friction
        )
    m.start_near(box=(0, 0.25, 0))
    return m


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


def test_a_box_tips_when_it_is_pushed_high() -> None:
    """It tips about its foot as soon as push x height exceeds weight x half the width."""
    m = box(0.0, 2.0)
    m.force("push", m.bodies["box"].at(0, 0.25), lambda t: 100.0 * t)
    sol = m.simulate(0.5, tolerance=1e-9)
    assert times_of(sol, "foot 0", "opens") == [pytest.approx(4 * G * 0.5 / 0.5 / 100.0, abs=1e-8)]
    assert sol.body("box").theta[-1] < -1e-3
    assert np.abs(sol.contact("foot 1").gap).max() < 1e-12


def test_a_rope_catches_a_falling_weight() -> None:
    m = Mechanism("rope", gravity=(0.0, -G))
    weight = m.body("weight", 2.0, inertia=0.1)
    m.rope("rope", m.ground.at(0, 0), weight.origin, 1.0)
    m.start_near(weight=(0.6, 0.0, 0.0))
    sol = m.simulate(2.0, tolerance=1e-9)
    taut = math.sqrt(2 * 0.8 / G)
    assert times_of(sol, "rope", "impact")[0] == pytest.approx(taut, abs=1e-10)
    reach = np.hypot(sol.body("weight").x, sol.body("weight").y)
    assert reach.max() < 1 + 1e-11
    speed = G * taut
    assert sol.events[0].energy == pytest.approx(-0.5 * 2 * (0.8 * speed) ** 2, rel=1e-9), "what went along the rope"
    np.testing.assert_allclose(balance(sol), balance(sol)[0], atol=1e-7)


def test_events_of_the_user_are_met_exactly_and_may_end_the_run() -> None:
    m = Mechanism("fall", gravity=(0.0, -G))
    stone = m.body("stone", 1.0, inertia=1.0)
    m.event("half way", lambda t, moment: moment.body("stone").y - 5.0)
    m.event("upwards", lambda t, moment: moment.body("stone").y - 7.0, direction=1)
    m.event("near", distance_reaches(m.ground.origin, stone.origin, 4.0))
    m.event("fast", speed_reaches(stone, 1.0))
    m.event("down", lambda t, moment: moment.point(stone.origin).y, direction=-1, terminal=True)
    m.start_near(stone=(0, 10, 0))
    sol = m.simulate(5.0, steps=20)
    expected = [("half way", 5.0), ("near", 6.0), ("down", 10.0)]
    assert [one.name for one in sol.events] == [name for name, _ in expected]
    times = [math.sqrt(2 * way / G) for _, way in expected]
    np.testing.assert_allclose([one.time for one in sol.events], times, atol=1e-10)
    assert sol.t[-1] == sol.events[-1].time
    assert sol.body("stone").y[-1] == pytest.approx(0.0, abs=1e-11)
    assert sol.events[-1].what == "end"


def test_an_action_changes_velocities_and_lets_a_joint_go() -> None:
    m = Mechanism("sling", gravity=None)
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("A", m.ground.origin, arm.start)
    m.event("quarter", angle_reaches(arm, math.pi / 2), action=lambda moment: moment.release("A"))
    m.start_moving(arm=2.0)
    sol = m.simulate(2.0, event_rows=True)
    loose = math.pi / 4
    assert times_of(sol, "quarter", "event") == [pytest.approx(loose, abs=1e-10)]
    after = sol.t > loose
    np.testing.assert_allclose(sol.body("arm").omega, 2.0, atol=1e-9)
    middle = sol.body("arm").x + 0.5 * np.cos(sol.body("arm").theta)
    np.testing.assert_allclose(middle[after], -1.0 * (sol.t[after] - loose), atol=1e-8)
    assert np.abs(sol.joint("A").reaction[after][1:]).max() == 0.0
    assert (np.diff(sol.t) == 0).sum() == 1, "one row before, one after"

    hit = Mechanism("hit", gravity=None)
    arm = hit.bar("arm", 1.0, mass=3.0)
    hit.revolute("A", hit.ground.origin, arm.start)
    hit.event("now", lambda t, moment: t - 0.5, action=lambda moment: moment.push(arm.end, 0.0, 2.0))
    sol = hit.simulate(1.0)
    assert sol.body("arm").omega[-1] == pytest.approx(2.0), "impulse 2 at arm 1 over inertia 3 / 3"


def test_the_motion_between_outputs_is_that_of_the_run() -> None:
    m = ball(0.8)
    m.start_moving(ball=(1.0, 0.0, 3.0))
    coarse = m.simulate(3.0, steps=4)
    fine = m.simulate(3.0, steps=60)
    between = coarse.at(fine.t)
    for part in ("x", "y", "vy", "ay"):
        np.testing.assert_allclose(getattr(between.body("ball"), part), getattr(fine.body("ball"), part), atol=1e-9)
    np.testing.assert_allclose(between.energy.total, fine.energy.total, atol=1e-9)
    with pytest.raises(ModelError, match=r"covers 0 \.\. 3 s"):
        coarse.at(3.1)


def test_the_same_inputs_give_the_same_numbers() -> None:
    def run() -> Solution:
        m = box(0.4, 0.3)
        m.start_near(box=(0, 1.0, 20))
        m.start_moving(box=(1.0, 0.0, 2.0))
        return m.simulate(1.5)

    first, second = run(), run()
    assert first.events == second.events
    assert (first.q == second.q).all()
    assert (first.lam == second.lam).all()
    np.testing.assert_allclose(balance(first), balance(first)[0], atol=1e-5)
    assert all(one.energy <= 1e-12 for one in first.events), "no impact makes energy"
    assert min(first.contact("foot 0").gap.min(), first.contact("foot 1").gap.min()) > -1e-10


def test_what_cannot_be_is_refused() -> None:
    m = ball(0.5, height=-0.5)
    with pytest.raises(SimulationError, match=r"contact 'floor' starts 0\.5 .* inside"):
        m.simulate(1.0)
    body = m.bodies["ball"]
    with pytest.raises(ModelError, match=r"restitution is 1\.5"):
        m.rigid_contact("a", m.ground.origin, body.origin, restitution=1.5)
    with pytest.raises(ModelError, match="friction is -1"):
        m.rigid_contact("a", m.ground.origin, body.origin, friction=-1.0)
    with pytest.raises(ModelError, match=r"static_friction is 0\.1"):
        m.rigid_contact("a", m.ground.origin, body.origin, friction=0.5, static_friction=0.1)
    with pytest.raises(ModelError, match="ring i must be larger"):
        m.rigid_discs("a", m.ground.origin, body.origin, 0.1, 0.2, inside=True)
    with pytest.raises(ModelError, match="two of the name 'floor'"):
        m.rope("floor", m.ground.origin, body.origin, 1.0)
    with pytest.raises(ModelError, match="needs a revolute or prismatic joint"):
        m.stop("a", m.contacts["floor"], lower=0.0)
    with pytest.raises(ModelError, match="must be a function"):
        m.event("a", 3.0)  # type: ignore[arg-type]
    m.start_near(ball=(0, 1, 0))
    m.event("broken", lambda t, moment: math.nan)
    with pytest.raises(ModelError, match="event 'broken' is nan at t = 0 s"):
        m.simulate(1.0)


def all_kinds() -> Mechanism:
    """Two free bodies, and every kind of contact between them."""
    m = Mechanism("kinds", gravity=None)
    first, second = m.body("first", 1.0, (0.1, 0.0), 0.2), m.body("second", 2.0, (0.0, 0.1), 0.3)
    i, j = first.at(0.1, 0.2, 0.3), second.at(-0.2, 0.1, 0.5)
    for name, kind in CONTACT_KINDS.items():
        kind.example(m, i, j)
        m.contacts[name] = m.contacts.pop("example")
    return m


def test_every_kind_of_contact_has_the_gradient_and_curvature_of_its_gap() -> None:
    packed = pack(all_kinds(), list(all_kinds().contacts.values()))
    rng = np.random.default_rng(5)
    q, v = rng.normal(size=9), rng.normal(size=9)
    q[:3] = v[:3] = 0.0
    h = 1e-5
    at = [q - h * v, q, q + h * v]
    rows = packed.first_row[-1]
    phi, gamma, compact = np.zeros((3, rows)), np.zeros((3, rows)), np.zeros((3, rows, 6))
    tabulate(packed.system, np.zeros((3, 1, 3)), np.array(at), np.array([v] * 3), packed.ws, phi, compact, gamma)
    rates = packed.spread(compact[1]) @ v[3:]
    np.testing.assert_allclose((phi[2] - phi[0]) / (2 * h), rates, atol=1e-8)
    np.testing.assert_allclose((phi[2] - 2 * phi[1] + phi[0]) / h**2, -gamma[1], atol=1e-4)
    assert {name for joint in packed.joints for name in joint.kind.constraints} == {
        "linear",
        "turn",
        "radial",
        "gear",
        "curve",
        "curve_rolling",
    }


def test_every_kind_of_contact_is_saved(tmp_path: Path) -> None:
    m = all_kinds()
    m.save(tmp_path / "kinds.json")
    loaded = Mechanism.load(tmp_path / "kinds.json")
    assert {name: (c.kind, c.params) for name, c in loaded.contacts.items()} == {
        name: (c.kind, c.params) for name, c in m.contacts.items()
    }
    m.event("end", lambda t, moment: t - 1.0)
    with pytest.raises(ModelError, match="events of the model cannot be saved"):
        m.save(tmp_path / "kinds.json")


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 8), st.integers(1, 8), st.integers(0, 2**32 - 1))
def test_lemke_solves_what_contacts_ask(contacts: int, freedoms: int, seed: int) -> None:
    """G = A A^T, singular where contacts outnumber freedoms; g = A u, as gaps of real motions."""
    rng = np.random.default_rng(seed)
    a = rng.normal(size=(contacts, freedoms))
    g = a @ a.T
    size = np.diag(g).max()
    q = a @ rng.normal(size=freedoms)
    z = lemke(g / size, q)
    assert z is not None
    w = g / size @ z + q
    assert z.min() >= 0.0
    assert w.min() > -1e-8
    assert abs(z @ w) < 1e-7 * max(1.0, np.abs(z).max())
