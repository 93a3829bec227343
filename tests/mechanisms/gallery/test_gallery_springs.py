"""Mechanisms of the gallery that live from springs, against their closed forms and published numbers."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np
import pytest

from mbsd.results.solution import Solution
from mechanisms.bending_stiffness import mechanism as beam
from mechanisms.mass_spring_damper import mechanism as oscillator
from mechanisms.rotating_constraint import mechanism as turning


def _oscillator(**changed: Any) -> tuple[oscillator.Params, Solution]:
    p = oscillator.Params(**changed)
    return p, oscillator.build(p).simulate(3.0, 600, tolerance=1e-11)


def test_mass_spring_damper_swings_as_its_closed_form() -> None:
    """x = x0 e^(-d t) (cos w t + d / w sin w t), with d = c / 2 m and w^2 = k / m - d^2."""
    for damping in (0.0, 4.0):
        p, sol = _oscillator(damping=damping)
        decay = damping / (2 * p.mass)
        rate = sqrt(p.stiffness / p.mass - decay**2)
        exact = np.exp(-decay * sol.t) * (np.cos(rate * sol.t) + decay / rate * np.sin(rate * sol.t))
        np.testing.assert_allclose(sol.body("block").x, p.start * exact, atol=1e-9)


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


def test_bending_stiffness_rings_as_a_cantilever() -> None:
    """The lowest rate of a clamped beam is 1.8751^2 sqrt(E I L / m) / L^2 (Euler, Bernoulli)."""
    p = beam.Params(links=20, force=0.0, damping=0.0)
    lowest_rate = beam.build(p).linearise().frequencies.min() * 2 * pi
    beam_rate = 1.875104**2 * sqrt(p.stiffness * p.length / p.mass) / p.length**2
    assert lowest_rate == pytest.approx(beam_rate, rel=2e-3)
