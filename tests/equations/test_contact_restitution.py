"""Contacts by penalty whose damping comes from a restitution and the speed at which each contact began."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from mbsd import Mechanism, ModelError, Solution, curve, harmonic
from mbsd.model.forces.contact import DAMPING_MODELS

G = 9.80665
PUBLISHED = {"hunt_crossley": 0.02, "lankarani_nikravesh": 0.02, "flores": 0.05}
"""How far the restitution may be off: the first two for e = 0.9, the last for any from 0.3 up."""


def returned(a: float) -> float:
    """v_1 / v_0 under N = k d^n (1 + a d' / v_0), from  int d' dd' / (1 + a d' / v_0)  there and back."""
    root = brentq(lambda e: a * (1 + e) - math.log((1 + a) / (1 - a * e)), 1e-9, min(1.0, (1 - 1e-12) / a))
    return float(root)  # pyright: ignore[reportArgumentType]


def effort_of(sol: Solution, name: str) -> np.ndarray:
    effort = sol.force(name).effort
    assert effort is not None
    return effort


def impact(restitution: float, model: str, speed: float, exponent: float = 1.5, **numbers: float) -> Mechanism:
    m = Mechanism("impact", gravity=None)
    ball = m.body("ball", 0.5, inertia=1.0)
    m.contact(
        "ground", m.ground.origin, ball.origin, 1e5, exponent, radius=0.1,
        restitution=restitution, damping_model=model, **numbers,
    )  # fmt: skip
    m.start_near(ball=(0.0, 0.12, 0.0))
    m.start_moving(ball=(0.3, -speed, 0.0))
    return m


@pytest.mark.parametrize("model", DAMPING_MODELS)
@pytest.mark.parametrize(("restitution", "speed", "exponent"), [(0.9, 2.0, 1.5), (0.5, 0.3, 1.5), (0.7, 5.0, 1.0)])
def test_an_impact_returns_as_the_model_says(model, restitution, speed, exponent) -> None:
    sol = impact(restitution, model, speed, exponent).simulate(0.08 / speed + 0.02, steps=200, tolerance=1e-10)
    body = sol.body("ball")
    assert body.vy[-1] / speed == pytest.approx(returned(DAMPING_MODELS[model](restitution)), rel=1e-7)
    np.testing.assert_allclose(body.vx, 0.3, atol=1e-12)
    assert np.ptp(sol.audit) < 1e-8 * sol.energy.total[0]
    assert sol.stats.power_residual < 1e-9
    effort = effort_of(sol, "ground")
    inside = effort > 0.0
    assert inside.any()
    np.testing.assert_allclose(effort[inside], 0.5 * body.ay[inside], rtol=1e-9)


@pytest.mark.parametrize("model", DAMPING_MODELS)
def test_it_is_near_the_restitution_where_its_authors_say(model: str) -> None:
    assert returned(DAMPING_MODELS[model](0.9)) == pytest.approx(0.9, abs=PUBLISHED[model])
    if model == "flores":
        for e in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8):
            assert returned(DAMPING_MODELS[model](e)) == pytest.approx(e, abs=PUBLISHED[model])
    else:  # both lose too little where much should be lost
        assert returned(DAMPING_MODELS[model](0.3)) > 0.55


@pytest.mark.parametrize("model", DAMPING_MODELS)
def test_a_bouncing_ball_loses_the_same_part_at_each_bounce(model: str) -> None:
    m = Mechanism("bounces")
    ball = m.body("ball", 0.5, inertia=1.0)
    m.contact("floor", m.ground.origin, ball.origin, 1e7, restitution=0.8, damping_model=model, radius=0.1)
    m.start_near(ball=(0.0, 0.6, 0.0))
    sol = m.simulate(2.0, steps=2000, tolerance=1e-9)
    height = sol.body("ball").y - 0.1
    peaks = np.flatnonzero((height[1:-1] > height[:-2]) & (height[1:-1] > height[2:])) + 1
    tops = np.array([0.5, *height[peaks]])
    assert len(tops) >= 4
    np.testing.assert_allclose(np.sqrt(tops[1:] / tops[:-1]), returned(DAMPING_MODELS[model](0.8)), rtol=1e-2)
    assert np.ptp(sol.audit) < 1e-7


def test_a_contact_that_a_step_passes_unseen_remembers_the_speed_at_which_it_began() -> None:
    """Its normal speed changes fast, as it comes round: a speed taken later in the contact would lose other energy."""
    angles = []
    for tolerance in (1e-7, 1e-11):
        m = Mechanism("knock")
        rod = m.bar("rod", 1.0, 2.0)
        m.revolute("pin", m.ground.origin, rod.start)
        wall = m.ground.at(0.1, 0.0, math.pi / 2)
        m.contact("wall", wall, rod.end, 3.4e5, 2.2, radius=0.1, restitution=0.8)
        m.start_near(rod=-22.0)
        angles.append(m.simulate(0.4, steps=10, tolerance=tolerance).body("rod").theta)
    np.testing.assert_allclose(angles[0], angles[1], atol=3e-5)


def test_two_contacts_remember_each_their_own() -> None:
    m = Mechanism("two", gravity=None)
    for name, speed in (("slow", 0.5), ("fast", 2.0)):
        ball = m.body(name, 0.5, inertia=1.0)
        m.contact(f"floor {name}", m.ground.origin, ball.origin, 1e5, restitution=0.6, radius=0.1)
        m.start_near(**{name: (0.0, 0.12, 0.0)})
        m.start_moving(**{name: (0.0, -speed, 0.0)})
    sol = m.simulate(0.2, steps=50, tolerance=1e-10)
    for name, speed in (("slow", 0.5), ("fast", 2.0)):
        assert sol.body(name).vy[-1] / speed == pytest.approx(returned(DAMPING_MODELS["flores"](0.6)), rel=1e-7)


def test_moving_surfaces_profiles_and_events_do_not_matter() -> None:
    """On a slope, as a profile, with friction, seen from a moving frame, and with events that take steps back."""
    want = returned(DAMPING_MODELS["flores"](0.6))
    m = Mechanism("wall", gravity=None)
    wall, ball = m.body("wall", 900.0, inertia=900.0), m.body("ball", 0.01, inertia=0.01)
    m.contact("hit", wall.at(0.0, 0.0, 0.4), ball.origin, 1e5, restitution=0.6, radius=0.1)
    m.start_near(wall=(0.0, 0.0, 0.0), ball=(-0.2 * math.sin(0.4), 0.2 * math.cos(0.4), 0.0))
    away = np.array([-math.sin(0.4), math.cos(0.4)])
    m.start_moving(wall=(1.0, 2.0, 0.0), ball=(1.0 - 1.5 * away[0], 2.0 - 1.5 * away[1], 0.0))
    m.event("deep", lambda t, state: state.body("ball").y - state.body("wall").y - 0.095)
    sol = m.simulate(0.3, steps=40, tolerance=1e-10)
    relative = np.array([sol.body("ball").vx[-1] - 1.0, sol.body("ball").vy[-1] - 2.0])
    assert relative @ away == pytest.approx(1.5 * want, rel=1e-4)
    m = Mechanism("profile", gravity=None)
    ball = m.body("ball", 0.5, inertia=1.0)
    flat = curve([-1.0, -0.5, 0.5, 1.0], [0.0, 0.0, 0.0, 0.0])
    m.contact("floor", m.ground.origin, ball.origin, 1e5, restitution=0.6, radius=0.1, profile=flat)
    m.start_near(ball=(0.0, 0.12, 0.0))
    m.start_moving(ball=(0.0, -1.5, 0.0))
    assert m.simulate(0.1, steps=10, tolerance=1e-10).body("ball").vy[-1] == pytest.approx(1.5 * want, rel=1e-7)


def test_the_motion_between_outputs_remembers_what_was_before() -> None:
    sol = impact(0.6, "flores", 2.0).simulate(0.06, steps=6, tolerance=1e-11)
    fine = impact(0.6, "flores", 2.0).simulate(0.06, steps=240, tolerance=1e-11)
    at = sol.at(fine.t[1:-1])
    np.testing.assert_allclose(at.body("ball").y, fine.body("ball").y[1:-1], atol=1e-11)
    effort = effort_of(fine, "ground")
    np.testing.assert_allclose(effort_of(at, "ground"), effort[1:-1], atol=1e-6 * effort.max())


def test_a_driven_motion_knows_it_from_its_outputs() -> None:
    m = Mechanism("press", gravity=None)
    ram = m.body("ram", 1.0, inertia=0.1)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), ram.at(0, 0, math.pi / 2))
    m.contact("stock", m.ground.origin, ram.origin, 1e4, 1.0, restitution=0.5)
    m.drive_coordinate("drive", m.ground.at(0, 0, math.pi / 2), ram.origin, harmonic(0.02, 10.0, 0.3, 0.015))
    m.start_near(ram=(0.0, 0.02, 0.0))
    sol = m.sweep(steps=200)
    body, force = sol.body("ram"), sol.force("stock")
    begins = 0.02 * 10.0 * math.sqrt(1 - 0.75**2)  # |rate| where the place is 0
    wanted = 1e4 * np.maximum(-body.y, 0.0) * np.maximum(1 - DAMPING_MODELS["flores"](0.5) * body.vy / begins, 0.0)
    np.testing.assert_allclose(force.effort, wanted, rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(sol.driver("drive").force, body.ay - wanted, atol=1e-3)


def test_rest_and_a_start_within_the_surface_are_finite() -> None:
    m = Mechanism("rest")
    ball = m.body("ball", 0.5, inertia=1.0)
    m.contact("floor", m.ground.origin, ball.origin, 1e4, 1.0, radius=0.1, restitution=0.2, damping_model="flores")
    deep = 0.5 * G / 1e4
    m.start_near(ball=(0.0, 0.1 - deep, 0.0))
    np.testing.assert_allclose(m.simulate(0.1, steps=10).body("ball").y, 0.1 - deep, atol=1e-10)
    m.start_near(ball=(0.0, 0.101, 0.0))
    sol = m.simulate(1.0, steps=100)
    assert abs(sol.body("ball").y[-1] - (0.1 - deep)) < 2e-5
    assert m.equilibrium().body("ball").y == pytest.approx(0.1 - deep, rel=1e-9)


@pytest.mark.parametrize(
    ("numbers", "said"),
    [
        ({"restitution": 1.2}, r"force 'ground': restitution is 1.2; it must be within 0 .. 1"),
        ({"restitution": 0.0}, r"restitution is 0, for which the damping of 'flores' is infinite"),
        ({"restitution": 0.5, "damping": 0.1}, r"damping is 0.1 s/m and restitution 0.5; give one of them"),
        ({"restitution": 0.5, "damping_model": "kelvin"}, r"there is no damping_model 'kelvin'"),
        ({"restitution": 0.5, "least_approach": 0.0}, r"least_approach is 0; it must be positive"),
    ],
)
def test_invalid_requests_are_refused(numbers, said) -> None:
    m = Mechanism("bad")
    ball = m.body("ball", 0.5, inertia=1.0)
    with pytest.raises(ModelError, match=said):
        m.contact("ground", m.ground.origin, ball.origin, 1e5, **numbers)


@pytest.mark.parametrize("method", ["rk4", "radau"])
def test_methods_whose_steps_do_not_end_at_contacts_are_refused(method: str) -> None:
    with pytest.raises(ModelError, match=rf"damping of contact 'ground' depends .* '{method}' do not end there"):
        impact(0.5, "flores", 2.0).simulate(0.1, method=method)


def test_within_a_linkage_the_coordinates_do_not_matter() -> None:
    m = Mechanism("pendulum")
    rod = m.bar("rod", 1.0, 2.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.contact("wall", m.ground.at(0.2, 0, math.pi / 2), rod.end, 1e5, restitution=0.7)
    m.start_near(rod=0.0)
    reference, independent = (
        m.simulate(1.2, steps=60, tolerance=1e-10, formulation=f) for f in ("reference", "independent")
    )
    assert independent.stats.independent
    np.testing.assert_allclose(reference.body("rod").theta, independent.body("rod").theta, atol=1e-7)
    effort = effort_of(reference, "wall")
    np.testing.assert_allclose(effort, effort_of(independent, "wall"), atol=1e-4 * effort.max())
