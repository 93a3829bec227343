"""Contacts that separate too slowly for a rebound, beside joints that stick."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import final

G = 9.80665


@pytest.mark.parametrize("speed", [0.0, 5e-6, 2e-5])
def test_a_rebound_too_slow_to_count_frees_no_joint(speed: float) -> None:
    """A lever that static friction alone holds, and a ball that leaves it so slowly that it stays."""
    m = Mechanism("lifted lever")
    lever, ball = m.body("lever", 1.0, inertia=0.1), m.body("ball", 0.5, inertia=1e-3)
    m.revolute("pin", m.ground.origin, lever.origin)
    m.friction("rub", "pin", 0.2, static=0.5, stribeck=1e-6, radius=0.2, sticks=True)
    m.rigid_contact("touch", lever.origin, ball.origin, radius=0.02)
    m.torque("lift", lever, 0.5 * G * 0.3 + 0.9 * 0.5 * 0.2 * 1.5 * G)
    m.start_near(lever=0, ball=(0.3, 0.02, 0))
    m.start_moving(ball=(0.0, speed, 0.0))
    sol = m.simulate(0.3, steps=30)
    assert sorted((event.name, event.what) for event in sol.events) == [("rub", "sticks"), ("touch", "closes")]
    np.testing.assert_allclose(sol.body("lever").theta, 0.0, atol=1e-15)
    np.testing.assert_allclose(sol.body("ball").y, 0.02, atol=1e-15)
    many = m.simulate_many(0.3, vary={"ball": {"mass": [0.5]}}, measure={"angle": final("lever.theta")}, steps=30)
    assert many.alone == [None], many.way
    assert abs(many["angle"][0]) < 1e-15
