"""Contacts, stops, friction and events of simulations against closed forms."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest

from mbsd import (
    Mechanism,
    ModelError,
    SimulationError,
    angle_reaches,
    distance_reaches,
    harmonic,
    speed_reaches,
)
from mbsd.dynamics.integrators.kind import INTEGRATORS
from mbsd.results.solution import Solution
from mbsd.testing import integrators
from tools.models.contact_models import G, balance, ball, box, disc, times_of

METHODS = sorted(method.name for method in integrators() if method.installed)


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
    assert [event.what for event in sol.events] == ["impact", "closes"]
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
    assert [event.impulse for event in sol.events if event.what == "impact"] == [pytest.approx(0.5), pytest.approx(0.5)]


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


def freewheel(torque: Any) -> Mechanism:
    """A wheel that its clutch lets turn counterclockwise alone, under a torque."""
    m = Mechanism("freewheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=2.0)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel)
    m.torque("load", wheel, torque)
    return m


@pytest.mark.parametrize("method", ["rattle", "symplectic", "rk4", "radau", "generalized_alpha"])
def test_a_clutch_opens_whatever_the_order_of_the_integrator(method: str) -> None:
    settings = {"tolerance": 1e-9} if method == "radau" else {"step": 2.5e-3}
    sol = freewheel(harmonic(3.0, 1.0, math.pi / 2)).simulate(6.0, method=method, **settings)
    assert times_of(sol, "clutch", "opens") == pytest.approx([1.5 * math.pi], abs=1e-5)
    assert sol.body("wheel").omega[-1] == pytest.approx(1.5 + 1.5 * math.sin(6.0), abs=1e-5)


def test_a_one_way_clutch_holds_and_overruns() -> None:
    sol = freewheel(lambda t: 3.0 * math.cos(t)).simulate(2.0 * math.pi, tolerance=1e-10)
    assert [(event.what, event.name) for event in sol.events] == [("closes", "clutch"), ("opens", "clutch")]
    np.testing.assert_allclose(
        [event.time for event in sol.events], [math.pi, 1.5 * math.pi], atol=1e-8, err_msg="omega = 1.5 sin t"
    )
    wheel_of = sol.body("wheel")
    expected = np.where(
        sol.t < math.pi, 1.5 * np.sin(sol.t), np.where(sol.t < 1.5 * math.pi, 0, 1.5 + 1.5 * np.sin(sol.t))
    )
    np.testing.assert_allclose(wheel_of.omega, expected, atol=1e-7)
    locked = (sol.t > math.pi + 1e-6) & (sol.t < 1.5 * math.pi - 1e-6)
    np.testing.assert_allclose(sol.contact("clutch").normal[locked], -3.0 * np.cos(sol.t[locked]), atol=1e-9)
    assert wheel_of.theta[locked].min() > 2.9
    assert sol.stats.position_residual < 1e-12, "how far it had turned when it locked is no residual"


def test_a_clutch_takes_up_a_forbidden_start() -> None:
    m = Mechanism("freewheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=2.0)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel, clockwise=True)
    m.start_moving(wheel=3.0)
    sol = m.simulate(1.0)
    assert sol.events[0].impulse == pytest.approx(6.0)
    assert np.abs(sol.body("wheel").theta).max() < 1e-12


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
    assert [event.name for event in sol.events] == [name for name, _ in expected]
    times = [math.sqrt(2 * way / G) for _, way in expected]
    np.testing.assert_allclose([event.time for event in sol.events], times, atol=1e-10)
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
    assert all(event.energy <= 1e-12 for event in first.events), "no impact makes energy"
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
    with pytest.raises(ModelError, match="stop 'a': there is no joint 'floor'"):
        m.stop("a", m.contacts["floor"], lower=0.0)
    with pytest.raises(ModelError, match="must be a function"):
        m.event("a", 3.0)  # type: ignore[arg-type]
    m.start_near(ball=(0, 1, 0))
    m.event("broken", lambda t, moment: math.nan)
    with pytest.raises(ModelError, match="event 'broken' is nan at t = 0 s"):
        m.simulate(1.0)


@pytest.mark.parametrize("method", ["scipy-lsoda", "scipy-dop853", "radau"])
def test_a_gap_that_opens_slower_than_an_integrator_errs_is_no_event(method: str) -> None:
    """A mass off its rope's end: after the rope goes taut it comes loose with almost no speed."""
    m = Mechanism("rope")
    mass = m.body("mass", 2.46, com=(0.043, 0.034), inertia=0.0027)
    m.rope("rope", m.ground.origin, mass.origin, 0.6)
    m.start_near(mass=(0.2147, -0.3101, 0))
    exact = m.simulate(0.4, steps=20, tolerance=1e-11)
    sol = m.simulate(0.4, steps=20, method=method, tolerance=1e-8)
    assert [event.what for event in exact.events] == ["impact", "impact", "closes", "opens"]
    late = [event for event in sol.events if event.impulse > 1e-5 or event.what != "impact"]
    assert [event.what for event in late] == [event.what for event in exact.events]
    np.testing.assert_allclose([event.time for event in late], [event.time for event in exact.events], atol=1e-5)
    np.testing.assert_allclose(sol.q, exact.q, atol=1e-5)
