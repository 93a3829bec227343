"""Published motions under gravity alone: numbers of others, each file with its source and tolerance."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.special import ellipj, ellipk

from mbsd import Mechanism
from mbsd.results.solution import Solution

FOLDER = Path(__file__).parent / "reference"


def case(name: str) -> dict[str, Any]:
    """A case and its first expectation's rows as an array."""
    return json.loads((FOLDER / f"{name}.json").read_text())


def rows_of(data: dict[str, Any], which: int = 0) -> np.ndarray:
    """The rows of one expectation."""
    return np.array(data["expected"][which]["rows"], float)


def simulate_at(m: Mechanism, times: np.ndarray, **options: Any) -> Solution:
    """With a tolerance far below those of the published numbers; ``times`` begin with the start."""
    options.setdefault("tolerance", 1e-9)
    return m.simulate(times=times, **options)


def adams_mass(m: Mechanism, inertia: float) -> Any:
    """The body of all ADAMS cases: 1 kg, its frame 2 m from the joint."""
    body = m.body("mass", 1.0, inertia=inertia)
    m.start_near(mass=(2.0, 0.0, 0.0))
    return body


def assert_adams(sol: Solution, expected: np.ndarray, force: np.ndarray, tolerance: dict[str, float]) -> None:
    """Columns: t, x, y, vx, vy, ax, ay, omega, alpha, force on the ground."""
    body = sol.body("mass")
    for columns, values, key in (
        (slice(1, 3), (body.x, body.y), "pos"),
        (slice(3, 5), (body.vx, body.vy), "vel"),
        (slice(5, 7), (body.ax, body.ay), "acc"),
        (7, body.omega, "omega"),
        (8, body.alpha, "alpha"),
        (slice(9, 11), (force[:, 0], force[:, 1]), "force"),
    ):
        atol = tolerance.get(key, tolerance["acc"])
        np.testing.assert_allclose(np.array(values).T, expected[:, columns], atol=atol, err_msg=key)


def test_a01_pendulum_of_a_point_mass() -> None:
    data = case("iftomm_a01_simple_pendulum")
    expected = rows_of(data)
    m = Mechanism("A01", gravity=tuple(data["gravity"]))
    bob = m.body("bob", 1.0)
    m.distance("rod", m.ground.at(0, 0), bob.origin, 1.0)
    m.start_near(bob=(-1.0, 0.0, 0.0))
    sol = simulate_at(m, expected[:, 0])
    view = sol.body("bob")
    computed = np.stack([view.x, view.y, view.vx, view.vy], axis=1)
    np.testing.assert_allclose(computed, expected[:, 1:], atol=data["expected"][0]["tol_abs"])
    assert np.ptp(sol.energy.total) < 5e-5  # J, what the benchmark accepts


@pytest.mark.parametrize("degrees", [5, 10, 30, 45, 60, 90, 120, 150, 170, 175, 179])
def test_pendulum_periods(degrees: int) -> None:
    ratio = case("analytic_pendulum_period")["expected"]["ratio_T_over_T0_by_amplitude_deg"][str(degrees)]
    period = ratio * 2 * math.pi * math.sqrt(1.0 / 9.81)
    m = Mechanism("pendulum", gravity=(0.0, -9.81))
    bob = m.body("bob", 1.0)
    m.revolute("A", m.ground.at(0, 0), bob.at(0, 1.0))
    m.start_near(bob=degrees)
    angle = simulate_at(m, np.array([0.0, period / 4, period]), tolerance=1e-11).body("bob").theta
    np.testing.assert_allclose(angle, np.radians([degrees, 0.0, degrees]), atol=2e-6)


def test_a_swinging_pendulum_by_jacobis_elliptic_functions() -> None:
    """From hanging, sin(theta / 2) = k sn(w t | k^2): 2 k w fast at the bottom, turning back at 2 asin k."""
    k, w = 0.9, math.sqrt(9.81)
    m = Mechanism("swinging", gravity=(0.0, -9.81))
    bob = m.body("bob", 1.0)
    m.revolute("A", m.ground.at(0, 0), bob.at(0, 1.0))
    m.start_near(bob=0)
    m.start_moving(bob=2 * k * w)
    sol = simulate_at(m, np.linspace(0.0, 5.0, 101), tolerance=1e-11)
    sn, cn, dn, _ = ellipj(w * sol.t, k**2)
    view = sol.body("bob")
    np.testing.assert_allclose(view.theta, 2 * np.arcsin(k * sn), atol=1e-8)
    np.testing.assert_allclose(view.omega, 2 * k * w * cn, atol=1e-8)
    np.testing.assert_allclose(view.alpha, -2 * k * w**2 * sn * dn, atol=1e-7)


def test_a_pendulum_over_the_top_by_jacobis_elliptic_functions() -> None:
    """Faster than 2 w at the bottom it goes round: theta = 2 am(w t / k | k^2), one turn in 2 k K(k^2) / w."""
    k, w = 0.8, math.sqrt(9.81)
    m = Mechanism("going round", gravity=(0.0, -9.81))
    bob = m.body("bob", 1.0)
    m.revolute("A", m.ground.at(0, 0), bob.at(0, 1.0))
    m.start_near(bob=0)
    m.start_moving(bob=2 * w / k)
    turn = 2 * k * float(ellipk(k**2)) / w
    sol = simulate_at(m, np.linspace(0.0, 3 * turn, 61), tolerance=1e-11)
    amplitude, dn = ellipj(w * sol.t / k, k**2)[3], ellipj(w * sol.t / k, k**2)[2]
    np.testing.assert_allclose(sol.body("bob").theta, 2 * amplitude, atol=1e-8)
    np.testing.assert_allclose(sol.body("bob").omega, 2 * w / k * dn, atol=1e-8)
    assert sol.body("bob").theta[-1] == pytest.approx(6 * math.pi, abs=1e-8)


def test_adams_pendulum() -> None:
    data = case("adams_revolute_case01")
    m = Mechanism("adams pendulum", gravity=tuple(data["gravity"]))
    body = adams_mass(m, 0.1)
    m.revolute("pin", m.ground.at(0, 0), body.at(-2.0, 0.0))
    sol = simulate_at(m, rows_of(data)[:, 0])
    assert_adams(sol, rows_of(data), -sol.joint("pin").reaction, data["expected"][0]["tol_abs"])


def test_adams_mass_on_a_rod() -> None:
    data = case("adams_distance_case01")
    m = Mechanism("adams rod", gravity=tuple(data["gravity"]))
    body = adams_mass(m, 0.04)
    m.distance("rod", m.ground.at(0, 0), body.origin, 2.0)
    sol = simulate_at(m, rows_of(data)[:, 0])
    assert_adams(sol, rows_of(data), -sol.joint("rod").reaction, data["expected"][0]["tol_abs"])


def test_dlr_pendulum() -> None:
    data = case("dlr_pendulum")
    m = Mechanism("dlr pendulum", gravity=tuple(data["gravity"]))
    body = m.body("body", 1.0, inertia=0.1)
    m.revolute("revolute", m.ground.at(0, 0), body.at(-1.0, 0.0))
    m.start_near(body=0.0)
    view = simulate_at(m, rows_of(data)[:, 0]).body("body")
    np.testing.assert_allclose(np.stack([view.theta, view.omega], axis=1), rows_of(data)[:, 1:], atol=1e-4)


def test_dlr_double_pendulum() -> None:
    data = case("dlr_doublependulum")
    m = Mechanism("dlr double pendulum", gravity=tuple(data["gravity"]))
    first, second = m.body("first", 1.0, inertia=0.1), m.body("second", 0.2, inertia=0.01)
    m.revolute("revolute", m.ground.at(0, 0), first.at(-1.0, 0.0))
    m.revolute("revolute1", first.origin, second.at(-0.4, 0.0))
    m.start_near(first=0.0, second=0.0)
    sol = simulate_at(m, rows_of(data)[:, 0])
    a, b = sol.body("first"), sol.body("second")
    computed = np.stack([a.theta, a.omega, b.theta - a.theta, b.omega - a.omega], axis=1)
    np.testing.assert_allclose(computed, rows_of(data)[:, 1:], atol=data["expected"][0]["tol_abs"])


def test_pendulum_of_mubosym_by_the_exact_numbers() -> None:
    """The stored numbers of mubosym itself are 8e-3 off; the exact ones are those of the case's note."""
    tests = case("mubosym_test_all_reference_states")["expected"]
    exact = next(test for test in tests if test["test"].startswith("13"))["exact_computed"]
    m = Mechanism("mubosym 13", gravity=(0.0, -9.81))
    bob = m.body("bob", 1.0)
    m.distance("circle", m.ground.at(0, 0), bob.origin, 1.0)
    m.start_near(bob=(1.0, 0.0, 0.0))
    view = simulate_at(m, np.array([0.0, 10.0]), tolerance=1e-10).body("bob")
    computed = np.array([view.x[-1], view.y[-1], view.vx[-1], view.vy[-1]])
    stored = np.array(next(test for test in tests if test["test"].startswith("13"))["final"])
    np.testing.assert_allclose(computed, exact, atol=1e-7)
    np.testing.assert_allclose(computed, stored, atol=0.05)
