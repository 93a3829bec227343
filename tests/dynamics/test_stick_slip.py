"""Joints that stick and slide by events: closed forms, shared friction, and what belongs together with contacts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbsd import Mechanism, ModelError, constant_rate, harmonic, polynomial
from mbsd.results.solution import Solution
from tools.models.sticking import loaded_lever, slider_crank

G = 9.80665


def incline(angle: float, speed: float, **friction: float | bool) -> Mechanism:
    """A block thrown up an incline, its x axis down the slope."""
    m = Mechanism("incline")
    block = m.body("block", 2.0, inertia=0.1)
    m.prismatic("plane", m.ground.at(0, 0, -angle), block.origin)
    m.friction("rub", "plane", **friction)  # type: ignore[arg-type]
    m.start_near(block=(0.0, 0.0, -math.degrees(angle)))
    m.start_moving(block=(-speed * math.cos(angle), speed * math.sin(angle), 0.0))
    return m


def way(sol: Solution, angle: float) -> np.ndarray:
    view = sol.body("block")
    return view.x * math.cos(angle) - view.y * math.sin(angle)


def told(sol: Solution) -> list[tuple[str, str]]:
    return [(event.name, event.what) for event in sol.events]


def test_a_block_stays_where_it_stops_on_a_gentle_incline() -> None:
    angle, mu, speed = 0.2, 0.3, 1.5
    sol = incline(angle, speed, coefficient=mu, sticks=True).simulate(1.0, steps=50, tolerance=1e-9)
    slowing = G * (math.sin(angle) + mu * math.cos(angle))
    assert told(sol) == [("rub", "sticks")]
    assert sol.events[0].time == pytest.approx(speed / slowing, rel=1e-12)
    rest = sol.t > speed / slowing
    np.testing.assert_allclose(way(sol, angle)[rest], -(speed**2) / 2 / slowing, rtol=1e-12)
    np.testing.assert_array_less(np.abs(sol.friction("rub").rate[rest]), 1e-14)
    np.testing.assert_allclose(sol.friction("rub").force[rest], -2.0 * G * math.sin(angle), rtol=1e-12)
    np.testing.assert_allclose(sol.friction("rub").normal, 2.0 * G * math.cos(angle), rtol=1e-12)
    np.testing.assert_allclose(sol.friction("rub").force[~rest], mu * 2.0 * G * math.cos(angle), rtol=1e-12)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-10


def test_a_block_comes_back_down_a_steep_incline() -> None:
    angle, mu, speed = 0.5, 0.3, 1.5
    sol = incline(angle, speed, coefficient=mu, sticks=True).simulate(1.0, steps=50, tolerance=1e-9)
    up, down = (G * (math.sin(angle) + sign * mu * math.cos(angle)) for sign in (1, -1))
    turn = speed / up
    after = sol.t > turn
    expected = -(speed**2) / 2 / up + down * (sol.t[after] - turn) ** 2 / 2
    np.testing.assert_allclose(way(sol, angle)[after], expected, atol=1e-12)
    assert told(sol) == []


@pytest.mark.parametrize("static", [0.25, 0.5])
def test_a_pull_that_grows_breaks_it_away_at_the_static_friction(static: float) -> None:
    m = Mechanism("sledge")
    sledge = m.body("sledge", 3.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, sledge.origin)
    m.friction("rub", "rail", 0.25, static=static, preload=5.0, sticks=True)
    m.force("pull", sledge.origin, polynomial(0.0, 4.0))
    sol = m.simulate(6.0, steps=60)
    assert told(sol) == [("rub", "sticks"), ("rub", "slides")]
    assert sol.events[1].time == pytest.approx(static * (3.0 * G + 5.0) / 4.0, rel=1e-9)
    held = sol.t < sol.events[1].time
    np.testing.assert_allclose(sol.friction("rub").force[held], -4.0 * sol.t[held], atol=1e-12)
    assert sol.body("sledge").x[-1] > 0.01


def test_a_wheel_on_a_spring_loses_as_much_each_swing_and_stops_beside_its_zero() -> None:
    """I theta'' = -k theta - mu r N_0 sign(theta'): each half swing ends 2 mu r N_0 / k nearer to zero."""
    stiffness, inertia, torque, start = 2.0, 0.5, 0.3 * 0.05 * 20.0, 2.03
    m = Mechanism("wheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=inertia)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.torsion_spring("spring", m.ground, wheel, stiffness)
    m.friction("rub", "axle", 0.3, radius=0.05, preload=20.0, sticks=True)
    m.start_near(wheel=math.degrees(start))
    half = math.pi * math.sqrt(inertia / stiffness)
    swings = int((start - torque / stiffness) / (2 * torque / stiffness)) + 1
    sol = m.simulate(times=half * np.arange(swings + 4), tolerance=1e-11)
    ends = (start - 2 * torque / stiffness * np.minimum(np.arange(swings + 4), swings)) * (-1.0) ** np.minimum(
        np.arange(swings + 4), swings
    )
    np.testing.assert_allclose(sol.body("wheel").theta, ends, atol=1e-9)
    assert told(sol) == [("rub", "sticks")]
    assert sol.events[0].time == pytest.approx(swings * half, rel=1e-9)
    middle = sol.at(half * 1.5)
    assert middle.friction("rub").force[0] == pytest.approx(-torque, rel=1e-12)
    assert sol.at(sol.t[-1] - 0.1).friction("rub").force[0] == pytest.approx(stiffness * ends[-1], rel=1e-8)


def test_a_block_on_a_belt_sticks_and_slips_as_its_own_equation_does() -> None:
    """Slip phases integrated by scipy: m x'' = -k x + F(x'), F by Stribeck; stick phases in closed form."""
    k, mass, belt_speed, mu, static, fall = 50.0, 1.0, 0.1, 0.3, 0.5, 0.05
    weight = mass * G
    m = Mechanism("belt")
    belt, block = m.body("belt", 1.0, inertia=1.0), m.body("block", mass, inertia=1.0)
    m.prismatic("rail", m.ground.origin, belt.origin)
    m.drive_coordinate("motor", m.ground.origin, belt.origin, constant_rate(belt_speed))
    m.prismatic("touch", belt.origin, block.origin)
    m.friction("rub", "touch", mu, static=static, stribeck=fall, sticks=True)
    m.spring("spring", m.ground.at(-3, 0), block.origin, k, free_length=3.0)
    m.start_near(belt=(0, 0, 0), block=(0, 0, 0))
    m.start_moving(block=(belt_speed, 0, 0))
    sol = m.simulate(5.0, steps=50, tolerance=1e-11)

    def slip(_: float, y: np.ndarray) -> list[float]:
        rate = belt_speed - y[1]
        return [y[1], (-k * y[0] + weight * (mu + (static - mu) * math.exp(-((rate / fall) ** 2)))) / mass]

    def caught(t: float, y: np.ndarray) -> float:
        return belt_speed - y[1] if t > 0.05 else 1.0

    caught.terminal = True  # type: ignore[attr-defined]
    expected, at = [], static * weight / k / belt_speed
    while at < 5.0:
        expected.append((at, "slides"))
        sliding = solve_ivp(
            slip,
            (0, 5),
            [static * weight / k, belt_speed * (1 - 1e-12)],
            "DOP853",
            events=caught,
            rtol=1e-12,
            atol=1e-14,
        )
        stuck_at, at = sliding.y_events[0][0][0], at + sliding.t_events[0][0]
        if at < 5.0:
            expected.append((at, "sticks"))
        at += (static * weight / k - stuck_at) / belt_speed
    assert [event.what for event in sol.events[1:]] == [what for _, what in expected]
    np.testing.assert_allclose([event.time for event in sol.events[1:]], [time for time, _ in expected], atol=1e-5)


def rough_slider_crank(**friction: float | bool) -> Mechanism:
    m = slider_crank(gravity=None)
    for pin in "OAB":
        m.friction(f"rub {pin}", pin, 0.15, static=0.2, radius=0.02, preload=20.0, **friction)  # type: ignore[arg-type]
    m.friction("rub", "rail", 0.2, length=0.08, preload=10.0, **friction)  # type: ignore[arg-type]
    return m


RUBS = ("rub O", "rub A", "rub B", "rub")


def limits(sol: Solution, mu_pin: float, mu_rail: float) -> np.ndarray:
    """(T, 4) largest friction of the slider-crank's joints."""
    normal = np.stack([sol.friction(name).normal for name in RUBS], axis=1)
    lever, preload = np.array([0.02 * mu_pin] * 3 + [mu_rail]), np.array([20.0, 20.0, 20.0, 10.0])
    return lever * (normal + preload)


def test_coasting_agrees_with_the_smooth_form_and_then_rests() -> None:
    m, smooth = rough_slider_crank(sticks=True), rough_slider_crank(slip_speed=1e-6)
    for mechanism in (m, smooth):
        mechanism.start_moving(crank=6.0)
    sol, near = m.simulate(0.6, steps=60, tolerance=1e-10), smooth.simulate(0.6, steps=60, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("crank").theta, near.body("crank").theta, atol=2e-6)
    assert sorted(told(sol)) == sorted((name, "sticks") for name in RUBS)
    assert len({event.time for event in sol.events}) == 1
    assert np.abs(sol.body("crank").omega[sol.t > sol.events[0].time]).max() < 1e-14
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-8


def test_joints_at_rest_share_the_load_and_give_way_together() -> None:
    m = rough_slider_crank(sticks=True)
    m.torque("motor", m.bodies["crank"], polynomial(0.0, 3.0))
    sol = m.simulate(0.3, steps=60, event_rows=True)
    assert told(sol)[4:] == [(name, "slides") for name in RUBS]
    held = np.flatnonzero((sol.t > 0) & (sol.t <= sol.events[-1].time))[:-1]
    force = np.stack([sol.friction(name).force for name in RUBS], axis=1)[held]
    part = np.abs(force) / limits(sol, 0.2, 0.2)[held]
    np.testing.assert_allclose(part, part[:, :1] * np.ones(4), rtol=1e-9)
    np.testing.assert_allclose(part[-1], 1.0, rtol=1e-8)
    # virtual work of a small turn of the crank: the torque moves what the friction at its limit resists
    sweep = rough_slider_crank(sticks=True)
    sweep.drive_angle("turn", sweep.bodies["crank"], constant_rate(1.0, math.radians(30)))
    driven = sweep.sweep(times=[0.0, 1e-3])
    rates = np.array([driven.friction(name).rate[0] for name in RUBS])
    assert 3.0 * sol.events[-1].time == pytest.approx(-(force[-1] * rates).sum(), rel=1e-9)
    assert sol.body("crank").theta[-1] > math.radians(31)


def test_full_turns_pass_the_turning_points_of_the_rod_and_the_dead_points_of_the_slider() -> None:
    m, smooth = rough_slider_crank(sticks=True), rough_slider_crank(slip_speed=1e-6)
    for mechanism in (m, smooth):
        mechanism.start_moving(crank=60.0)
    sol, near = m.simulate(0.25, steps=50, tolerance=1e-10), smooth.simulate(0.25, steps=50, tolerance=1e-10)
    assert sol.body("crank").theta[-1] > 9.5
    np.testing.assert_allclose(sol.body("crank").theta, near.body("crank").theta, atol=1e-6)
    force, limit = np.stack([sol.friction(name).force for name in RUBS], axis=1), limits(sol, 0.15, 0.2)
    slip = np.stack([sol.friction(name).rate for name in RUBS], axis=1) * [0.02, 0.02, 0.02, 1.0]
    fast = np.abs(slip) > 0.06  # beyond Stribeck's rise
    np.testing.assert_allclose(force[fast], (-limit * np.sign(slip))[fast], rtol=1e-9)


def test_only_the_joint_that_is_overloaded_slides() -> None:
    m = Mechanism("two", gravity=None)
    first, second = m.body("first", 1.0, inertia=1.0), m.body("second", 2.0, inertia=1.0)
    m.prismatic("a", m.ground.origin, first.origin)
    m.prismatic("b", first.origin, second.origin)
    m.friction("rub a", "a", 0.5, preload=10.0, sticks=True)
    m.friction("rub b", "b", 0.5, preload=6.0, sticks=True)
    m.force("pull", second.origin, harmonic(4.0, 1.0))
    m.start_near(first=(0, 0, 0), second=(0, 0, 0))
    sol = m.simulate(6.0, steps=30, tolerance=1e-10)
    assert ("rub b", "slides") in told(sol)
    assert ("rub a", "slides") not in told(sol), "3 N reach the first at most, of the 5 N that it holds"
    slides, sticks = (event.time for event in sol.events[2:4])
    assert slides == pytest.approx(math.asin(3.0 / 4.0), rel=1e-9)
    # 2 v' = 4 sin t - 3 from then on, until v = 0
    assert 4.0 * (math.cos(slides) - math.cos(sticks)) == pytest.approx(3.0 * (sticks - slides), rel=1e-8)
    np.testing.assert_allclose(sol.body("first").x, 0.0, atol=1e-14)
    after = sol.at(sticks + 1e-9)
    assert abs(after.friction("rub b").rate[0]) < 1e-12


def carriage(beta: float, **friction: float | bool) -> Mechanism:
    """A carriage on a rail with friction, its foot in a slanting guide on rough ground: each presses the other."""
    m = Mechanism("carriage")
    cart, foot = m.body("cart", 3.0, inertia=1.0), m.body("foot", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 1), cart.origin)
    m.prismatic("guide", cart.at(0, 0, math.pi / 2 - beta), foot.at(0, 1, math.pi / 2 - beta))
    m.rigid_contact("ground", m.ground.origin, foot.origin, friction=0.4)
    m.friction("rub", "rail", 0.3, **friction)  # type: ignore[arg-type]
    m.start_near(cart=(0, 1, 0), foot=(0, 0, 0))
    m.start_moving(cart=(2.0, 0, 0), foot=(2.0, 0, 0))
    return m


@pytest.mark.parametrize("friction", [{"sticks": True}, {"slip_speed": 1e-6}], ids=["events", "smooth"])
@pytest.mark.parametrize("beta", [-0.3, 0.0, 0.4])
def test_friction_of_a_contact_and_of_a_joint_press_each_other(beta: float, friction: dict) -> None:
    sol = carriage(beta, **friction).simulate(0.9, steps=9, tolerance=1e-9)
    # unknown: a, N of the contact, h across the guide, R of the rail
    nx, ny = math.cos(beta), -math.sin(beta)
    matrix = [[1.0, 0.4, -nx, 0.0], [0.0, 1.0, ny, 0.0], [3.0, 0.0, nx, 0.3], [0.0, 0.0, -ny, 1.0]]
    a, normal, _, rail = np.linalg.solve(matrix, [0.0, G, 0.0, 3 * G])
    stop = -2.0 / a
    sliding = sol.t < stop
    np.testing.assert_allclose(sol.body("cart").ax[sliding], a, rtol=1e-8)
    np.testing.assert_allclose(sol.contact("ground").normal[sliding], normal, rtol=1e-8)
    np.testing.assert_allclose(sol.friction("rub").normal[sliding], rail, rtol=1e-8)
    assert sol.body("cart").x[-1] == pytest.approx(2.0**2 / -a / 2, rel=1e-5)
    assert stop < 0.85
    assert abs(sol.body("cart").vx[-1]) < 1e-5
    assert sol.stats.power_residual < 1e-8


def test_a_driven_joint_tells_its_friction_with_the_sign_of_its_motion() -> None:
    m = Mechanism("shaker")
    slider = m.body("slider", 2.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, slider.origin)
    m.drive_coordinate("shake", m.ground.origin, slider.origin, harmonic(0.1, 3.0))
    m.friction("rub", "rail", 0.3, sticks=True)
    sol, swept = m.simulate(1.0, steps=37), m.sweep(1.0, steps=37)
    np.testing.assert_allclose(sol.driver("shake").force, swept.driver("shake").force, atol=1e-8)
    moving = np.abs(sol.friction("rub").rate) > 1e-6
    expected = -0.3 * 2.0 * G * np.sign(sol.friction("rub").rate)
    for solution in (sol, swept):
        np.testing.assert_allclose(solution.friction("rub").force[moving], expected[moving], rtol=1e-9)


@pytest.mark.parametrize("sticks", [True, False])
def test_a_joint_that_is_let_go_has_no_friction_any_more(sticks: bool) -> None:
    m = Mechanism("let go", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=0.5)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.friction("rub", "axle", 0.2, radius=0.1, preload=10.0, viscous=0.1, sticks=sticks)
    m.start_moving(wheel=10.0)
    m.event("break", lambda t, moment: t - 0.5, action=lambda moment: moment.release("axle"))
    sol = m.simulate(1.0, steps=20, tolerance=1e-10)
    omega = sol.body("wheel").omega
    assert omega[9] < 9.5
    np.testing.assert_allclose(omega[sol.t >= 0.5], omega[10], rtol=1e-12)
    assert sol.stats.power_residual < 1e-9


def test_an_impact_frees_a_joint_at_rest() -> None:
    """A ball falls on a lever that its pin holds: the pin is no part of the impact, and slides after it."""
    m = loaded_lever()
    sol = m.simulate(0.5, steps=50, tolerance=1e-9)
    hit = next(event for event in sol.events if event.what == "impact")
    assert told(sol)[0] == ("rub", "sticks")
    assert ("rub", "slides") in [(e.name, e.what) for e in sol.events if e.time == hit.time]
    fall = math.sqrt(2 * G * 0.3)
    assert hit.impulse == pytest.approx(fall / (1 / 0.5 + 0.3**2 / 0.1), rel=1e-9)


def test_the_form_is_kept_in_a_file(tmp_path) -> None:
    m = rough_slider_crank(sticks=True)
    m.start_moving(crank=6.0)
    m.save(tmp_path / "m.json")
    again = Mechanism.load(tmp_path / "m.json")
    original, loaded = m.simulate(0.4, steps=4), again.simulate(0.4, steps=4)
    np.testing.assert_array_equal(original.q, loaded.q)
    assert original.events == loaded.events


def test_what_cannot_be_is_refused() -> None:
    m = incline(0.2, 0.0, coefficient=0.3, sticks=True)
    with pytest.raises(ModelError, match="give slip_speed or sticks=True, not both"):
        m.friction("more", "plane", 0.1, slip_speed=1e-3, sticks=True)
    with pytest.raises(ModelError, match="'rub' lets it stick: there is no linear motion"):
        m.linearise(at="start")
    for method in ("rattle", "symplectic"):
        with pytest.raises(ModelError, match="does not know the friction of joints"):
            m.simulate(0.1, method=method)
    with pytest.raises(ModelError, match="joints that stick"):
        m.simulate(0.1, formulation="independent")
    with pytest.raises(ModelError, match=r"no friction of a joint 'rab', did you mean 'rub'"):
        m.simulate(0.1).friction("rab")
