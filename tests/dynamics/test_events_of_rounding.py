"""Events whose functions are decided by rounding: once where they come to zero, or an error that names them."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError
from mbsd.measures import final

ANGLE = 0.2
C, S = math.cos(ANGLE), math.sin(ANGLE)
LANDS = math.sqrt(2 * 0.05 / (9.80665 * C))
DURATIONS = [0.28, 0.35, 0.57, 1.02, 1.25, 1.7]
"""s; events came at other times in each, or ended in an error of scipy."""


def thrown_box() -> Mechanism:
    """A box that falls onto a slope and slides down it on two feet."""
    m = Mechanism("box")
    box = m.body("box", 2.0, (0.0123, 0.0331), inertia=0.01)
    for name, x in (("left", -0.1), ("right", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0, ANGLE), box.at(x, 0, 0), friction=0.1)
    m.start_near(box=(-0.05 * S, 0.05 * C, math.degrees(ANGLE)))
    m.start_moving(box=(3.0 * C, 3.0 * S, 0))
    return m


@numba.njit
def leaving(t: float, q: np.ndarray, v: np.ndarray) -> float:
    """The speed away from the slope (m/s)."""
    return -S * v[0] + C * v[1]


@numba.njit
def sign(t: float, q: np.ndarray, v: np.ndarray) -> float:
    """Its sign."""
    return 1.0 if leaving(t, q, v) > 0.0 else -1.0


@pytest.mark.parametrize("duration", DURATIONS)
@pytest.mark.parametrize("value", [leaving, sign])
def test_a_speed_that_a_contact_takes_away_comes_to_zero_once_and_then(value, duration: float) -> None:  # type: ignore[no-untyped-def]
    m = thrown_box()
    m.event("lies", value, frames=[m.bodies["box"].origin])
    times = [event.time for event in m.simulate(duration, steps=10).events if event.name == "lies"]
    assert times == [pytest.approx(LANDS, rel=1e-9)]


def test_the_loop_over_many_meets_it_as_single_simulations_do() -> None:
    m = thrown_box()
    m.event("lies", leaving, frames=[m.bodies["box"].origin], terminal=True)
    many = m.simulate_many(
        1.0, vary={"box": {"mass": [1.0, 2.0, 3.0]}}, measure={"t": final("t"), "x": final("box.x")}, steps=20
    )
    assert many.alone == [None] * 3
    np.testing.assert_allclose(many["t"], LANDS, rtol=1e-9)
    np.testing.assert_allclose(many["x"], m.simulate(1.0, steps=20).body("box").x[-1], rtol=1e-9)


def test_a_block_that_friction_stops_has_stopped() -> None:
    """Its speed comes to zero just when the contact begins to hold it."""
    m = Mechanism("block")
    block = m.body("block", 2.0, inertia=1.0)
    m.rigid_contact("floor", m.ground.origin, block.origin, friction=0.4)
    m.start_near(block=(0, 0, 0))
    m.start_moving(block=(1.0, 0, 0))
    m.event("stops", lambda t, moment: moment.body("block").vx, direction=-1, terminal=True)
    for duration in (0.5, 1.0, 3.0):
        sol = m.simulate(duration)
        assert sol.events[-1].what == "end"
        assert sol.t[-1] == pytest.approx(1.0 / (0.4 * 9.80665), rel=1e-9)


def test_what_rounding_alone_decides_is_an_error_that_names_the_event() -> None:
    """The angular velocity of a box on two feet is zero but for rounding."""
    refused = []
    for duration in np.linspace(0.7, 2.0, 12):
        m = thrown_box()
        m.event("odd", lambda t, moment: 0.5 - t if moment.body("box").omega > 0 else t - 0.7)
        try:
            m.simulate(float(duration), steps=10)
        except ModelError as error:
            refused.append(str(error))
    assert refused
    assert all("event 'odd' at t = " in words and "smooth in time and motion" in words for words in refused)
