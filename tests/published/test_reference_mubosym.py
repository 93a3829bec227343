"""Runs of mubosym: point masses on rods, damped in the air, against its numbers and against the exact motion.

mubosym integrates with a tolerance of 1e-5 and holds loops by stiff springs, so its final states are off by up to 1e-2
where the motion is regular and wrong by more where it is not. The exact motion is integrated here from the equations in
the rods' own angles (Lagrange) to 1e-12.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import odeint, quad, solve_ivp
from scipy.optimize import brentq

from mbsd import Mechanism
from mbsd.mechanism import Body, Marker
from tests.published.test_reference_dynamics import case, simulate_at

G = 9.81
Equations = Callable[[float, np.ndarray], np.ndarray]


def published(number: str) -> np.ndarray:
    """The final state of a test: angles or places, then their rates."""
    tests = case("mubosym_test_all_reference_states")["expected"]
    return np.array(next(test for test in tests if test["test"].startswith(f"{number} "))["final"])


def in_air(m: Mechanism, body: Body, damping: float) -> None:
    """A drag of ``damping`` (N s/m) on the body's centre of mass."""
    m.bushing(f"air on {body.name}", m.ground.origin, body.origin, (0, 0, 0), damping=(damping, damping, 0))


def rod(m: Mechanism, name: str, top: Marker, length: float, damping: float, inertia: float = 0.0) -> Body:
    """1 kg at the lower end of a rod that hangs from ``top``; its angle is zero when it hangs down."""
    body = m.body(name, 1.0, inertia=inertia)
    m.revolute(f"{name} pin", top, body.at(0, length))
    in_air(m, body, damping)
    return body


def rods(lengths: tuple[float, ...], damping: float, inertia: float = 0.0, lift: float | None = None) -> Equations:
    """(q', q'') of rods by their absolute angles q; with ``lift`` they hang from 1 kg on the y axis, which is q[0].

    ``lift`` is the stiffness of the spring that holds this mass at y = 0. With it the walls of mubosym's test 3 stand
    at x = 0.5, for the ends of both rods.
    """
    count, extra = len(lengths), int(lift is not None)

    def rates(_t: float, state: np.ndarray) -> np.ndarray:
        q, v = np.split(state, 2)
        sin, cos = np.sin(q[extra:]), np.cos(q[extra:])
        mass, load = np.zeros((count + extra, count + extra)), np.zeros(count + extra)
        jacobian, place, bias = np.zeros((2, count + extra)), np.zeros(2), np.zeros(2)
        if lift is not None:
            jacobian[1, 0], place[1], mass[0, 0] = 1.0, q[0], 1.0
            load[0] = -G - damping * v[0] - lift * q[0]
        for k, length in enumerate(lengths):
            jacobian[:, extra + k] = length * cos[k], length * sin[k]
            place = place + length * np.array([sin[k], -cos[k]])
            bias = bias + length * v[extra + k] ** 2 * np.array([-sin[k], cos[k]])
            speed = jacobian @ v
            force = np.array([0.0, -G]) - damping * speed
            if lift is not None and place[0] < 0.5:
                force[0] -= 2 * (1000.0 * (place[0] - 0.5) + 0.2 * speed[0])
            mass += jacobian.T @ jacobian
            mass[extra + k, extra + k] += inertia
            load += jacobian.T @ (force - bias)
        return np.concatenate([v, np.linalg.solve(mass, load)])

    return rates


def exact(rates: Equations, start: np.ndarray, end: float) -> np.ndarray:
    return solve_ivp(rates, (0.0, end), start, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]


def test_crank_slider() -> None:
    """No load does work: the speed at each crank angle follows from the energy, and the time from its integral."""
    stored = published("1")
    first, speed = -14.75044927, 5.4077404

    def conrod(crank: float) -> float:
        return math.acos(-math.cos(crank) / 3)

    def kinetic(crank: float) -> float:
        """At unit crank speed: 1 kg at the crank pin and 1 kg at the slider."""
        swing = conrod(crank)
        slider = math.cos(crank) - math.cos(swing) * math.sin(crank) / math.sin(swing)
        return (1 + slider**2) / 2

    energy = speed**2 * kinetic(first)

    def time_to(crank: float) -> float:
        turns, rest = divmod(crank - first, 2 * math.pi)
        whole, part = (
            quad(lambda a: math.sqrt(kinetic(a) / energy), first, first + angle, epsabs=1e-12, epsrel=1e-12, limit=200)[
                0
            ]
            for angle in (2 * math.pi, rest)
        )
        return turns * whole + part

    crank = float(brentq(lambda angle: time_to(angle) - 15.0, 57.0, 57.6, xtol=1e-12))
    rate = math.sqrt(energy / kinetic(crank))
    swing = conrod(crank)
    answer = np.array([crank, swing, rate, -math.sin(crank) * rate / (3 * math.sin(swing))])

    m = Mechanism("mubosym 1", gravity=None)
    pin = rod(m, "crank", m.ground.origin, 1.0, 0.0)
    link, slider = m.body("conrod"), m.body("slider", 1.0)
    m.revolute("big end", pin.origin, link.at(0, 3.0))
    m.revolute("wrist", link.origin, slider.origin)
    m.prismatic("rail", m.ground.origin, slider.origin)
    start = conrod(first)
    m.start_near(crank=math.degrees(first), conrod=math.degrees(start))
    m.start_near(slider=(math.sin(first) + 3 * math.sin(start), 0, 0))
    m.start_moving(crank=speed)
    sol = simulate_at(m, np.array([0.0, 15.0]), tolerance=1e-11)
    views = sol.body("crank"), sol.body("conrod")
    computed = np.array([view.theta[-1] for view in views] + [view.omega[-1] for view in views])
    np.testing.assert_allclose(computed, answer, atol=1e-7)
    np.testing.assert_allclose(stored, answer, atol=5e-3)


def test_swing_table() -> None:
    """A parallelogram keeps its table level: both swings are one damped pendulum. mubosym's table tilts by 3e-4."""
    stored, damping = published("2"), 0.1
    start = np.cumsum([-13.73437514, 15.30494211, -5.87985813])
    theta, omega = exact(rods((1.0,), damping), np.array([start[0], 0.81904538]), 20.0)
    absolute = np.array([theta, math.pi / 2, theta + 3 * math.pi]), np.array([omega, 0.0, omega])
    answer = np.concatenate([np.diff(values, prepend=0.0) for values in absolute])
    m = Mechanism("mubosym 2", gravity=(0.0, -G))
    left = rod(m, "left", m.ground.origin, 1.0, damping)
    table = rod(m, "table", left.origin, 1.5, damping)
    right = rod(m, "right", table.origin, 1.0, damping)
    m.revolute("end", m.ground.at(1.5, 0), right.origin)
    m.start_near(left=math.degrees(start[0]), table=math.degrees(start[1]), right=math.degrees(start[2]))
    m.start_moving(left=0.81904538)
    sol = simulate_at(m, np.array([0.0, 20.0]), tolerance=1e-11)
    views = [sol.body(name) for name in ("left", "table", "right")]
    ends = [view.theta[-1] for view in views], [view.omega[-1] for view in views]
    computed = np.concatenate([np.diff(values, prepend=0.0) for values in ends])
    np.testing.assert_allclose(computed, answer, atol=1e-7)
    np.testing.assert_allclose(stored, answer, atol=7e-3)


def test_rods_between_walls_as_long_as_the_motion_can_be_known() -> None:
    """An error of 1e-10 grows to 1e-6 within 8 s and to everything before 30 s, where mubosym's state is stored."""
    end = 4.0
    m = Mechanism("mubosym 3", gravity=(0.0, -G))
    hanger = m.body("hanger", 1.0, inertia=1.0)
    m.prismatic("mast", m.ground.at(0, 0, math.pi / 2), hanger.at(0, 0, math.pi / 2))
    m.spring("spring", m.ground.origin, hanger.origin, 100.0)
    in_air(m, hanger, 0.1)
    upper = rod(m, "upper", hanger.origin, 1.5, 0.1, inertia=1.0)
    lower = rod(m, "lower", upper.origin, 1.5, 0.1, inertia=1.0)

    def wall(_t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
        return (-2 * (1000.0 * (q[0] - 0.5) + 0.2 * v[0]) if q[0] < 0.5 else 0.0), 0.0, 0.0

    m.user_force("wall on upper", wall, upper)
    m.user_force("wall on lower", wall, lower)
    m.start_near(hanger=(0.0, 1.0, 0.0), upper=math.degrees(1.0), lower=math.degrees(2.0))
    sol = simulate_at(m, np.array([0.0, end]), tolerance=1e-10)
    views = [sol.body(name) for name in ("hanger", "upper", "lower")]
    computed = [views[0].y[-1], *(view.theta[-1] for view in views[1:])]
    computed += [views[0].vy[-1], *(view.omega[-1] for view in views[1:])]
    start = np.array([1.0, 1.0, 2.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(computed, exact(rods((1.5, 1.5), 0.1, 1.0, lift=100.0), start, end), atol=1e-5)


def test_pendulum_on_a_moving_pivot() -> None:
    """Four turns about the pivot before mubosym's state is stored, which its tolerance has moved by 0.05 rad/s."""
    stored = published("9")
    length, damping = 1.5, 0.05

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        angle, omega = state
        pivot, pushed = 5.0 * math.cos(2.5 * t), -12.5 * math.sin(2.5 * t)
        pull = -(pushed + damping * pivot) * math.cos(angle) - G * math.sin(angle)
        return np.array([omega, pull / length - damping * omega])

    answer = exact(rates, np.zeros(2), 20.0)
    m = Mechanism("mubosym 9", gravity=(0.0, -G))
    cart = m.body("cart")
    m.prismatic("rail", m.ground.origin, cart.origin)
    m.drive_coordinate("push", m.ground.origin, cart.origin, lambda t: 2.0 * math.sin(2.5 * t))
    rod(m, "rod", cart.origin, length, damping)
    m.start_near(cart=(0, 0, 0), rod=0)
    m.start_moving(cart=(5.0, 0, 0), rod=0.0)
    view = simulate_at(m, np.array([0.0, 20.0]), tolerance=1e-11).body("rod")
    np.testing.assert_allclose([view.theta[-1], view.omega[-1]], answer, atol=1e-5)
    np.testing.assert_allclose(stored, answer, atol=0.06)


def test_chain_of_six() -> None:
    """All rods start at 4 rad/s; five of six go over the top. With mubosym's integrator its numbers come out too."""
    stored, damping, end = published("12"), 0.4, 20.0
    equations, start = rods((1.0,) * 6, damping), np.concatenate([np.zeros(6), np.full(6, 4.0)])
    answer = exact(equations, start, end)
    times = np.linspace(0.0, end, 2000)
    settings = {"atol": 1e-5, "rtol": 1e-5, "hmax": 0.1, "hmin": 1e-7, "mxords": 4, "mxordn": 8}
    theirs = odeint(equations, start, times, tfirst=True, **settings)[-1]
    np.testing.assert_allclose(theirs, stored, atol=1e-3)
    m = Mechanism("mubosym 12", gravity=(0.0, -G))
    top, names = m.ground.origin, [f"rod{k}" for k in range(6)]
    for name in names:
        top = rod(m, name, top, 1.0, damping).origin
    m.start_near(**dict.fromkeys(names, 0.0))
    m.start_moving(**dict.fromkeys(names, 4.0))
    sol = simulate_at(m, np.array([0.0, end]), tolerance=1e-11)
    views = [sol.body(name) for name in names]
    computed = [view.theta[-1] for view in views] + [view.omega[-1] for view in views]
    np.testing.assert_allclose(computed, answer, atol=1e-5)
    assert [round(angle / (2 * math.pi)) for angle in stored[:6]] == [0, 1, 1, 1, 1, 1]
    np.testing.assert_allclose(stored[:6], answer[:6], atol=0.1)
