"""The pose at any moment, and the film's clock."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from render.film.clock import Clock
from render.film.poses import Moment, Poses, hermite
from shared.contract.shot import Shot
from tools.models.motions import bouncing_ball, four_bar_motion

MOTION = four_bar_motion()
FINE = four_bar_motion(steps=360 * 7)


@given(st.lists(st.floats(-2, 2), min_size=6, max_size=6), st.floats(0, 1))
def test_a_quintic_is_reproduced_exactly(coefficients: list[float], t: float):
    f = np.polynomial.Polynomial(coefficients)
    time = np.array([0.0, 0.3, 0.4, 1.0])
    interpolated = hermite(time, f(time), f.deriv(1)(time), f.deriv(2)(time), t)
    assert interpolated[0] == pytest.approx(f(t), abs=1e-12)


def test_between_samples_the_four_bar_is_met_to_a_picometre():
    poses = Poses(MOTION)
    for name, body in FINE.bodies.items():
        interpolated = np.array([poses.body(name, Moment(t, 0)) for t in FINE.time])
        exact = np.stack([body.x, body.y, body.theta], axis=1)
        assert np.abs(interpolated - exact).max() < 1e-10
    path = poses.point("P", np.asarray(FINE.time))
    assert np.abs(path - np.stack([FINE.points["P"].x, FINE.points["P"].y], axis=1)).max() < 1e-12


@given(st.integers(-500, 500), st.integers(1, 240))
def test_the_film_loops_without_a_jump(frame: int, count: int):
    poses = Poses(MOTION)
    clock = Clock(MOTION, Shot(seconds_per_turn=float(count), fps=1))
    now, later = clock.moment(frame), clock.moment(frame + count)
    assert now.time == later.time
    for name in MOTION.bodies:
        x, y, theta = poses.body(name, now)
        x1, y1, theta1 = poses.body(name, later)
        assert (x, y) == (x1, y1)
        turn = math.tau if name == "crank" else 0.0
        assert theta1 - theta == pytest.approx(turn, abs=1e-12)


def test_angles_go_on_over_the_seam():
    poses, clock = Poses(MOTION), Clock(MOTION, Shot(seconds_per_turn=12.0, fps=1))
    angles = [poses.body("crank", clock.moment(frame))[2] for frame in range(-3, 30)]
    assert np.diff(angles) == pytest.approx(math.tau / 12)


def test_a_joint_moves_with_its_second_body():
    poses = Poses(MOTION)
    for name, joint in MOTION.joints.items():
        for index in range(0, 360, 17):
            assert poses.joint(name, Moment(MOTION.time[index], 0)) == pytest.approx(
                (joint.x[index], joint.y[index]), abs=1e-9
            )


@pytest.mark.parametrize("cut", [0, 1])
def test_an_impact_is_met_from_both_sides(cut: int) -> None:
    """Free flight is a parabola, so quintics are exact before, at and after the impact; ``cut``: it comes last."""
    ball = bouncing_ball(steps=6)
    strike = ball.events[0].time
    poses = Poses(ball)
    if cut:
        poses.time = poses.time[: ball.time.index(strike) + 2]
    for t in np.linspace(0.0, strike if cut else ball.time[-1], 41):
        x, y, theta = poses.body("ball", Moment(float(t), 0))
        late = t - strike
        exact = 1 - 9.81 * t * t / 2 if t < strike else 0.5 * 9.81 * strike * late - 9.81 * late**2 / 2
        assert y == pytest.approx(exact, abs=1e-12)
        assert (x, theta) == (0.0, 0.0)
