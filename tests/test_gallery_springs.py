"""Mechanisms of the gallery that live from springs, against their closed forms and published numbers."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from mbsd.solution import Solution
from mechanisms.mass_spring_damper import mechanism as oscillator


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
