"""Mechanisms of the gallery that live from contact, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mechanisms.reflective_wall import mechanism as wall


def _folded(way: np.ndarray, low: float, high: float) -> np.ndarray:
    """Where a point is that is reflected at both ends: its straight way, folded (method of images)."""
    return high - np.abs(np.mod(way - low, 2 * (high - low)) - (high - low))


def test_reflected_ball_runs_straight_in_the_unfolded_room() -> None:
    p = wall.Params()
    sol = wall.build(p).simulate(wall.DURATION, 480, tolerance=1e-11)
    ball, fall = sol.body("ball"), math.sqrt(2 * p.height / p.gravity)
    x = _folded(p.start + wall.speed(p) * sol.t, p.radius, p.width - p.radius)
    since = np.mod(sol.t + fall, 2 * fall) - fall  # the last or next top of its way
    y = p.radius + p.height - p.gravity * since**2 / 2
    np.testing.assert_allclose(ball.x, x, atol=1e-10)
    np.testing.assert_allclose(ball.y, y, atol=1e-10)
    closed = p.rhythm[0] * 2 * fall
    assert closed == pytest.approx(wall.DURATION / 2)
    at = int(np.argmin(np.abs(sol.t - closed)))
    np.testing.assert_allclose([ball.x[at], ball.y[at]], [ball.x[0], ball.y[0]], atol=1e-9)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-12


def test_lossy_walls_take_their_part_of_the_speed_across() -> None:
    """It crosses ever more slowly: the k-th way takes e^-k of the first one's time; bounces take e^k of it."""
    p = wall.Params(**wall.VARIANTS["lossy"])
    sol = wall.build(p).simulate(wall.DURATION, 480, tolerance=1e-11)
    e, speed, room = p.restitution, wall.speed(p), p.width - 2 * p.radius
    hits = [event.time for event in sol.events if event.what == "impact" and event.name != "floor"]
    ways = np.array([p.width - p.radius - p.start] + [room] * (len(hits) - 1))
    np.testing.assert_allclose(hits, np.cumsum(ways / (speed * e ** np.arange(len(hits)))), rtol=1e-9)
    floor = [event.time for event in sol.events if event.what == "impact" and event.name == "floor"][:6]
    fall = math.sqrt(2 * p.height / p.gravity)
    np.testing.assert_allclose(np.diff(floor), 2 * fall * e ** np.arange(1, len(floor)), rtol=1e-9)
    lost = sum(event.energy or 0.0 for event in sol.events)
    assert sol.energy.total[-1] - sol.energy.total[0] == pytest.approx(lost, rel=1e-9)


def test_soft_floor_is_pressed_in_as_hertz_says() -> None:
    """Energy at the deepest point: k d^(n+1) / (n+1) = m g (h + d)."""
    p = wall.Params(**wall.VARIANTS["soft"])
    sol = wall.build(p).simulate(0.25, 5000, tolerance=1e-11)
    depth = p.radius - sol.body("ball").y.min()
    stored = p.stiffness * depth**2.5 / 2.5
    assert stored == pytest.approx(p.mass * p.gravity * (p.height + depth), rel=1e-3)
