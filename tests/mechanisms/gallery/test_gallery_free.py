"""Mechanisms of the gallery that their weight or attraction moves, against closed forms and published numbers."""

from __future__ import annotations

from math import pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import roots_laguerre

from mechanisms.chain import mechanism as chain
from mechanisms.gravitation import mechanism as gravitation
from mechanisms.moving_pendulum import mechanism as cart
from mechanisms.swing_table import mechanism as table
from tests.published.test_reference_mubosym import exact, published, rods


def test_moving_pendulum_leaves_its_centre_of_mass_where_it_is() -> None:
    """Sideways; and its energy. (M + m) x + m l cos a does not change."""
    p = cart.Params()
    sol = cart.build(p).simulate(3.0, 300, tolerance=1e-11)
    heavy, bob = p.masses
    x, rod = sol.body("cart").x, sol.body("rod")
    shift = (heavy + bob) * x + bob * p.length * np.cos(rod.theta)
    np.testing.assert_allclose(shift, shift[0], atol=1e-11)
    assert np.ptp(sol.energy.total) < 1e-9
    swung = np.abs(np.diff(np.sign(rod.omega))) > 0
    assert swung.sum() > 2  # it swings to and fro


def test_moving_pendulum_swings_faster_than_on_a_fixed_pivot() -> None:
    """Small swings have w^2 = g (M + m) / (M l)."""
    p = cart.Params()
    m = cart.build(cart.Params(start=0.0))
    rates = 2 * pi * m.linearise().frequencies
    assert rates.max() == pytest.approx(2 * pi / cart.small_period(p), rel=1e-6)


def test_moving_pendulum_driven_goes_over_the_top_as_published() -> None:
    """mubosym's test 9, as exactly as its tolerance allows; see tests/published/test_reference_mubosym.py."""
    p = cart.Params(length=1.5, masses=(1.0, 1.0), start=0.0, damping=0.05, stroke=2.0)
    rod = cart.build(p).simulate(20.0, 40, tolerance=1e-11).body("rod")
    np.testing.assert_allclose([rod.theta[-1] + pi / 2, rod.omega[-1]], published("9"), atol=0.06)


def test_swing_table_stays_level_and_ends_as_published() -> None:
    """mubosym's test 2: from 0.0179 before -1.75 turns; the table tilts by 3e-4 there."""
    stored, start = published("2"), np.cumsum([-13.73437514, 15.30494211, -5.87985813])
    p = table.Params(swing=1.0, table=1.5, mass=1.0, damping=0.1, start=np.degrees(start[0]))
    m = table.build(p)
    m.start_moving(left=0.81904538)
    sol = m.simulate(20.0, 200, tolerance=1e-11)
    left, right = sol.body("left"), sol.body("right")
    np.testing.assert_allclose(np.remainder(sol.body("table").theta + pi, 2 * pi), pi, atol=1e-9)
    np.testing.assert_allclose([left.theta[-1] + pi / 2, left.omega[-1]], [stored[0], stored[3]], atol=7e-3)
    np.testing.assert_allclose(right.omega, left.omega, atol=1e-9)
    answer = exact(rods((1.0,), 0.1), np.array([start[0], 0.81904538]), 20.0)
    np.testing.assert_allclose([left.theta[-1] + pi / 2, left.omega[-1]], answer, atol=1e-7)


def test_chain_of_six_ends_as_published() -> None:
    """mubosym's test 12, whose integrator has moved it by 0.1."""
    p = chain.Params(length=1.0, mass=1.0, damping=0.4, rate=4.0)
    sol = chain.build(p).simulate(20.0, 40, tolerance=1e-11)
    angles = [sol.body(f"link{k + 1}").theta[-1] + pi / 2 for k in range(6)]
    np.testing.assert_allclose(angles, published("12")[:6], atol=0.1)
    answer = exact(rods((1.0,) * 6, 0.4), np.concatenate([np.zeros(6), np.full(6, 4.0)]), 20.0)
    np.testing.assert_allclose(angles, answer[:6], atol=1e-5)


@pytest.mark.parametrize("links", [3, 10, 24])
def test_chain_swings_at_the_roots_of_laguerre(links: int) -> None:
    """Small swings of n beads on a string: w^2 = x g / l, where Laguerre's polynomial L_n(x) is zero."""
    p = chain.Params(links=links, damping=0.0, rate=0.0)
    rates = np.sort(2 * pi * chain.build(p).linearise().frequencies)
    wanted = np.sqrt(np.sort(roots_laguerre(links)[0]) * p.gravity / p.length)
    np.testing.assert_allclose(rates[: len(wanted)], wanted, rtol=1e-6)


def test_planet_runs_on_keplers_ellipse() -> None:
    p = gravitation.Params()
    sol = gravitation.build(p).simulate(p.period, 80, tolerance=1e-12)
    sun, planet = sol.body("sun"), sol.body("planet")
    anomaly = pi + 2 * pi * sol.t / p.period
    e = p.eccentricity
    eccentric = np.array([brentq(lambda u, a=a: u - e * sin(u) - a, a - 1, a + 1, xtol=1e-14) for a in anomaly])
    x, y = -p.axis * (np.cos(eccentric) - e), -p.axis * sqrt(1 - e**2) * np.sin(eccentric)
    np.testing.assert_allclose(planet.x - sun.x, x, atol=1e-9)
    np.testing.assert_allclose(planet.y - sun.y, y, atol=1e-9)
    np.testing.assert_allclose(p.masses[0] * sun.x + p.masses[1] * planet.x, 0.0, atol=1e-12)


def test_three_bodies_are_back_on_their_eight_after_the_published_period() -> None:
    """Chenciner and Montgomery, Annals of Mathematics 152 (2000): to the eight digits that are published."""
    changed: dict[str, Any] = {k: v for k, v in gravitation.VARIANTS["eight"].items() if k != "DURATION"}
    p = gravitation.Params(**changed)
    sol = gravitation.build(p).simulate(p.period, 60, tolerance=1e-12)
    for k in range(3):
        body, after = sol.body(f"body{k + 1}"), sol.body(f"body{(k + 1) % 3 + 1}")
        assert abs(complex(body.x[-1] - body.x[0], body.y[-1] - body.y[0])) < 1e-5 * p.axis
        assert (
            np.hypot(after.x[20] - body.x[0], after.y[20] - body.y[0]) < 1e-5 * p.axis
            or np.hypot(after.x[40] - body.x[0], after.y[40] - body.y[0]) < 1e-5 * p.axis
        )
