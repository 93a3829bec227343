"""The gallery's free motion: pendulums, springs and forces."""

from __future__ import annotations

from math import pi, sin, sqrt
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import roots_laguerre

from mbsd.results.solution import Solution
from mechanisms.bending_stiffness import mechanism as beam
from mechanisms.chain import mechanism as chain
from mechanisms.double_pendulum import mechanism as double_pendulum
from mechanisms.gravitation import mechanism as gravitation
from mechanisms.mass_spring_damper import mechanism as oscillator
from mechanisms.moving_pendulum import mechanism as cart
from mechanisms.pendulum import mechanism as pendulum
from mechanisms.rotating_constraint import mechanism as turning
from mechanisms.scotch_yoke import mechanism as yoke
from mechanisms.toggle_clamp import mechanism as clamp

# Pendulums of the gallery: period by the elliptic integral, energy, losses, modes.


def test_damping_takes_what_a_pendulum_loses() -> None:
    p = pendulum.Params(**pendulum.VARIANTS["damped"])
    sol = pendulum.build(p).simulate(pendulum.DURATION, 400, tolerance=1e-10)
    loss = np.gradient(sol.energy.total, sol.t, edge_order=2) + p.damping * sol.body("rod").omega ** 2
    assert np.abs(loss).max() < 0.02 * p.damping * (sol.body("rod").omega ** 2).max()
    assert sol.energy.total[-1] < sol.energy.total[0]


def test_neighbouring_double_pendulums_part() -> None:
    ends = []
    for start in (double_pendulum.Params().start, double_pendulum.VARIANTS["beside"]["start"]):
        m = double_pendulum.build(double_pendulum.Params(start=start))
        point = m.simulate(double_pendulum.DURATION, 600, tolerance=1e-10).point("P")
        ends.append(np.stack([point.x, point.y], axis=1))
    apart = np.linalg.norm(ends[0] - ends[1], axis=1)
    assert apart[0] < 0.001
    assert apart.max() > 0.1


# Mechanisms of the gallery that live from springs, against their closed forms and published numbers.


def _oscillator(**changed: Any) -> tuple[oscillator.Params, Solution]:
    p = oscillator.Params(**changed)
    return p, oscillator.build(p).simulate(3.0, 600, tolerance=1e-11)


def test_mass_spring_damper_creeps_back_where_it_is_damped_critically() -> None:
    p, sol = _oscillator(damping=oscillator.VARIANTS["critical"]["damping"])
    assert p.damping == 2 * sqrt(p.stiffness * p.mass)
    decay = sqrt(p.stiffness / p.mass)
    place = sol.body("block").x
    np.testing.assert_allclose(place, p.start * (1 + decay * sol.t) * np.exp(-decay * sol.t), atol=1e-9)
    assert (place > -1e-12).all()


def test_mass_spring_damper_in_resonance_swings_up_to_five_times_the_push() -> None:
    """x = -F / (c w) (cos w t - e^(-d t) (cos v t + d / v sin v t)), w^2 = k / m, v^2 = w^2 - d^2."""
    changed = {key: value for key, value in oscillator.VARIANTS["resonance"].items() if key != "DURATION"}
    p, sol = _oscillator(**changed)
    rate, decay = sqrt(p.stiffness / p.mass), p.damping / (2 * p.mass)
    free = sqrt(rate**2 - decay**2)
    start = np.exp(-decay * sol.t) * (np.cos(free * sol.t) + decay / free * np.sin(free * sol.t))
    wide = p.force / (p.damping * rate)
    np.testing.assert_allclose(sol.body("block").x, -wide * (np.cos(rate * sol.t) - start), atol=1e-9)
    assert wide == 5 * p.force / p.stiffness


def test_rotating_constraint_swings_about_a_place_further_out_than_its_rest() -> None:
    """Along the arm r'' = (w^2 - k / m) r + k l / m: about k l / (k - m w^2), with the rate sqrt(k / m - w^2)."""
    p = turning.Params()
    sol = turning.build(p).simulate(3.0, 300, tolerance=1e-11)
    middle = p.stiffness * p.free / (p.stiffness - p.mass * p.rate**2)
    away = middle + (p.start - middle) * np.cos(sqrt(p.stiffness / p.mass - p.rate**2) * sol.t)
    block = sol.body("block")
    np.testing.assert_allclose(block.x + 1j * block.y, away * np.exp(1j * p.rate * sol.t), atol=1e-9)
    loose = turning.Params(stiffness=0.0, rate=0.5)
    block = turning.build(loose).simulate(4.0, 100, tolerance=1e-11).body("block")
    out = loose.start * np.cosh(loose.rate * np.linspace(0, 4.0, 101))
    np.testing.assert_allclose(np.hypot(block.x, block.y), out, rtol=1e-9)


def test_bending_stiffness_is_that_of_a_beam() -> None:
    """Hencky's chain of n links bends by F L^3 / 3 E I (1 + 1 / 2 n^2) under a small force F on its tip."""
    for links in (3, 12):
        p = beam.Params(links=links, force=1e-3, gravity=0.0)
        rest = beam.build(p).equilibrium()
        strip = p.force * p.length**3 / (3 * p.stiffness)
        assert -rest.point("tip").y == pytest.approx(strip * (1 + 1 / (2 * links**2)), rel=1e-5)


# Torques of driven mechanisms of the gallery, against their closed forms.


def test_scotch_yoke_is_a_cosine_and_its_spring_spares_the_motor() -> None:
    p = yoke.Params()
    sol = yoke.build(p).sweep()
    turn = p.speed * sol.t
    np.testing.assert_allclose(sol.body("yoke").x, p.crank * np.cos(turn), atol=1e-14)
    needed = p.mass * (p.crank * p.speed) ** 2 * np.sin(turn) * np.cos(turn)
    np.testing.assert_allclose(sol.driver("motor").torque, needed, atol=1e-14)
    tuned = yoke.build(yoke.Params(**yoke.VARIANTS["spring"])).sweep()
    assert np.abs(tuned.driver("motor").torque).max() < 1e-12 * np.abs(needed).max()


def test_scotch_yoke_without_a_motor_turns_as_its_energy_says() -> None:
    """(I + m r^2 sin^2 a) a'^2 + k r^2 cos^2 a is constant; in tune, k = m w^2, a' is constant."""
    for tune in (1.0, yoke.VARIANTS["free"]["tune"], 0.4):
        p = yoke.Params(tuned=True, driven=False, tune=tune)
        sol = yoke.build(p).simulate(yoke.VARIANTS["free"]["DURATION"], 400, tolerance=1e-11)
        crank, moved, stiffness = sol.body("crank"), p.mass * p.crank**2, tune * p.mass * p.speed**2
        held = stiffness * p.crank**2
        squares = (p.flywheel * p.speed**2 + held * np.sin(crank.theta) ** 2) / (
            p.flywheel + moved * np.sin(crank.theta) ** 2
        )
        np.testing.assert_allclose(crank.omega, np.sqrt(squares), rtol=1e-8)
        if tune == 1.0:
            np.testing.assert_allclose(crank.theta, p.speed * sol.t, atol=1e-7)
            np.testing.assert_allclose(sol.body("yoke").x, p.crank * np.cos(p.speed * sol.t), atol=1e-8)


def test_toggle_clamp_needs_no_hand_at_its_dead_point() -> None:
    p = clamp.Params()
    sol = clamp.build(p).sweep(steps=3600)
    hand, pad = sol.driver("hand"), sol.point("pad")
    work = hand.torque * hand.rate + p.force * pad.vy  # nothing has mass, so hand and workpiece balance
    assert np.abs(work).max() < 1e-11 * np.abs(p.force * pad.vy).max()
    past = hand.value < clamp.dead_point(p)
    assert 0 < past.mean() < 0.5
    # The workpiece drives the handle into the lock while it is past the dead point, and opens it before.
    assert (hand.torque[past] > 0).all()
    assert (hand.torque[~past] < 0).all()
    across = np.interp(-clamp.dead_point(p), -hand.value[3600 // 2 :], hand.torque[3600 // 2 :])
    assert abs(across) < 1e-3 * np.abs(hand.torque).max()


# Mechanisms of the gallery that their weight or attraction moves, against closed forms and published numbers.


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
