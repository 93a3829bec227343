"""Shaking force, its orders and the centre of mass, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate

SPEED = 2 * math.pi * 10
R, ROD, PISTON = 0.04, 0.16, 0.5


def engine(speed: float = SPEED, start: float = 0.0, bank: float = 0.0) -> Mechanism:
    """A slider-crank whose piston alone has mass, its bore turned by ``bank`` (degrees) from the x axis."""
    m = Mechanism("single")
    crank, rod, piston = m.bar("crank", R), m.bar("rod", ROD), m.body("piston", mass=PISTON)
    m.revolute("main", m.ground.at(0, 0), crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston.origin)
    m.prismatic("bore", m.ground.at(0, 0, math.radians(bank)), piston.origin)
    m.drive_angle("motor", crank, constant_rate(speed, start))
    lean = math.degrees(math.asin(R / ROD * math.sin(math.radians(bank) - start)))
    m.start_near(crank=math.degrees(start), rod=bank + lean)
    return m


def piston_harmonic(order: int) -> float:
    """A_n of r w^2 for lambda 1/4: -1/2 of the curvature of the exact stroke, by the trapezoidal rule over a turn."""
    phi = np.linspace(0, 2 * math.pi, 4096, endpoint=False)
    stroke = np.cos(phi) + np.sqrt((ROD / R) ** 2 - np.sin(phi) ** 2)
    return float(2 * np.mean(stroke * np.cos(order * phi)) * order**2)


def test_orders_of_a_piston_are_the_exact_harmonics() -> None:
    first = PISTON * R * SPEED**2
    got = engine().sweep(steps=360).orders(engine().sweep(steps=360).shaking().force)
    assert (got.crank, got.turns) == ("crank", 1)
    for order in (1, 2, 4, 6):
        row = got.index(order)
        assert got.amplitude[row, 0] == pytest.approx(abs(piston_harmonic(order)) * first, abs=1e-9 * first)
        assert abs(got.forward[row]) == pytest.approx(abs(got.backward[row]), abs=1e-9 * first)
    assert got.amplitude[got.index(3)] == pytest.approx(0.0, abs=1e-9 * first)
    assert got.gap < 1e-9


@pytest.mark.parametrize("speed", [SPEED, -SPEED])
@pytest.mark.parametrize("start", [0.0, 1.0])
def test_phases_count_from_the_cranks_angle(speed: float, start: float) -> None:
    sol = engine(speed, start, bank=30).sweep(steps=400)
    got = sol.orders(sol.shaking().force)
    along = np.exp(1j * math.radians(30))
    for order in (1, 2):
        size = 0.5 * piston_harmonic(order) * PISTON * R * SPEED**2
        turn = np.exp(1j * order * math.radians(30))
        assert got.forward[got.index(order)] == pytest.approx(size * along / turn, abs=1e-6 * size)
        assert got.backward[got.index(order)] == pytest.approx(size * along * turn, abs=1e-6 * size)
    again = sol.orders(sol.shaking().fx)
    rebuilt = again.mean + sum(
        size * np.cos(k * sol.body("crank").theta + phase)
        for k, size, phase in zip(again.order, again.amplitude, again.phase, strict=True)
    )
    assert rebuilt == pytest.approx(sol.shaking().fx, abs=1e-6 * np.abs(sol.shaking().fx).max())


def test_uneven_rows_give_the_same_orders() -> None:
    times = np.sort(np.concatenate([np.linspace(0, 0.25, 901), np.random.default_rng(1).uniform(0, 0.25, 50)]))
    even, uneven = engine().sweep(steps=360), engine().sweep(times=times)
    first, second = (sol.orders(sol.shaking().force) for sol in (even, uneven))
    assert second.turns == 1
    assert second.amplitude[:6] == pytest.approx(first.amplitude[:6], abs=1e-6 * first.amplitude.max())


def test_a_cycle_of_two_turns_has_half_orders() -> None:
    sol = engine().sweep(duration=0.4, steps=1440)
    phi = sol.body("crank").theta
    got = sol.orders(3.0 + 2.0 * np.cos(0.5 * phi + 0.3) + np.cos(2 * phi))
    assert (got.turns, float(got.mean)) == (2, pytest.approx(3.0))
    assert got.amplitude[got.index(0.5)] == pytest.approx(2.0)
    assert got.phase[got.index(0.5)] == pytest.approx(0.3)
    assert got.amplitude[got.index(2)] == pytest.approx(1.0)


def test_motions_without_a_period_are_reported() -> None:
    sol = engine().sweep(duration=0.3, steps=1080)
    assert sol.orders(sol.t).gap == pytest.approx(1 / 3)


def test_shaking_is_what_the_frame_feels_without_weight() -> None:
    m = engine(bank=20)
    m.change("crank", mass=1.3, com=(0.01, 0.004), inertia=2e-3)
    m.change("rod", mass=0.4, com=(0.05, 0.0), inertia=1e-3)
    m.gravity = None
    sol = m.sweep(steps=90)
    shaken, main, bore = sol.shaking(), sol.joint("main"), sol.joint("bore")
    assert shaken.force == pytest.approx(-(main.reaction + bore.reaction), abs=1e-9)
    x, y = bore.x, bore.y
    about_origin = -(x * bore.fy - y * bore.fx + bore.torque) - sol.driver("motor").torque
    assert shaken.moment == pytest.approx(about_origin, abs=1e-9)
    moved = sol.shaking(about=(0.1, -0.2))
    assert moved.moment == pytest.approx(shaken.moment - (0.1 * shaken.fy + 0.2 * shaken.fx), abs=1e-9)
    total = 1.3 + 0.4 + PISTON
    centre = sol.centre_of_mass()
    assert -total * np.stack([centre.ax, centre.ay], axis=1) == pytest.approx(shaken.force, abs=1e-9)


def test_bad_requests_are_refused_by_name() -> None:
    m = engine()
    sol = m.sweep(steps=36)
    short = m.sweep(duration=0.02, steps=36)
    with pytest.raises(ModelError, match="single: orders need a crank"):
        short.orders(short.t)
    with pytest.raises(ModelError, match=r"makes 0\.2 turns"):
        short.orders(short.t, crank="crank")
    with pytest.raises(ModelError, match="makes 1 turns, and a cycle has 2"):
        sol.orders(sol.t, turns=2)
    with pytest.raises(ModelError, match="turns back"):
        sol.orders(sol.t, crank="rod")
    with pytest.raises(ModelError, match=r"shape \(3,\)"):
        sol.orders(np.zeros(3))
    with pytest.raises(ModelError, match=r"no order 0\.5"):
        sol.orders(sol.t).index(0.5)
    with pytest.raises(ModelError, match="about"):
        sol.shaking(about=(1.0,))  # pyright: ignore[reportArgumentType]
    pendulum = Mechanism("massless")
    rod = pendulum.bar("rod", 1.0)
    pendulum.revolute("A", pendulum.ground.at(0, 0), rod.start)
    pendulum.drive_angle("motor", rod, constant_rate(1.0))
    with pytest.raises(ModelError, match="massless: no body has mass"):
        pendulum.sweep(steps=4).centre_of_mass()
