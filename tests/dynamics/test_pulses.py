"""Short pulses in laws and functions of time: found wherever they are, met as they are, or told."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, cycloidal, function, table
from mbsd.arrays.laws import pack_laws
from mbsd.base.errors import ModelWarning
from mbsd.equations.laws import tabulate_law
from mbsd.model.laws.fitting.sampling import FORCE_LOOKS, LOOKS

MASS = 2.0


class Counted:
    """A function that counts its calls."""

    def __init__(self, f: Callable[[float], float]) -> None:
        self.f, self.calls = f, 0

    def __call__(self, t: float) -> float:
        self.calls += 1
        return self.f(t)


def _rectangle(begin: float, width: float) -> Callable[[float], float]:
    return lambda t: 1000.0 if begin <= t < begin + width else 0.0


def _half_sine(begin: float, width: float) -> Callable[[float], float]:
    return lambda t: 1000.0 * math.sin(math.pi * (t - begin) / width) if begin <= t < begin + width else 0.0


def _bell(middle: float, width: float) -> Callable[[float], float]:
    return lambda t: 1000.0 * math.exp(-(((t - middle) / width) ** 2))


def _triangle(middle: float, width: float) -> Callable[[float], float]:
    return lambda t: max(0.0, 1000.0 * (1.0 - abs(t - middle) / width))


PULSES = {
    "10 ms in 10 s": (10.0, _rectangle(3.1, 0.01), 10.0),
    "2 ms in 1 s": (1.0, _rectangle(0.4137, 0.002), 2.0),
    "5 ms in 1 s": (1.0, _rectangle(0.6003, 0.005), 5.0),
    "1 ms at the begin": (1.0, _rectangle(0.0, 0.001), 1.0),
    "1 ms near the end": (1.0, _rectangle(0.9985, 0.001), 1.0),
    "half sine of 2 ms": (1.0, _half_sine(0.4137, 0.002), 4.0 / math.pi),
    "bell of 1 ms": (1.0, _bell(0.3, 5e-4), 0.5 * math.sqrt(math.pi)),
    "triangle of 2 ms": (1.0, _triangle(0.71, 0.001), 1.0),
    "two rectangles": (1.0, lambda t: _rectangle(0.2, 0.001)(t) - _rectangle(0.2015, 0.003)(t), -2.0),
}
"""Duration (s), force (N) and its impulse (N s)."""


def _cart(kind: str, f: Callable[[float], float], sign: float = 1.0) -> Mechanism:
    m = Mechanism("cart", gravity=None)
    cart = m.body("cart", MASS, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    if kind == "force":
        m.force("push", cart.origin, f, direction=(sign, 0.0))
    elif kind == "user force":
        m.user_force("push", lambda t, q, v: (sign * f(t), 0.0, 0.0), cart)
    else:
        m.spring("push", m.ground.at(-3.0 * sign, 0), cart.origin, 1e6, free_length=lambda t: 3.0 + 1e-6 * f(t))
    return m


@pytest.mark.parametrize("kind", ["force", "user force"])
@pytest.mark.parametrize("pulse", PULSES)
def test_an_impulse_comes_out_to_the_tolerance(pulse: str, kind: str) -> None:
    duration, f, impulse = PULSES[pulse]
    sol = _cart(kind, f).simulate(duration, steps=30)
    assert MASS * sol.body("cart").vx[-1] == pytest.approx(impulse, rel=2e-8)


@pytest.mark.parametrize(
    ("method", "options", "allowed"),
    [
        ("rk4", {"step": 1e-3}, 1e-12),
        ("radau", {}, 1e-12),
        ("scipy-dop853", {}, 1e-9),
        ("rattle", {"step": 1e-3}, 1e-12),
    ],
)
def test_every_kind_of_integrator_steps_onto_jumps(method: str, options: dict, allowed: float) -> None:
    duration, f, impulse = PULSES["2 ms in 1 s"]
    sol = _cart("force", f).simulate(duration, steps=30, method=method, **options)
    assert MASS * sol.body("cart").vx[-1] == pytest.approx(impulse, rel=allowed)


def test_with_events_and_between_outputs_a_pulse_is_the_same() -> None:
    duration, f, impulse = PULSES["2 ms in 1 s"]
    plain, watched = _cart("force", f), _cart("force", f)
    watched.event("half way", lambda t, s: s.body("cart").x - 0.25)
    a, b = plain.simulate(duration, steps=10, formulation="reference"), watched.simulate(duration, steps=10)
    at = np.array([0.413, 0.4137, 0.4147, 0.4157, 0.5])
    expected = np.array([0.0, 0.0, impulse / 2, impulse, impulse]) / MASS
    for sol in (a, b):
        np.testing.assert_allclose(sol.at(at).body("cart").vx, expected, atol=1e-11)
    assert [event.name for event in b.events] == ["half way"]
    assert b.events[0].time == pytest.approx(0.4147 + 0.25 / (impulse / MASS), rel=1e-9)


def test_joint_that_sticks_slides_at_the_jump_of_its_load() -> None:
    m = Mechanism("box")
    box = m.body("box", MASS, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), box.origin)
    m.friction("grip", "rail", 0.5, length=1.0, sticks=True)
    m.force("push", box.origin, _rectangle(0.4137, 0.002))
    sol = m.simulate(1.0, steps=20)
    friction = 0.5 * MASS * 9.80665
    fastest = (1000.0 - friction) * 0.002 / MASS
    np.testing.assert_allclose(sol.at(np.array([0.4157])).body("box").vx, fastest, rtol=1e-9)
    assert [event.name for event in sol.events] == ["grip"] * 3  # at rest from the start, then it slides and stops
    assert sol.events[1].time == pytest.approx(0.4137, abs=1e-12)
    assert sol.events[-1].time == pytest.approx(0.4157 + fastest / (0.5 * 9.80665), rel=1e-9)


def _bump(t: float, begin: float = 0.4137, width: float = 0.002) -> float:
    return 0.01 * (1 - math.cos(2 * math.pi * (t - begin) / width)) / 2 if begin < t < begin + width else 0.0


def _bump_bend(t: float, begin: float = 0.4137, width: float = 0.002) -> float:
    rate = 2 * math.pi / width
    return 0.005 * rate**2 * math.cos(rate * (t - begin)) if begin < t < begin + width else 0.0


@pytest.mark.parametrize("base", [0.0, 2 * math.pi])
def test_a_driver_follows_a_short_bump(base: float) -> None:
    m = Mechanism("shaker", gravity=None)
    arm = m.bar("arm", 0.3, mass=1.0)
    m.revolute("pivot", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, lambda t: base * t + _bump(t))
    t = np.sort(np.append(np.linspace(0.0, 1.0, 41), np.linspace(0.41301, 0.41629, 60)))
    inside = np.array([_bump_bend(time) for time in t])
    for sol in (m.sweep(times=t), m.simulate(None, times=t)):
        np.testing.assert_allclose(sol.body("arm").alpha, inside, atol=1e-6 * 49348)
        np.testing.assert_allclose(sol.body("arm").theta, base * t + [_bump(time) for time in t], atol=1e-9)


def test_a_driven_pulse_moves_what_hangs_on_it() -> None:
    """A cart carries a pendulum through a cycloidal rise of 2 ms, which no step may pass over."""
    ends = []
    for steps in (None, 2e-4):
        m = Mechanism("crane")
        cart, rod = m.body("cart", 1.0, inertia=1.0), m.bar("rod", 0.5, mass=1.0)
        m.prismatic("rail", m.ground.at(0, 0), cart.origin)
        m.revolute("hook", cart.origin, rod.start)
        m.drive_coordinate("winch", m.ground.at(0, 0), cart.origin, cycloidal(0.01, 0.002, begin=0.4137))
        m.start_near(rod=-90)
        ends.append(m.simulate(1.0, steps=10 if steps is None else 5000, tolerance=1e-9).body("rod").theta[-1])
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)
    assert abs(ends[0] + math.pi / 2) > 1e-3


def test_a_table_with_a_pulse_between_wide_steps() -> None:
    t = np.linspace(0.0, 10.0, 20_001)
    m = _cart("force", table(t, 100.0 * np.exp(-(((t - 3.3) / 0.004) ** 2))))  # pyright: ignore[reportArgumentType]
    sol = m.simulate(10.0, steps=10)
    assert MASS * sol.body("cart").vx[-1] == pytest.approx(0.4 * math.sqrt(math.pi), rel=1e-7)


# -- what it costs ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("f", [lambda t: 2 * math.pi * t, lambda t: 0.7, math.sin, lambda t: t**3])
def test_smooth_laws_take_few_calls_beside_the_look(f: Callable[[float], float]) -> None:
    driver, load = Counted(f), Counted(f)
    function(driver).over(0.0, 1.0)
    function(load).as_load(0.0, 1.0)
    assert driver.calls <= LOOKS + 257
    assert load.calls <= LOOKS + 129
    known = Counted(f)
    function(known, shortest=0.5).over(0.0, 1.0)
    assert known.calls <= 386  # no more than a fit without any look


def test_exact_derivatives_without_acceleration_are_few_pieces() -> None:
    calls = [Counted(lambda t: 2 * math.pi * t), Counted(lambda t: 2 * math.pi), Counted(lambda t: 0.0)]
    law = function(*calls).compiled(0.0, 10.0)
    assert sum(call.calls for call in calls) <= 3 * LOOKS + 99
    assert law[1][0] <= 16
    out, t = np.zeros((1000, 3)), np.linspace(0.0, 10.0, 1000)
    tabulate_law(pack_laws([law]), 1, t, out)
    np.testing.assert_allclose(out[:, 0], 2 * math.pi * t, rtol=1e-15)
    np.testing.assert_allclose(out[:, 1:], [[2 * math.pi, 0.0]] * 1000, rtol=1e-15)


def test_a_user_force_is_looked_at_once() -> None:
    calls = []

    def drag(t, q, v):
        calls.append(t)
        return -v[0], 0.0, 0.0

    m = Mechanism("cart", gravity=None)
    cart = m.body("cart", MASS, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.user_force("drag", drag, cart)
    m.start_moving(cart=(1.0, 0.0, 0.0))
    steps = m.simulate(1.0, steps=10).stats.steps
    assert len(calls) < FORCE_LOOKS + 30 * steps + 60


# -- what is given, refused and told ----------------------------------------------------------------------------


def test_shortest_finds_what_is_shorter_than_the_look() -> None:
    f = _rectangle(0.51234567, 2e-5)
    m = _cart("force", function(f, shortest=2e-5))  # pyright: ignore[reportArgumentType]
    assert MASS * m.simulate(1.0).body("cart").vx[-1] == pytest.approx(0.02, rel=1e-9)
    m = _cart("force", function(f, breaks=[0.51234567, 0.51236567]))  # pyright: ignore[reportArgumentType]
    assert MASS * m.simulate(1.0).body("cart").vx[-1] == pytest.approx(0.02, rel=1e-6)


def test_shortest_of_a_user_force_bounds_steps_where_pulses_depend_on_the_motion() -> None:
    def kick(t, q, v):
        return (100.0 * math.exp(-(((q[0] - 0.6) / 0.002) ** 2)), 0.0, 0.0)

    m = Mechanism("cart", gravity=None)
    cart = m.body("cart", MASS, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.user_force("kick", kick, cart, shortest=0.002)
    m.start_moving(cart=(1.0, 0.0, 0.0))
    work = 100.0 * 0.002 * math.sqrt(math.pi)
    sol = m.simulate(1.0, steps=10)
    assert sol.body("cart").vx[-1] == pytest.approx(math.sqrt(1.0 + 2 * work / MASS), rel=1e-7)


def test_a_jump_of_a_user_force_that_is_given_is_stepped_onto() -> None:
    f = _rectangle(0.5, 1e-4)
    m = Mechanism("cart", gravity=None)
    cart = m.body("cart", MASS, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.user_force("push", lambda t, q, v: (f(t) * (v[0] >= 0.0), 0.0, 0.0), cart, breaks=[0.5, 0.5001])
    assert MASS * m.simulate(1.0).body("cart").vx[-1] == pytest.approx(0.1, rel=1e-8)


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (_rectangle(0.4137, 0.002), r"cart: driver 'motor': function: the law jumps by 1000 at t = 0\.4137"),
        (_half_sine(0.4137, 0.002), r"driver 'motor'.* its rate jumps by 1\.\d+e\+06 at t = 0\.4137"),
        (lambda t: abs(t - 0.5), r"driver 'motor'.* its rate jumps by 2 at t = 0\.5 s"),
        (lambda t: float(np.float32(math.sin(t))), r"driver 'motor'.* scatters by .*recorded"),
    ],
)
def test_a_driver_refuses_infinite_accelerations_with_time_and_remedy(law: Callable, says: str) -> None:
    m = Mechanism("cart")
    cart = m.body("cart", MASS, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0), cart.origin)
    m.drive_coordinate("motor", m.ground.at(0, 0), cart.origin, law)
    for solve in (m.sweep, m.simulate):
        with pytest.raises(ModelError, match=says):
            solve(1.0)


@pytest.mark.parametrize(
    ("laws", "says"),
    [
        ((math.sin, lambda t: 2 * math.cos(t), lambda t: -math.sin(t)), "df is not the derivative of f"),
        ((math.sin, math.cos, math.sin), "ddf is not the derivative of df"),
        ((lambda t: abs(t - 0.3), lambda t: math.copysign(1, t - 0.3), lambda t: 0.0), "rate jumps by 2 at t = 0.3"),
    ],
)
def test_derivatives_that_are_none_are_refused(laws: tuple, says: str) -> None:
    calls = [Counted(law) for law in laws]
    with pytest.raises(ModelError, match=says):
        function(*calls).compiled(0.0, 1.0)
    assert sum(call.calls for call in calls) < 3 * LOOKS + 1000


def test_a_jump_of_acceleration_is_found() -> None:
    """Full throttle, then full brake: f'' jumps at 0.377 s."""

    def f(t: float) -> float:
        return t * t / 2 if t < 0.377 else 0.377 * t - 0.377**2 / 2 - (t - 0.377) ** 2 / 2

    t = np.sort(np.append(np.linspace(0.0, 1.0, 100), 0.377 + np.array([-1e-6, 1e-6])))
    np.testing.assert_allclose(function(f).over(0.0, 1.0)(t)[:, 2], np.where(t < 0.377, 1.0, -1.0), atol=1e-8)


def test_what_cannot_be_resolved_is_told() -> None:
    random = np.random.default_rng(1)
    m = _cart("force", lambda t: float(random.standard_normal()))
    with pytest.warns(ModelWarning, match=r"cart: force 'push': force: .* is missed near t = .*breaks=.*shortest="):
        m.simulate(0.01, steps=2, tolerance=1e-2, method="rk4", step=1e-3)
    m = _cart("user force", lambda t: math.sin(1e6 * t))
    with pytest.warns(ModelWarning, match=r"cart: force 'push' changes with time too often"):
        m.simulate(1.0, steps=2, method="rk4", step=1e-2)


def test_nothing_is_told_of_a_smooth_law() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _cart("force", lambda t: math.exp(-t) * math.sin(30 * t)).simulate(1.0, steps=5)


@pytest.mark.parametrize(
    ("given", "says"),
    [({"breaks": ["soon"]}, "breaks is"), ({"breaks": [math.nan]}, "breaks is"), ({"shortest": 0}, "shortest is 0")],
)
def test_bad_breaks_are_refused(given: dict, says: str) -> None:
    with pytest.raises(ModelError, match=f"function: {says}"):
        function(math.sin, **given)
    m = Mechanism("cart")
    with pytest.raises(ModelError, match=f"cart: force 'push': {says}"):
        m.user_force("push", lambda t, q, v: (0.0, 0.0, 0.0), m.body("cart", 1.0), **given)
