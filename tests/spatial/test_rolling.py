"""Rolling without slip: coin, ball on an incline and on a turntable against closed forms, energy, errors."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.base.errors import ModelError
from mbsd.spatial import Mechanism, constant_rate

G = 9.81


def coin(lean: float, distance: float, w: tuple[float, float, float]) -> Mechanism:
    """Return a coin of .3 m that leans inwards by ``lean`` (rad), its centre at ``distance`` (m) from the z axis."""
    m = Mechanism("coin", gravity=(0, 0, -G))
    up = np.array([-math.sin(lean), 0.0, math.cos(lean)])
    centre, axis = np.array([distance, 0, 0.3 * up[2]]), (math.cos(lean), 0.0, math.sin(lean))
    body = m.disc("coin", centre, axis, radius=0.3, mass=1.0)
    m.rolling("floor", m.ground, body, at=(0, 0, 0), normal=(0, 0, 1), centre=centre, axis=axis, ring=0.3)
    m.start_moving({"coin": w})
    return m


def test_a_leaning_coin_rolls_round_a_circle() -> None:
    """Closed form of steady rolling at a lean of 20 degrees: turn 1.3984872 rad/s, back after a turn."""
    turn, w = 1.3984872052205763, (-5.706057551947608, 0.0, -0.6783478986982274)
    m = coin(math.radians(20), 1.2, w)
    period = 2 * math.pi / turn
    sol = m.simulate(duration=period, steps=40, tolerance=1e-12)
    place, angle = sol.body("coin").place, turn * sol.t
    assert np.allclose(place[:, 0], 1.2 * np.cos(angle), rtol=0, atol=1e-8)
    assert np.allclose(place[:, 1], 1.2 * np.sin(angle), rtol=0, atol=1e-8)
    assert np.allclose(place[-1], place[0], rtol=0, atol=1e-9)
    assert np.allclose(sol.joint("floor").force[0], (-2.34691975579879, 0.0, 9.81), rtol=0, atol=1e-9)
    assert np.allclose(np.linalg.norm(sol.joint("floor").force, axis=1), math.hypot(2.34691975579879, 9.81), atol=1e-7)
    assert np.ptp(sol.energy.total) < 1e-9
    assert m.mobility().dof == 3


def test_a_wobbling_coin_keeps_its_energy_and_does_not_slip() -> None:
    sol = coin(math.radians(35), 0.5, (-3.0, 0.5, 1.5)).simulate(duration=2.0, steps=200, tolerance=1e-11)
    assert np.ptp(sol.energy.total) < 1e-8
    assert sol.stats.velocity_residual < 1e-10
    body = sol.body("coin")
    axis = body.rotation[:, :, 0]
    up = np.array([0, 0, 1.0]) - axis[:, 2:] * axis
    up /= np.linalg.norm(up, axis=1)[:, None]
    slip = body.velocity - 0.3 * np.cross(body.w, up)
    assert np.abs(slip).max() < 1e-9
    assert np.allclose(body.place[:, 2], 0.3 * up[:, 2], rtol=0, atol=1e-10)


def test_a_ball_rolls_down_an_incline() -> None:
    """Closed form: 5/7 g sin 25 degrees, with friction of 0.1333 at least."""
    tilt = math.radians(25)
    normal, down = np.array([math.sin(tilt), 0, math.cos(tilt)]), np.array([math.cos(tilt), 0, -math.sin(tilt)])
    m = Mechanism("incline", gravity=(0, 0, -G))
    ball = m.ball("ball", 0.1 * normal, radius=0.1, mass=2.0)
    m.rolling("slope", m.ground, ball, at=(0, 0, 0), normal=normal, centre=0.1 * normal, radius=0.1)
    sol = m.simulate(duration=1.0, steps=10, tolerance=1e-11)
    assert np.allclose(sol.body("ball").acceleration @ down, 2.961346534054473, rtol=0, atol=1e-9)
    force = sol.joint("slope").force
    assert np.allclose(-force @ down / (force @ normal), 0.13323075947285673, rtol=0, atol=1e-9)


@pytest.mark.parametrize("start", [(0.3, 0.1, -0.5), (-1.0, 2.0, 0.7)])
def test_a_ball_on_a_turntable_circles_at_two_sevenths(start: tuple[float, float, float]) -> None:
    """Closed form: a uniform ball circles at 2/7 of the table's rate wherever it starts (Weltner 1979)."""
    m = Mechanism("turntable", gravity=(0, 0, -G))
    table = m.disc("table", (0, 0, 0), (0, 0, 1), radius=2.0, mass=5.0, thickness=0.1)
    ball = m.ball("ball", (0.7, 0.2, 0.1), radius=0.1, mass=1.0)
    m.revolute("pivot", m.ground, table, at=(0, 0, 0), axis=(0, 0, 1))
    m.drive_turn("motor", "pivot", constant_rate(3.0))
    m.rolling("rolls", table, ball, at=(0, 0, 0), normal=(0, 0, 1), centre=(0.7, 0.2, 0.1), radius=0.1)
    m.start_moving({"ball": start})
    rate = 0.8571428571428571
    period = 2 * math.pi / rate
    sol = m.simulate(times=[0.0, period / 2, period], tolerance=1e-11)
    body = sol.body("ball")
    assert np.allclose(body.place[2], body.place[0], rtol=0, atol=1e-8)
    assert np.allclose(body.velocity[1], -body.velocity[0], rtol=0, atol=1e-8)
    assert np.allclose(body.acceleration, rate * np.cross([0, 0, 1.0], body.velocity), rtol=0, atol=1e-8)


def test_rolling_that_cannot_be_is_refused() -> None:
    m = coin(0.1, 1.0, (0.0, 0.0, 0.0))
    with pytest.raises(ModelError, match=r"'floor' rolls, so no value of the drivers says where it is. Call simulate"):
        m.sweep(duration=1.0)
    with pytest.raises(ModelError, match="needs radius= of a ball or ring= of a disc"):
        m.rolling("other", m.ground, "coin", at=(0, 0, 0), normal=(0, 0, 1), centre=(0, 0, 1))
    with pytest.raises(ModelError, match=r"radius is -0\.1"):
        m.rolling("other", m.ground, "coin", at=(0, 0, 0), normal=(0, 0, 1), centre=(0, 0, 1), radius=-0.1)
