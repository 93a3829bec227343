"""An event whose value stays zero once it has happened happens once, and again only after it has left zero."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, polynomial, speed_reaches
from mbsd.measures import final

G = 9.81


def falling_arm(level: float, noted: bool = False) -> Mechanism:
    """A bar that falls about its hinge until it turns at ``level`` (rad/s), and then flies, turning as fast."""
    m = Mechanism("loose", gravity=(0, -G))
    arm = m.bar("arm", 1.0, mass=1.0)
    hinge = m.revolute("hinge", m.ground.at(0, 0), arm.start)
    m.event("gone", speed_reaches(arm, level), releases=[hinge])
    if noted:
        m.event("seen", speed_reaches(arm, level))
    m.start_near(arm=0)
    return m


def fall(level: float) -> float:
    """Angle (rad) at which a falling bar turns at ``level`` (rad/s): w^2 = 3 g sin(angle) / l, downwards."""
    return -math.asin(level**2 / (3 * G))


@settings(max_examples=30, suppress_health_check=[HealthCheck.too_slow])
@given(
    level=st.floats(-4.5, -0.2).map(lambda level: round(level, 3)),
    tolerance=st.sampled_from([1e-4, 1e-7, 1e-10]),
    steps=st.sampled_from([2, 50]),
    noted=st.booleans(),
)
def test_a_bar_that_keeps_its_speed_in_free_flight_lets_go_once(
    level: float, tolerance: float, steps: int, noted: bool
) -> None:
    sol = falling_arm(level, noted).simulate(2.0, steps=steps, tolerance=tolerance)
    names = [event.name for event in sol.events]
    assert names.count("gone") == 1
    assert names.count("seen") <= 1  # it is at its level when the bar lets go, on whichever side rounding has it
    near = 1e-9 + 30.0 * tolerance
    np.testing.assert_allclose(sol.body("arm").omega[-1], level, atol=near)
    when = sol.events[0].time
    np.testing.assert_allclose(sol.body("arm").theta[-1], fall(level) + level * (2.0 - when), atol=10.0 * near)


@numba.njit
def brake(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
    """Slows from 2 to 3 s, and speeds up from 3 to 5 s, by 1 rad/s^2."""
    return 0.0, 0.0, -1.0 if 2.0 < t <= 3.0 else 1.0 if 3.0 < t < 5.0 else 0.0


@pytest.mark.parametrize("shift", [0.0, 0.3], ids=["as it is", "turned"])
def test_it_happens_again_where_it_left_zero_and_comes_back(shift: float) -> None:
    """A motor lets go of a wheel at 2 rad/s, which then turns as fast for a second."""
    m = Mechanism("wheel", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=1.0)
    m.revolute("axle", m.ground.at(0, 0, shift), wheel.at(0, 0, -shift))
    motor = m.drive_angle("motor", wheel, polynomial(0.0, 0.0, 1.0))
    m.event("fast", speed_reaches(wheel, 2.0), releases=[motor])
    m.user_force("brake", brake, wheel)
    sol = m.simulate(6.0, steps=600)
    assert [event.name for event in sol.events] == ["fast", "fast"]
    np.testing.assert_allclose([event.time for event in sol.events], [1.0, 4.0], atol=1e-4)
    np.testing.assert_allclose(sol.body("wheel").omega[-1], 3.0, atol=1e-4)
    many = m.simulate_many(6.0, measure={"w": final("wheel.omega")}, vary={"wheel": {"inertia": [1.0]}}, steps=600)
    np.testing.assert_allclose(many["w"], sol.body("wheel").omega[-1], atol=1e-7)


def test_names_of_columns_need_no_event() -> None:
    """An action that fails at the start is the reason of its rows, not an error of the call."""
    m = Mechanism("bad", gravity=None)
    body = m.body("stone", 1.0, inertia=1.0)
    m.event("now", lambda t, moment: t - 5e-10, action=lambda moment: 1 / 0)
    many = m.simulate_many(1.0, moving={"stone": [(1.0, 0.0, 0.0)]}, measure={"x": final(f"{body.name}.x")}, steps=4)
    assert not many.good.any()
    assert "now" in str(many.reason[0])
