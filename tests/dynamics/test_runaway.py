"""Motions that grow without bound in finite time end early and say under which force; fast ones go on."""

from __future__ import annotations

import re

import numba
import numpy as np
import pytest

from mbsd import Mechanism, SimulationError
from mbsd.measures import final


def pushed(torque, mass: float = 1.0) -> Mechanism:
    m = Mechanism("runaway", gravity=None)
    arm = m.bar("arm", 1.0, mass=mass)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.user_force("push", torque, arm)
    m.torsion_spring("other", m.ground, arm, 1.0, 0.0)
    m.start_near(arm=57.0)
    return m


@numba.njit
def cubic(t, q, v):
    return 0.0, 0.0, 5.0 * q[2] ** 3


@numba.njit
def growing_saturated(t, q, v):
    return 0.0, 0.0, 5.0 * min(q[2], 30.0) ** 3


def test_growth_in_finite_time_ends_within_a_few_thousand_steps() -> None:
    for mass in (1.0, 2.0):
        with pytest.raises(SimulationError, match="moves without bound: under force 'push'") as failed:
            pushed(cubic, mass).simulate(20.0, steps=10, formulation="reference")
        text = str(failed.value)
        seen, ends = (float(re.search(rf"{word} t = ([0-9.]+)", text)[1]) for word in ("at", "ends at"))  # pyright: ignore[reportOptionalSubscript]
        assert seen < ends < seen + 1e-3
        assert "Limit force 'push'" in text
    # theta'' = k theta^3 from theta_0 at rest: t_e = 1.31103 sqrt(2 / k) / theta_0, less the other force's delay
    ideal = 1.31103 * np.sqrt(2.0 / (3.0 * 5.0 / 2.0)) / np.radians(57.0)
    assert ideal < ends < 1.1 * ideal


def test_the_loop_over_many_gives_such_a_row_up_early() -> None:
    many = pushed(cubic).simulate_many(
        20.0, vary={"arm": {"mass": [1.0, 2.0]}}, measure={"x": final("arm.theta")}, steps=10, formulation="reference"
    )
    assert all("moves without bound" in str(reason) for reason in many.reason)
    assert many.alone == ["it takes more than 200000 steps"] * 2


def test_growth_that_ends_is_followed_to_the_end() -> None:
    sol = pushed(growing_saturated).simulate(0.7, steps=20, formulation="reference")
    omega = sol.body("arm").omega
    assert omega[-1] > 5e4
    np.testing.assert_allclose(omega[-1] - omega[-2], 5.0 * 30.0**3 * 3.0 * 0.035, rtol=0.1)  # the other force brakes


def test_exponential_growth_goes_on() -> None:
    m = Mechanism("thrown", gravity=None)
    ball = m.body("ball", mass=1.0, inertia=1.0)
    m.user_force("away", numba.njit(lambda t, q, v: (4.0 * q[0], 0.0, 0.0)), ball)
    m.start_near(ball=(1.0, 0.0, 0.0))
    sol = m.simulate(20.0, steps=20, tolerance=1e-10)
    np.testing.assert_allclose(sol.body("ball").x[-1], np.cosh(40.0), rtol=1e-6)
    assert sol.body("ball").vx[-1] > 1e17


def test_steps_that_become_too_small_name_the_force_that_grows() -> None:
    m = Mechanism("thrown", gravity=None)
    ball = m.body("ball", mass=1.0, inertia=1.0)
    m.user_force("away", numba.njit(lambda t, q, v: (q[0] ** 2 + 1.0, 0.0, 0.0)), ball)
    with pytest.raises(SimulationError, match="'ball' moves without bound: under force 'away'"):
        m.simulate(20.0, steps=20)
