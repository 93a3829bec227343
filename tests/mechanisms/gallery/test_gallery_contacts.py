"""Mechanisms of the gallery that live from contact, against closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import cycle
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from mbsd.results.solution import Solution
from mechanisms.cam_follower import mechanism as cam
from mechanisms.cam_follower_angular import mechanism as angular
from mechanisms.cycloidal_drive import mechanism as cycloidal
from mechanisms.escapement import mechanism as escapement
from mechanisms.quarter_car import mechanism as car
from mechanisms.reflective_wall import mechanism as wall
from mechanisms.terrain_wheel import mechanism as terrain


def _folded(way: np.ndarray, low: float, high: float) -> np.ndarray:
    """Where a point is that is reflected at both ends: its straight way, folded (method of images)."""
    return high - np.abs(np.mod(way - low, 2 * (high - low)) - (high - low))


def test_reflected_ball_runs_straight_in_the_unfolded_room() -> None:
    p = wall.Params()
    sol = wall.build(p).simulate(wall.DURATION, 480, tolerance=1e-11)
    ball, fall = sol.body("ball"), math.sqrt(2 * p.height / p.gravity)
    x = _folded(p.start + wall.speed(p) * sol.t, p.radius, p.width - p.radius)
    since = np.mod(sol.t + fall, 2 * fall) - fall  # the last or next top of its way
    y = p.radius + p.height - p.gravity * since**2 / 2
    np.testing.assert_allclose(ball.x, x, atol=1e-10)
    np.testing.assert_allclose(ball.y, y, atol=1e-10)
    closed = p.rhythm[0] * 2 * fall
    assert closed == pytest.approx(wall.DURATION / 2)
    at = int(np.argmin(np.abs(sol.t - closed)))
    np.testing.assert_allclose([ball.x[at], ball.y[at]], [ball.x[0], ball.y[0]], atol=1e-9)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-12


def test_lossy_walls_take_their_part_of_the_speed_across() -> None:
    """It crosses ever more slowly: the k-th way takes e^-k of the first one's time; bounces take e^k of it."""
    p = wall.Params(**wall.VARIANTS["lossy"])
    sol = wall.build(p).simulate(wall.DURATION, 480, tolerance=1e-11)
    e, speed, room = p.restitution, wall.speed(p), p.width - 2 * p.radius
    hits = [event.time for event in sol.events if event.what == "impact" and event.name != "floor"]
    ways = np.array([p.width - p.radius - p.start] + [room] * (len(hits) - 1))
    np.testing.assert_allclose(hits, np.cumsum(ways / (speed * e ** np.arange(len(hits)))), rtol=1e-9)
    floor = [event.time for event in sol.events if event.what == "impact" and event.name == "floor"][:6]
    fall = math.sqrt(2 * p.height / p.gravity)
    np.testing.assert_allclose(np.diff(floor), 2 * fall * e ** np.arange(1, len(floor)), rtol=1e-9)
    lost = sum(event.energy or 0.0 for event in sol.events)
    assert sol.energy.total[-1] - sol.energy.total[0] == pytest.approx(lost, rel=1e-9)


def test_soft_floor_is_pressed_in_as_hertz_says() -> None:
    """Energy at the deepest point: k d^(n+1) / (n+1) = m g (h + d)."""
    p = wall.Params(**wall.VARIANTS["soft"])
    sol = wall.build(p).simulate(0.25, 5000, tolerance=1e-11)
    depth = p.radius - sol.body("ball").y.min()
    stored = p.stiffness * depth**2.5 / 2.5
    assert stored == pytest.approx(p.mass * p.gravity * (p.height + depth), rel=1e-3)


def test_wheel_that_rolls_keeps_its_energy_and_its_time() -> None:
    """From rest: (1 + k) v^2 / 2 = g (y_0 - y) of its centre, k = gyration^2; the time is the integral of ds / v."""
    p = terrain.Params()
    sol = terrain.build(p).simulate(terrain.DURATION, 480, tolerance=1e-10)
    wheel, k = sol.body("wheel"), p.gyration**2
    speed = np.hypot(wheel.vx, wheel.vy)
    y0 = terrain.first_place(p)[1]
    np.testing.assert_allclose(speed**2, 2 * p.gravity * (y0 - wheel.y) / (1 + k), atol=1e-5)
    np.testing.assert_allclose(np.abs(wheel.omega) * p.radius, speed, atol=1e-6)  # it does not slip

    # The way of the centre: the hills' parallel curve, by the place x where the wheel touches; v is 0 at its ends.
    def rate(angle: float) -> float:
        x = p.start * math.cos(angle)  # from the start to the same height on the other side; smooth at the ends
        s = terrain.slope(p, x)
        bend = 8 * p.hill / p.dales**2 * (3 * (2 * x / p.dales) ** 2 - 1) * 2
        y = float(terrain.height(p, np.array(x))) + p.radius / math.hypot(1, s)
        way = math.hypot(1, s) - p.radius * bend / (1 + s * s)
        return way * abs(p.start) * math.sin(angle) / math.sqrt(2 * p.gravity * max(y0 - y, 1e-300) / (1 + k))

    there = quad(rate, 1e-9, math.pi - 1e-9, limit=200)[0]
    first = float(np.interp(0.0, -wheel.vx[100:200], sol.t[100:200]))
    assert there == pytest.approx(first, rel=1e-5)
    assert 4 * there == pytest.approx(terrain.DURATION, abs=0.02)


def test_every_corner_of_the_planks_takes_its_part() -> None:
    """Angular momentum about the new place of contact: v+ / v- = (k + cos of the corner) / (1 + k)."""
    p = terrain.Params(**terrain.VARIANTS["polygonal"])
    sol = terrain.build(p).simulate(terrain.DURATION, 480, tolerance=1e-10, event_rows=True)
    wheel, k = sol.body("wheel"), p.gyration**2
    slopes = {f"plank{n + 1}": math.radians(angle) for n, (_, angle) in enumerate(p.planks)}
    at = "plank1"
    hits = [event for event in sol.events if event.what == "impact" and event.energy < -1e-9]
    assert len(hits) > 10
    for hit in hits:
        row = int(np.searchsorted(sol.t, hit.time))
        before, after = (math.hypot(wheel.vx[r], wheel.vy[r]) for r in (row, row + 1))
        corner = slopes[hit.name] - slopes[at]
        assert after / before == pytest.approx((k + math.cos(corner)) / (1 + k), rel=1e-6)
        at = hit.name


def test_dropped_wheel_is_spun_by_the_slope() -> None:
    """It sticks while it is hit: across v+ = -e v-, along v+ = v- / (1 + k), and it turns with what it has left."""
    p = terrain.Params(**terrain.VARIANTS["bouncing"])
    sol = terrain.build(p).simulate(0.3, 120, tolerance=1e-11, event_rows=True)
    wheel, k = sol.body("wheel"), p.gyration**2
    row = int(np.searchsorted(sol.t, sol.events[0].time))
    # Where it touches: the place of the hills nearest to its centre.
    x = np.linspace(p.start - p.radius, p.start + p.radius, 200001)
    nearest = x[np.argmin(np.hypot(x - wheel.x[row], terrain.height(p, x) - wheel.y[row]))]
    slope = math.atan(terrain.slope(p, float(nearest)))
    c, s = math.cos(slope), math.sin(slope)
    fall = -wheel.vy[row]
    along, across = -fall * s, -fall * c
    assert c * wheel.vx[row + 1] + s * wheel.vy[row + 1] == pytest.approx(along / (1 + k), rel=1e-4)
    assert c * wheel.vy[row + 1] - s * wheel.vx[row + 1] == pytest.approx(-p.restitution * across, rel=1e-4)
    assert -p.radius * wheel.omega[row + 1] == pytest.approx(along / (1 + k), rel=1e-4)
    lost = p.mass / 2 * ((1 - p.restitution**2) * across**2 + k / (1 + k) * along**2)
    assert sol.events[0].energy == pytest.approx(-lost, rel=1e-4)


def _valve(speed: float) -> tuple[cam.Params, Solution]:
    p = cam.Params(follower="valve", speed=speed)
    m = cam.build(p)
    m.bodies["cam"].mass, m.bodies["cam"].inertia = 0.3, 3e-4
    return p, m.simulate(4 * math.pi / speed, 1440, tolerance=1e-10, event_rows=True)


@pytest.mark.parametrize("part", [0.995, 1.005, 1.2])
def test_valve_floats_above_the_speed_at_which_its_spring_is_too_weak(part: float) -> None:
    """m (g + omega^2 s'') + k (preload + s) is the push: at the float speed its least value is zero."""
    critical = cam.float_speed(cam.Params())
    p, sol = _valve(part * critical)
    assert critical * 30 / math.pi == pytest.approx(1605.8, abs=0.1)  # rpm
    opens = [event.time for event in sol.events if event.what == "opens"]
    lift = cam.lift_law(p)
    turn = p.speed * sol.t
    if part < 1:
        assert not opens
        np.testing.assert_allclose(sol.body("follower").y - p.base - p.roller, lift(turn)[:, 0], atol=1e-7)
        return

    def push(angle: float) -> float:
        s, _, bend, _ = lift(np.array([angle]))[0]
        return p.stiffness * (p.preload + s) + p.valve * (p.gravity + p.speed**2 * bend)

    fine = np.linspace(0.0, p.rise, 2001)
    first = fine[int(np.argmax([push(angle) < 0 for angle in fine]))]
    assert p.speed * opens[0] == pytest.approx(brentq(push, first - 0.01, first), abs=1e-3)
    falls = sol.contact("contact").gap.max()
    assert falls > (1e-3 if part > 1.1 else 0.0)
    assert sol.contact("contact").gap.min() > -1e-9
    assert sum(event.energy for event in sol.events) < 0


def test_quarter_car_swings_and_hops_in_its_two_modes() -> None:
    """Undamped, from det(K - w^2 M) = 0 of body and wheel on strut and tyre; a car that stands rests in the start."""
    p = car.Params(damping=0.0, tyre_damping=0.0, speed=0.0)
    m = car.build(p)
    low, high = (mode.frequency for mode in m.modes() if 0.1 < mode.frequency < 100)  # the spin creeps
    mass = np.diag([p.sprung, p.unsprung + p.wheel])
    stiffness = np.array([[p.stiffness, -p.stiffness], [-p.stiffness, p.stiffness + p.tyre]])
    wanted = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)) / (2 * math.pi)
    np.testing.assert_allclose([low, high], wanted, rtol=1e-4)
    assert 1.0 < low < 2.0  # Hz, as of cars
    assert 8.0 < high < 15.0
    at_rest = m.simulate(0.5, 50).body("body").y
    np.testing.assert_allclose(at_rest, at_rest[0], atol=1e-9)


@pytest.mark.parametrize("variant", [{}, car.VARIANTS["worn"], {"speed": 5.0}])
def test_quarter_car_on_a_bump_is_the_oscillator_of_two_masses(variant: dict[str, float]) -> None:
    """Body and wheel by themselves: m_s y_s'' = -k s - c s', and the tyre at the next place of the road."""
    p = car.Params(**variant)
    profile, spring = car.road(p), car.sag(p)[0]
    x = np.linspace(0.0, p.before + p.bump[1] + 2.0, 4001)
    y = profile(x)[:, 0]

    def tyre(t: float, hub: float, rise: float) -> float:
        near = np.abs(x - p.speed * t) < p.radius
        away = np.hypot(x[near] - p.speed * t, y[near] - hub)
        k = int(np.argmin(away))
        up = (hub - y[near][k]) / away[k]  # of the normal
        sideways = math.sqrt(max(1 - up**2, 0.0)) * np.sign(p.speed * t - x[near][k])
        rate = -up * rise - sideways * p.speed
        return up * max(p.tyre * (p.radius - away[k]) + p.tyre_damping * rate, 0.0)

    def rates(t: float, state: np.ndarray) -> list[float]:
        body, hub, climb, rise = state
        strut = p.stiffness * (p.hub + spring - (body - hub)) - p.damping * (climb - rise)
        carried = p.unsprung + p.wheel
        return [climb, rise, strut / p.sprung - p.gravity, (tyre(t, hub, rise) - strut) / carried - p.gravity]

    sol = car.build(p).simulate(1.8 / p.speed, 180)
    body, hub = sol.body("body"), sol.body("wheel")
    start = [body.y[0], hub.y[0], 0.0, 0.0]
    wanted = solve_ivp(rates, (0.0, sol.t[-1]), start, t_eval=sol.t, rtol=1e-6, atol=1e-8, max_step=2e-3).y
    assert np.ptp(body.y) > 0.01
    np.testing.assert_allclose(body.y, wanted[0], atol=0.02 * np.ptp(body.y))
    np.testing.assert_allclose(hub.y, wanted[1], atol=0.02 * np.ptp(hub.y))


@pytest.mark.parametrize("variant", [{}, *angular.VARIANTS.values()])
def test_arm_on_a_cam_swings_as_its_law_says_and_is_never_pulled(variant: dict[str, Any]) -> None:
    """Modified sine (Norton, ch. 8): peaks 1.760 h / b omega and 5.528 h / b^2 omega^2; power."""
    p = angular.Params(**variant)
    sol = angular.build(p).sweep(steps=1440)
    arm, top = sol.body("arm"), math.radians(p.swing)
    assert np.ptp(arm.theta) == pytest.approx(top, rel=1e-9)
    assert -arm.omega.min() == pytest.approx(1.760 * top / p.rise * p.speed, rel=1e-3)
    assert arm.omega.max() == pytest.approx(1.760 * top / p.fall * p.speed, rel=1e-3)
    assert np.abs(arm.alpha).max() == pytest.approx(5.528 * top / min(p.rise, p.fall) ** 2 * p.speed**2, rel=1e-3)
    # Power of the motor: of the arm's inertia about its pivot, the spring from its place, and the weight.
    lift = angular.lift_law(p)(p.speed * sol.t)
    rest = sol.body("arm").theta[0]
    turn, rate, second = rest - lift[:, 0], -p.speed * lift[:, 1], -(p.speed**2) * lift[:, 2]
    tip = np.stack([p.pivot + p.tip * np.cos(turn), p.tip * np.sin(turn)], axis=1)
    moves = p.tip * rate[:, None] * np.stack([-np.sin(turn), np.cos(turn)], axis=1)
    way = tip - (tip[0] - [0.0, 0.09])
    length = np.hypot(*way.T)
    pulled = p.stiffness * (length - (0.09 - p.preload)) * (way * moves).sum(axis=1) / length
    power = p.mass * p.tip**2 / 3 * second * rate + pulled + p.mass * 9.80665 * moves[:, 1] / 2
    np.testing.assert_allclose(sol.driver("motor").torque * p.speed, power, atol=1e-6 * np.abs(power).max())
    assert sol.joint("contact").fy.min() > 0


def _beats(p: escapement.Params, duration: float) -> list[float]:
    """Times at which teeth drop on pallets: free fall of the wheel, free swing, free fall, an impact, a push."""
    far, pitch = p.far, 2 * math.pi / p.teeth
    inverse = np.array([1 / (p.bob * escapement.LENGTH**2 + 4e-4), 1 / 4e-5])  # of the inertias of pendulum and wheel
    pallets = [np.array([[z.real, z.imag] for z in escapement.pallet(p, side)[1:3]]) for side in (-1, 1)]
    t, y, hits = 0.0, np.array([math.radians(6), 0, math.radians(-90 + 180 / p.teeth * (p.between + 1)), 0]), []

    def accelerations(y: np.ndarray) -> np.ndarray:
        weight = -p.bob * 9.81 * escapement.LENGTH * math.sin(y[0])
        return inverse * np.array([weight - escapement.AIR * y[1], -p.torque])

    def tip(y: np.ndarray, tooth: float) -> np.ndarray:
        """Place of a tip in the pendulum's axes, and its changes by both angles."""
        c, s, w = math.cos(y[0]), math.sin(y[0]), y[2] + tooth
        place = np.array([[c, s], [-s, c]]) @ [p.radius * math.cos(w), far + p.radius * math.sin(w)]
        along = p.radius * np.array([-math.sin(w - y[0]), math.cos(w - y[0])])
        return np.array([place, [place[1], -place[0]], along])

    def run(forces: Callable[[np.ndarray], np.ndarray], guard: Callable[[np.ndarray], float]) -> None:
        nonlocal t, y

        def rate(_: float, y: np.ndarray) -> np.ndarray:
            a, w = forces(y)
            return np.array([y[1], a, y[3], w])

        def crossing(time: float, y: np.ndarray) -> float:
            return guard(y) if time > t + 1e-6 else start

        start = guard(y + 1e-6 * rate(t, y))
        crossing.terminal = True  # pyright: ignore[reportFunctionMemberAccess]
        found = solve_ivp(rate, (t, t + 5), y, rtol=1e-11, atol=1e-13, events=crossing, method="DOP853")
        t, y = found.t[-1], found.y[:, -1]

    def beat(first: np.ndarray, last: np.ndarray) -> None:
        """Go on to where a tooth drops on the pallet that locks at ``first``, and until it leaves it at ``last``."""
        tooth = min(pitch * np.arange(p.teeth), key=lambda angle: math.dist(tip(y, angle)[0], first))
        way = (last - first) / math.dist(last, first)
        normal = np.array([way[1], -way[0]])
        run(accelerations, lambda y: math.hypot(*tip(y, tooth)[0]) - math.hypot(*first))
        hits.append(t)
        y[3] = 0.0
        run(lambda y: accelerations(y) * [1, 0], lambda y: float(first @ tip(y, tooth)[1]))
        run(accelerations, lambda y: float(normal @ (tip(y, tooth)[0] - first)))
        across = tip(y, tooth)[1:] @ normal
        y[1::2] -= inverse * across * (across @ y[1::2]) / (across @ (inverse * across))

        def pushed(y: np.ndarray) -> np.ndarray:
            across, step = tip(y, tooth)[1:] @ normal, 1e-6 * np.array([y[1], 0, y[3], 0])
            bend = (tip(y + step, tooth) - tip(y - step, tooth))[1:] @ normal @ y[1::2] / 2e-6
            free = accelerations(y)
            return free - inverse * across * (across @ free + bend) / (across @ (inverse * across))

        run(pushed, lambda y: float(way @ (tip(y, tooth)[0] - last)))

    for pallet in cycle(pallets):
        if t > duration:
            return hits
        beat(*pallet)
    return hits


def test_escapement_keeps_the_time_of_its_own_equations() -> None:
    p = escapement.Params()
    sol = escapement.build(p).simulate(2.5, 50, tolerance=1e-9)
    drops = [event.time for event in sol.events if event.what == "closes"]
    np.testing.assert_allclose(drops[0::2], _beats(p, 2.5), atol=1e-7)


def test_cycloidal_drive_turns_its_disc_back_by_a_lobe_each_turn() -> None:
    """It lags by M / k sum r^2: half of its pins press, at levers r of e N sin(angle); arcs and pins make it uneven."""
    p = cycloidal.Params()
    sol = cycloidal.build(p).simulate(0.3, 30)
    lag = sol.body("disc").theta + sol.body("crank").theta / p.lobes
    brake = p.load * 2 * math.pi * p.rate / p.lobes
    stiffness = cycloidal.STIFFNESS * (p.crank * p.lobes) ** 2 * (p.lobes + 1) / 4
    assert lag[3:].mean() == pytest.approx(brake / stiffness, rel=0.2)
    assert np.abs(lag).max() < 2 * brake / stiffness
