"""Elastic cables and capstans against closed forms: oscillations, slack, modes, preload, Euler and Eytelwein."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.measures import final

G, MASS, STIFFNESS = 9.81, 2.0, 500.0
DOWN = -math.pi / 2


def load(m: Mechanism, name: str, x: float, mass: float, y: float = -1.0) -> Any:
    body = m.body(name, mass, inertia=0.1)
    m.prismatic(f"guide {name}", m.ground.at(x, 0, DOWN), body.at(0, 0, DOWN))
    m.start_near(**{name: (x, y, 0)})
    return body


def hanging(**given: Any) -> Mechanism:
    """A load on an elastic rope over a fixed pulley."""
    m = Mechanism("elastic", gravity=(0, -G))
    body = load(m, "load", 0.1, MASS)
    m.cable("rope", [m.ground.at(-0.1, -1), m.over(m.ground.origin, 0.1, slides=True), body.origin], **given)
    return m


@pytest.mark.parametrize("formulation", ["independent", "reference"])
def test_a_load_swings_about_its_rest(formulation: str) -> None:
    sol = hanging(stiffness=STIFFNESS).simulate(2.0, tolerance=1e-12, formulation=formulation)
    w = math.sqrt(STIFFNESS / MASS)
    assert np.allclose(sol.body("load").y, -1 - G / w**2 * (1 - np.cos(w * sol.t)), rtol=0.0, atol=1e-12)
    pulls = sol.tension("rope")
    assert np.allclose(pulls[:, 0], pulls[:, 1], atol=1e-10)
    assert np.allclose(pulls[:, 0], STIFFNESS * (-1 - sol.body("load").y), atol=1e-9)
    assert np.ptp(sol.energy.total) < 1e-11


def test_a_slack_rope_tightens_and_slackens_without_a_jerk() -> None:
    slack = 0.05
    sol = hanging(stiffness=STIFFNESS, taut=False, slack=slack).simulate(1.0, tolerance=1e-12)
    w, begin = math.sqrt(STIFFNESS / MASS), math.sqrt(2 * slack / G)
    speed = G * begin

    def stretch(t: float) -> float:
        return G / w**2 * (1 - math.cos(w * t)) + speed / w * math.sin(w * t)

    taut = float(brentq(stretch, math.pi / w, 2 * math.pi / w, xtol=1e-15))  # pyright: ignore[reportArgumentType]
    own = np.where(
        sol.t < begin,
        -1 - G * sol.t**2 / 2,
        np.where(
            sol.t < begin + taut,
            -1 - slack - np.vectorize(stretch)(sol.t - begin),
            -1 - slack + speed * (sol.t - begin - taut) - G * (sol.t - begin - taut) ** 2 / 2,
        ),
    )
    first = sol.t < begin + taut + 2 * speed / G
    assert first.sum() > 100
    assert np.allclose(sol.body("load").y[first], own[first], rtol=0.0, atol=1e-11)
    assert sol.tension("rope").min() > -1e-9
    assert np.ptp(sol.energy.total) < 1e-9


def test_rest_and_modes_of_a_damped_rope() -> None:
    m = hanging(stiffness=STIFFNESS, damping=30.0, preload=4.0)
    assert m.equilibrium().body("load").y == pytest.approx(-1 - (MASS * G - 4.0) / STIFFNESS, abs=1e-12)
    [mode] = m.modes()
    assert mode.eigenvalue == pytest.approx(complex(-7.5, math.sqrt(250 - 7.5**2)), rel=1e-8)


def test_modes_about_the_rest_of_a_rope_that_started_slack() -> None:
    m = hanging(stiffness=STIFFNESS, damping=30.0, taut=False, slack=0.2)
    assert m.equilibrium().body("load").y == pytest.approx(-1.2 - MASS * G / STIFFNESS, abs=1e-9)
    [mode] = m.modes()
    assert mode.eigenvalue == pytest.approx(complex(-7.5, math.sqrt(250 - 7.5**2)), rel=1e-6)


def test_a_belt_holds_its_preload_and_each_span_its_own_pull() -> None:
    """Torque T on one of two equal pulleys: the pulls become S + T / 2r and S - T / 2r."""
    m, r = Mechanism("belt", gravity=(0, 0)), 0.1
    wheels = [m.body(name, 1.0, inertia=0.005) for name in "AB"]
    for k, body in enumerate(wheels):
        m.revolute(f"axle {k}", m.ground.at(0.5 * k, 0), body.origin)
    way = [m.over(body.origin, r, clockwise=False) for body in wheels]
    m.cable("belt", way, closed=True, stiffness=2e4, damping=200.0, preload=100.0)
    m.torsion_spring("brake", m.ground, wheels[1], stiffness=10.0)
    m.torque("motor", wheels[0], 4.0)
    sol = m.equilibrium()
    turns = [float(sol.body(name).theta) for name in "AB"]
    assert turns[1] == pytest.approx(0.4, rel=1e-9)
    assert turns[0] - turns[1] == pytest.approx(4.0 / (2 * 2e4 * r * r), rel=1e-8)


def capstan(left: float, right: float, friction: float, turns: int = 0, **more: Any) -> Mechanism:
    m = Mechanism("capstan", gravity=(0, -G))
    bodies = load(m, "left", -0.1, left, -3.0), load(m, "right", 0.1, right, -3.0)
    bollard = m.over(m.ground.origin, 0.1, friction=friction, turns=turns)
    m.cable("rope", [bodies[0].origin, bollard, bodies[1].origin], **more)
    return m


@settings(max_examples=8, deadline=None)
@given(st.floats(0.5, 20.0), st.floats(0.5, 20.0), st.floats(0.05, 0.6), st.integers(0, 1))
def test_a_rope_slips_on_a_bollard_by_euler_and_eytelwein(left: float, right: float, mu: float, turns: int) -> None:
    most = math.exp(mu * math.pi * (1 + 2 * turns))
    if min(abs(right - left * most), abs(left - right * most)) < 1e-3:
        return
    heavy, light = max(left, right), min(left, right)
    slips = heavy > light * most
    a = G * (heavy - light * most) / (heavy + light * most) if slips else 0.0
    sol = capstan(left, right, mu, turns).simulate(0.2, steps=10)
    down = -3.0 - sol.body("right").y if right > left else -3.0 - sol.body("left").y
    assert np.allclose(down, a * sol.t**2 / 2, atol=1e-12 + 1e-9 * a)
    pulls = np.sort(sol.tension("rope")[1:], axis=1)
    ratio = most if slips else heavy / light
    assert np.allclose(pulls[:, 1] / pulls[:, 0], ratio, rtol=1e-9)


def test_a_driven_rope_slips_both_ways() -> None:
    for rate, power in (-0.5, 1), (0.5, -1):
        m = capstan(2.0, 5.0, 0.2)
        m.drive_coordinate("hand", m.ground.at(-0.1, 0, DOWN), m.bodies["left"].origin, constant_rate(rate, 3.0))
        pulls = m.sweep(0.5, steps=5).tension("rope")
        assert np.allclose(pulls[:, 1], 5.0 * G, rtol=1e-9)
        assert np.allclose(pulls[:, 0], 5.0 * G * math.exp(-power * 0.2 * math.pi), rtol=1e-9)


def test_saved_changed_and_many(tmp_path: Path) -> None:
    m = hanging(stiffness=STIFFNESS, preload=3.0)
    m.save(tmp_path / "m.json")
    wanted = m.simulate(0.3).body("load").y
    assert (Mechanism.load(tmp_path / "m.json").simulate(0.3).body("load").y == wanted).all()
    many = m.simulate_many(
        0.3, vary={"rope spring 1": {"stiffness": [STIFFNESS, 800.0]}}, measure={"y": final("load.y")}
    )
    stiffer = hanging(stiffness=800.0, preload=3.0).simulate(0.3).body("load").y
    assert many["y"] == pytest.approx([wanted[-1], stiffer[-1]])
    rough = capstan(2.0, 5.0, 0.2)
    rough.save(tmp_path / "rough.json")
    again = Mechanism.load(tmp_path / "rough.json").simulate(0.1)
    assert (again.body("right").y == rough.simulate(0.1).body("right").y).all()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"damping": 3.0}, "give stiffness="),
        ({"stiffness": 0.0}, "stiffness 0"),
        ({"stiffness": -1.0}, "cannot be negative"),
        ({"stiffness": float("nan")}, "finite"),
        ({"stiffness": 5.0, "taut": False, "restitution": 0.5}, "without an impact"),
    ],
)
def test_bad_elastic_cables_are_refused(given: Any, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        hanging(**given)


def test_bad_bollards_are_refused() -> None:
    m = Mechanism("bad")
    with pytest.raises(ModelError, match="turns"):
        m.over(m.ground.origin, 0.1, turns=1)
    with pytest.raises(ModelError, match="give stiffness= as well"):
        capstan(1.0, 2.0, 0.2, taut=False)
    with pytest.raises(ModelError, match="spring"):
        m.cable("straight", [m.ground.at(1, 0), m.body("free").origin], stiffness=10.0)
