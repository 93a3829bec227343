"""Steps that end where contacts begin and end: closed forms, energy, and evaluations that do not run away."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.motion import to_end
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.simulate import integrator_named
from mbsd.dynamics.state import EVALUATIONS

GRAVITY = 10.0


def falling(height: float, stiffness: float, mass: float = 1.0, exponent: float = 1.0) -> Mechanism:
    """A ball on a guide above a floor."""
    m = Mechanism("ball", gravity=(0.0, -GRAVITY))
    ball = m.body("ball", mass, inertia=1.0)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), ball.at(0, 0, math.pi / 2))
    m.contact("floor", m.ground.origin, ball.origin, stiffness, exponent=exponent)
    m.start_near(ball=(0.0, height, 0.0))
    return m


def moved(m: Mechanism, times: np.ndarray, tolerance: float, formulation: str) -> tuple[np.ndarray, int]:
    """Coordinates and velocities (T, 2, 3 nb), and evaluations."""
    ready = prepare_dynamics(m, float(times[0]), float(times[-1]))
    state, out = ready.begun(times)
    duration = float(times[-1] - times[0])
    run = Run(ready, integrator_named(m.name, "dop853"), tolerance, duration, duration, {}, formulation)
    to_end(run, state, out)
    return out.y, int(state.count[EVALUATIONS])


def exact(times: np.ndarray, height: float, omega: float) -> tuple[np.ndarray, float]:
    """Heights by falls and half swings on a linear floor, and the time of a bounce."""
    speed, sag = math.sqrt(2 * GRAVITY * height), GRAVITY / omega**2
    touch = 2 * (math.pi - math.atan2(speed / omega, sag)) / omega
    fall = speed / GRAVITY
    rest = (times + fall) % (touch + 2 * fall)
    flight = speed * rest - 0.5 * GRAVITY * rest**2
    swing = omega * (rest - 2 * fall)
    return np.where(
        rest < 2 * fall, flight, sag * (np.cos(swing) - 1) - speed / omega * np.sin(swing)
    ), touch + 2 * fall


@settings(max_examples=8, deadline=None)
@given(
    height=st.floats(0.05, 20.0),
    stiffness=st.floats(3.0, 9.0).map(lambda power: 10.0**power),
    mass=st.floats(-2.0, 1.0).map(lambda power: 10.0**power),
    tolerance=st.sampled_from([1e-6, 1e-8, 1e-10]),
    formulation=st.sampled_from(["auto", "reference"]),
)
@example(height=1.0, stiffness=1e8, mass=1.0, tolerance=1e-7, formulation="auto")
def test_a_ball_bounces_as_the_closed_form_says(
    height: float, stiffness: float, mass: float, tolerance: float, formulation: str
) -> None:
    omega = math.sqrt(stiffness / mass)
    _, period = exact(np.zeros(1), height, omega)
    times = np.linspace(0.0, 3.3 * period, 24)
    y, evaluations = moved(falling(height, stiffness, mass), times, tolerance, formulation)
    wanted, _ = exact(times, height, omega)
    speed = math.sqrt(2 * GRAVITY * height)
    np.testing.assert_allclose(y[:, 0, 4], wanted, atol=1e3 * tolerance * (1 + height + speed * period))
    stored = 0.5 * stiffness * np.minimum(y[:, 0, 4], 0.0) ** 2
    energy = mass * (0.5 * y[:, 1, 4] ** 2 + GRAVITY * y[:, 0, 4]) + stored
    np.testing.assert_allclose(energy, energy[0], atol=1e3 * tolerance * mass * (1 + speed) ** 2)
    assert evaluations < 1600 * (1e-6 / tolerance) ** 0.125 + 600


def test_the_stiff_bounces_of_the_benchmark_take_a_third_of_the_evaluations() -> None:
    """By error control alone they took 2043, with an error of 1.5e-5 m."""
    y, evaluations = moved(falling(1.0, 1e8), np.array([0.0, 3.0]), 1e-7, "auto")
    assert evaluations < 750
    assert abs(y[-1, 0, 4] - exact(np.array([3.0]), 1.0, 1e4)[0][0]) < 5e-7


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.0, 2.7])
def test_forces_that_grow_with_a_power_keep_energy(exponent: float) -> None:
    y, _ = moved(falling(0.3, 1e7, exponent=exponent), np.linspace(0.0, 1.5, 20), 1e-8, "auto")
    depth = np.maximum(-y[:, 0, 4], 0.0)
    energy = 0.5 * y[:, 1, 4] ** 2 + GRAVITY * y[:, 0, 4] + 1e7 * depth ** (exponent + 1) / (exponent + 1)
    np.testing.assert_allclose(energy, 3.0, atol=3e-6)


def test_a_floor_that_is_only_just_touched_or_missed_does_nothing() -> None:
    """A spring's lowest point is at the floor to within a nanometre."""
    for gap in (-1e-9, 0.0, 1e-9):
        m = Mechanism("grazing", gravity=None)
        ball = m.body("ball", 1.0, inertia=1.0)
        m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), ball.at(0, 0, math.pi / 2))
        m.spring("spring", m.ground.at(0, 10.0), ball.origin, 100.0, free_length=9.0)
        m.contact("floor", m.ground.at(0, -gap), ball.origin, 1e4, exponent=1.0)
        m.start_near(ball=(0.0, 2.0, 0.0))
        times = np.linspace(0.0, 4.0, 30)
        y, evaluations = moved(m, times, 1e-8, "auto")
        np.testing.assert_allclose(y[:, 0, 4], 1.0 + np.cos(10.0 * times), atol=1e-5)
        assert evaluations < 4000


def test_a_ball_lies_still_and_is_lifted_when_pulled() -> None:
    """At the depth of its weight it rests; a spring of 12 N lifts it."""
    for lifts in (False, True):
        m = Mechanism("lying", gravity=(0.0, -GRAVITY))
        ball = m.body("ball", 1.0, inertia=1.0)
        m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), ball.at(0, 0, math.pi / 2))
        m.contact("floor", m.ground.origin, ball.origin, 1e6, exponent=1.0)
        if lifts:
            m.spring("pull", m.ground.at(0, 1.0), ball.origin, 24.0, free_length=0.5)
        m.start_near(ball=(0.0, -1e-5, 0.0))
        y, _ = moved(m, np.linspace(0.0, 0.2, 9), 1e-8, "auto")
        assert (y[-1, 0, 4] > 0.01) == lifts
        if not lifts:
            np.testing.assert_allclose(y[:, 0, 4], -1e-5, atol=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 1e-9, 1e-6, 1e-3, 5.0])
def test_corners_that_touch_together_and_one_after_the_other(tilt: float) -> None:
    """A box on four corners, damped: the same at two tolerances, and the evaluations are few."""
    last_states = []
    for tolerance in (1e-6, 1e-9):
        m = Mechanism("box", gravity=(0.0, -GRAVITY))
        box = m.body("box", 2.0, inertia=0.05)
        for k, (x, y) in enumerate([(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1)]):
            m.contact(
                f"{k}", m.ground.origin, box.at(x, y), 1e6, exponent=1.0, damping=0.3, friction=0.3, slip_speed=0.01
            )
        m.start_near(box=(0.0, 0.2, tilt))
        y, evaluations = moved(m, np.linspace(0.0, 0.25, 6), tolerance, "auto")
        last_states.append(y[-1])
        assert evaluations < 4000
    np.testing.assert_allclose(last_states[0], last_states[1], atol=1e-3)


def test_runs_repeated_are_the_same_to_the_last_digit() -> None:
    m = falling(0.3, 1e6, exponent=1.5)
    ready = prepare_dynamics(m, 0.0, 1.0)
    outputs = []
    for _ in range(2):
        state, out = ready.begun(np.linspace(0.0, 1.0, 5))
        to_end(Run(ready, integrator_named("ball", "dop853"), 1e-7, 1.0, 1.0, {}), state, out)
        outputs.append(out.y)
    assert np.array_equal(*outputs)
