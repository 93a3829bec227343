"""Counterweights, balance shafts and flywheels, against closed forms and the solver itself."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import BalanceShaft, Counterweight, Mechanism, ModelError, Solution, balance, constant_rate, flywheel
from mbsd.machines.engines.engine import engine

A2, A3, A4, GROUND = 0.05, 0.2, 0.15, 0.2


def four_bar(coupler_com: tuple[float, float] = (0.09, 0.02)) -> Mechanism:
    m = Mechanism("four-bar")
    crank = m.bar("crank", A2, mass=0.2, com=(0.0, 0.0), inertia=1e-4)
    coupler = m.bar("coupler", A3, mass=0.5, com=coupler_com, inertia=2e-3)
    rocker = m.bar("rocker", A4, mass=0.3, com=(0.0, 0.0), inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(GROUND, 0), rocker.start)
    m.start_near(crank=40, coupler=40, rocker=95)
    m.drive_angle("motor", crank, constant_rate(20.0, math.radians(40)))
    return m


def weights(m: Mechanism, *names: str, **given: Any) -> list[Counterweight]:
    return [Counterweight(m.bodies[name].start, radius=0.04, **given) for name in names]


def test_a_four_bar_is_force_balanced_as_berkof_and_lowen_say() -> None:
    """m r of the crank's weight = m3 a2 r3' / a3, along phi3'; of the rocker's m3 a4 r3 / a3, against phi3."""
    m = four_bar()
    balanced = balance(m.sweep(steps=90), weights(m, "crank", "rocker"))
    assert balanced.after["force"] < 1e-12 * balanced.before["force"]
    x, y = m.bodies["coupler"].com
    on_crank = -m.bodies["coupler"].mass * (A2 / A3) * complex(A3 - x, -y)
    on_rocker = -m.bodies["coupler"].mass * (A4 / A3) * complex(x, y)
    for weight, expected in zip(balanced.weights, (on_crank, on_rocker), strict=True):
        assert 0.04 * weight.mass * np.exp(1j * weight.angle) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    ("of", "norm"),
    [
        ("force", "rms"),
        ("moment", "rms"),
        ("couple", "peak"),
        ("torque", "rms"),
        ({"force": 1.0, "moment": 0.5}, "peak"),
    ],
    ids=str,
)
def test_promised_values_are_those_of_the_solver_with_the_weights(norm: Any, of: Any) -> None:
    m = four_bar()
    for k, body in enumerate(("crank", "coupler", "rocker")):
        m.change(body, z=0.02 * k)
    means = [
        Counterweight(m.bodies["coupler"].at(0.1, 0.01), radius=0.05, largest=0.4, z=0.07),
        Counterweight(m.bodies["crank"].start, radius=0.03, largest=1.0, z=-0.01),
    ]
    about, z = (0.02, -0.03), 0.013
    sol = m.sweep(steps=60)
    balanced = balance(sol, means, of, norm, about, z)
    balanced.apply()
    after = m.sweep(steps=60)
    for name, series in balanced.series.items():
        got = exact(after, name, about, z)
        assert np.abs(series - got).max() < 1e-8 * np.abs(got).max()
        assert balanced.before[name] == pytest.approx(measured(exact(sol, name, about, z), norm), rel=1e-9)
        assert balanced.after[name] == pytest.approx(measured(exact(after, name, about, z), norm), rel=1e-7)
    assert sum(balanced.after.values()) < sum(balanced.before.values())
    for weight, counterweight in zip(balanced.weights, means, strict=True):
        assert weight.mass <= counterweight.largest * (1 + 1e-9)


def exact(sol: Solution, name: str, about: tuple[float, float], z: float) -> np.ndarray:
    shaking = sol.shaking(about, z)
    if name == "torque":
        return sol.driver("motor").effort - sol.driver("motor").effort.mean()
    return {"force": shaking.force, "moment": shaking.moment, "couple": shaking.couple}[name]


def measured(values: np.ndarray, norm: str) -> float:
    squares = (values.reshape(len(values), -1) ** 2).sum(axis=1)
    return math.sqrt(squares[:-1].mean() if norm == "rms" else squares.max())  # the last row is the first


@pytest.mark.parametrize("norm", ["rms", "peak"])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_a_quantity_that_is_rounding_leaves_the_others_their_weight(norm: Any, scale: float) -> None:
    """A fan out of balance has no moment about its axis, nor one with a counterweight: the force goes to zero."""
    m = Mechanism("fan")
    fan = m.body("fan", 1.0, (0.05 * scale, 0.02 * scale), 0.01 * scale**2)
    m.revolute("O", m.ground.at(0.3 * scale, 0.1 * scale), fan.origin)
    m.drive_angle("motor", fan, constant_rate(50.0))
    m.start_near(fan=0)
    best = balance(
        m.sweep(steps=45), [Counterweight(fan.origin, 0.1 * scale)], {"force": 1.0, "moment": 1e-3}, norm,
        about=(0.3 * scale, 0.1 * scale),
    )  # fmt: skip
    assert 0.0 < best.before["moment"] < 1e-9 * scale * best.before["force"]
    assert best.after["force"] < 1e-7 * best.before["force"]
    assert best.weights[0].mass == pytest.approx(math.hypot(0.05, 0.02) / 0.1, rel=1e-6)


def test_half_the_oscillating_mass_is_least_at_the_peak_of_a_single_cylinder() -> None:
    """With a long rod F = m r w^2 cos phi along the bore; half of it against the throw leaves half, turning back."""
    m = engine("I1", bore=0.08, stroke=0.08, rod=8.0, piston_mass=1.0, rod_mass=0.0, counterweight="none", speed=10.0)
    sol = m.sweep(steps=180)
    balanced = balance(sol, [Counterweight(m.bodies["crank"].origin, radius=0.04)], norm="peak")
    assert balanced.weights[0].mass == pytest.approx(0.5, abs=5e-3)
    assert balanced.weights[0].angle == pytest.approx(-math.pi / 2, abs=1e-6)
    assert balanced.after["force"] == pytest.approx(0.5 * balanced.before["force"], rel=1e-2)


def test_lanchesters_shafts_take_the_second_order_of_an_inline_four() -> None:
    m = engine("I4", bore=0.08, stroke=0.08, rod=0.14, piston_mass=0.5, rod_mass=0.4, speed=100.0)
    sol = m.sweep(steps=120)
    balanced = balance(sol, [BalanceShaft(2, (0.1, 0)), BalanceShaft(-2, (-0.1, 0))])
    before = sol.orders(sol.shaking().force, crank="crank", turns=1)
    after = sol.orders(balanced.series["force"], crank="crank", turns=1)
    row = before.index(2)
    assert before.largest[row] > 100.0
    assert after.largest[row] < 1e-9 * before.largest[row]
    assert after.largest[before.index(4)] == pytest.approx(before.largest[before.index(4)], rel=1e-9)
    for shaft in balanced.shafts:  # each takes one turning half of the second order
        assert shaft.moment * (2 * 100.0) ** 2 == pytest.approx(abs(before.forward[row]), rel=1e-9)


def test_a_weight_stays_within_its_bound() -> None:
    m = four_bar()
    sol = m.sweep(steps=60)
    free = balance(sol, weights(m, "crank", "rocker"))
    bound = 0.5 * min(weight.mass for weight in free.weights)
    held = balance(sol, weights(m, "crank", "rocker", largest=bound))
    assert all(weight.mass <= bound * (1 + 1e-6) for weight in held.weights)
    assert free.after["force"] < held.after["force"] < held.before["force"]
    assert "four-bar" not in str(held)
    assert "crank: " in str(held)


def test_the_flywheel_of_a_crank_with_an_eccentric_mass() -> None:
    """T = m g r cos phi, so the energy swings by 2 m g r."""
    m = Mechanism("eccentric")
    disc = m.body("disc", mass=2.0, com=(0.1, 0.0))
    m.revolute("A", m.ground.origin, disc.origin)
    m.drive_angle("motor", disc, constant_rate(-30.0))
    sized = flywheel(m.sweep(steps=360), "motor", 0.02)
    assert sized.energy == pytest.approx(2 * 2.0 * 9.80665 * 0.1, rel=1e-6)
    assert sized.inertia == pytest.approx(sized.energy / (0.02 * 900), rel=1e-12)
    disc.inertia = sized.inertia - 2.0 * 0.1**2
    m.change("motor", law=constant_rate(30.0))
    free = Mechanism("free")
    wheel = free.body("disc", mass=2.0, com=(0.1, 0.0), inertia=disc.inertia)
    free.revolute("A", free.ground.origin, wheel.origin)
    free.start_moving(disc=30.0)
    omega = free.simulate(0.5).body("disc").omega
    assert np.ptp(omega) / omega.mean() == pytest.approx(0.02, rel=0.02)


def test_motions_that_cannot_be_balanced_are_refused() -> None:
    m = four_bar()
    sol = m.sweep(steps=30)
    [weight] = weights(m, "crank")
    with pytest.raises(ModelError, match=r"no quantity 'forces'.*force"):
        balance(sol, [weight], "forces")
    with pytest.raises(ModelError, match="norm is 'max'"):
        balance(sol, [weight], norm="max")  # pyright: ignore[reportArgumentType]
    with pytest.raises(ModelError, match="give a list of Counterweight"):
        balance(sol, [])
    with pytest.raises(ModelError, match="on a body of another mechanism"):
        balance(sol, weights(four_bar(), "crank"))
    with pytest.raises(ModelError, match="ground balances nothing"):
        Counterweight(m.ground.origin, radius=0.1)
    with pytest.raises(ModelError, match=r"radius .* is -1"):
        Counterweight(m.bodies["crank"].start, radius=-1.0)
    with pytest.raises(ModelError, match="ratio of a balance shaft is 0"):
        BalanceShaft(0)
    pendulum = Mechanism("pendulum")
    rod = pendulum.bar("rod", 1.0, mass=1.0)
    pendulum.revolute("A", pendulum.ground.origin, rod.start)
    with pytest.raises(ModelError, match="a motion that forces make"):
        balance(pendulum.simulate(0.1), [Counterweight(rod.start, radius=0.1)])
    with pytest.raises(ModelError, match="fluctuation is 0"):
        flywheel(sol, "motor", 0.0)
