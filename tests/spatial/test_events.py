"""Events of the user in space: times of closed forms, terminal ones, actions, frames, rows beside events, errors."""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest
from scipy.special import ellipk

from mbsd.base.errors import ModelError
from mbsd.spatial import Mechanism
from tests.spatial import machines

G = 9.81


def pendulum(axis: tuple[float, float, float] = (0, 1, 0)) -> Mechanism:
    """Return a uniform rod of 1 m that falls from the horizontal."""
    m = Mechanism("pendulum", gravity=(0, 0, -G))
    rod = m.rod("rod", (0, 0, 0), (1, 0, 0), mass=1.0, radius=0.01)
    m.revolute("hinge", m.ground, rod, at=(0, 0, 0), axis=axis)
    m.trace("tip", rod, at=(1, 0, 0))
    return m


def quarter() -> float:
    """Return the time (s) from the horizontal to the vertical, by an elliptic integral."""
    moment = (3 * 0.01**2 + 1.0) / 12 + 0.25
    return math.sqrt(moment / (G * 0.5)) * float(ellipk(0.5))


def test_events_happen_at_the_times_of_elliptic_integrals() -> None:
    m = pendulum()
    m.event("low", lambda t, moment: moment.joint("hinge").turn - math.pi / 2)
    m.event("turns back", lambda t, moment: moment.body("rod").w[1], direction=-1)
    m.event("never", lambda t, moment: moment.point(m.traces["tip"]).place[2] - 0.1)
    sol = m.simulate(duration=3.0, steps=30, tolerance=1e-11, event_rows=True)
    assert [(e.name, e.what) for e in sol.events] == [
        (n, "event") for n in ("low", "turns back", "low", "low", "turns back")
    ]
    wanted = quarter() * np.array([1, 2, 3, 5, 6])
    assert np.allclose([e.time for e in sol.events], wanted, rtol=0, atol=1e-9)
    assert len(sol.t) == 31 + 2 * 5
    beside = np.isclose(sol.t, wanted[0], rtol=0, atol=1e-8)
    assert beside.sum() == 2
    assert np.allclose(sol.point("tip").place[beside], (0, 0, -1), rtol=0, atol=1e-8)
    assert np.allclose(sol.joint("hinge").turn[beside], math.pi / 2, rtol=0, atol=1e-9)
    assert sol.stats.position_residual < 1e-10


def test_a_terminal_event_ends_the_simulation_with_its_row() -> None:
    m = pendulum()
    m.event("low", lambda t, moment: moment.joint("hinge").turn - math.pi / 2, terminal=True)
    sol = m.simulate(duration=3.0, steps=30, tolerance=1e-11)
    assert sol.t[-1] == pytest.approx(quarter(), abs=1e-9)
    assert [e.what for e in sol.events] == ["end"]
    assert sol.joint("hinge").turn_rate[-1] == pytest.approx(
        math.sqrt(2 * G * 0.5 / ((3e-4 + 1) / 12 + 0.25)), abs=1e-8
    )


def test_turns_are_counted_over_whole_turns() -> None:
    m = Mechanism("wheel", gravity=None)
    wheel = m.disc("wheel", (0, 0, 0), (0, 0, 1), radius=0.1, mass=1.0, thickness=0.01)
    m.revolute("shaft", m.ground, wheel, at=(0, 0, 0), axis=(0, 0, 1))
    m.start_moving({"shaft": 5.0})
    m.event("twenty", lambda t, moment: moment.joint("shaft").turn - 20.0)
    sol = m.simulate(duration=10.0, steps=50, tolerance=1e-9)
    assert [e.time for e in sol.events] == pytest.approx([4.0], abs=1e-8)


@pytest.mark.parametrize("compiled", [True, False])
def test_an_action_turns_a_velocity_round(compiled: bool) -> None:
    """A ball that is thrown up and bounces from a wall with half of its speed, by frames and their numbers."""

    def wall(t, q, v):
        return 1.0 - q[0]

    def bounce(t, q, v):
        return -0.5 * v[0], v[1], v[2], v[3], v[4], v[5]

    m = Mechanism("ball", gravity=(0, 0, -G))
    ball = m.body("ball", 1.0, com=(0.2, 0, 0), inertia=(0.1, 0.2, 0.3), orientation=(0.5, 0.1, -0.3, 0.2))
    mark = ball.marker((0.2, 0, 0))
    given = (numba.njit(wall), numba.njit(bounce)) if compiled else (wall, bounce)
    m.event("wall", given[0], action=given[1], frames=mark)
    m.event(
        "throw", lambda t, moment: t - 1e-3, action=lambda moment: moment.set_velocity("ball", (2, 0, 3), (0, 0, 1))
    )
    m.trace("middle", ball, at=tuple(mark.world_place))
    sol = m.simulate(duration=2.0, steps=20, tolerance=1e-11)
    (wall_time,) = [e.time for e in sol.events if e.name == "wall"]
    start, arm = mark.world_place, mark.world_place - np.zeros(3)
    speed = np.array([2.0, 0, 3.0]) + np.cross([0, 0, 1.0], arm)
    assert wall_time == pytest.approx(1e-3 + (1.0 - start[0]) / speed[0], abs=1e-8)
    middle = sol.point("middle")
    after = sol.t > wall_time
    assert np.allclose(middle.velocity[after, 0], -0.5 * speed[0], rtol=0, atol=1e-8)
    place = 1.0 - 0.5 * speed[0] * (sol.t[after] - wall_time)
    assert np.allclose(middle.place[after, 0], place, rtol=0, atol=1e-8)


def test_events_of_a_loop_with_redundant_joints() -> None:
    """Bricard's loop: the same times by events and by the outputs of a fine simulation."""
    m = machines.bricard()
    m.gravity = (0.0, -G, 0.0)
    m.event("P3 passes", lambda t, moment: moment.point(m.traces["P3"]).place[0])
    sol = m.simulate(duration=4.0, steps=8, tolerance=1e-10)
    times = [e.time for e in sol.events]
    assert len(times) == 2
    there = m.simulate(times=[0.0, *times], tolerance=1e-10).point("P3").place[1:, 0]
    assert np.abs(there).max() < 1e-7
    assert np.ptp(sol.energy.total) < 1e-6


def test_what_is_no_event_is_refused() -> None:
    m = pendulum()
    with pytest.raises(ModelError, match="event 'a': value is 3; it must be a function"):
        m.event("a", 3)  # pyright: ignore[reportArgumentType]
    with pytest.raises(ModelError, match="direction is 2"):
        m.event("a", lambda t, moment: t, direction=2)
    with pytest.raises(ModelError, match="no body 'rodd', did you mean 'rod'"):
        m.event("a", lambda t, q, v: t, frames="rodd")
    with pytest.raises(ModelError, match=r"compiled with numba.*frames="):
        m.event("a", numba.njit(lambda t, moment: t))
    m.event("typo", lambda t, moment: moment.body("rd").w[0])
    with pytest.raises(ModelError, match=r"event 'typo'.*no body 'rd', did you mean 'rod'"):
        m.simulate(duration=1.0)
    other = pendulum()
    other.event("NaN", lambda t, moment: math.nan)
    with pytest.raises(ModelError, match=r"event 'NaN' is nan at t = 0 s"):
        other.simulate(duration=1.0)
    endless = pendulum()
    endless.event(
        "again",
        lambda t, moment: t - 0.1 - moment.body("rod").w[1],
        action=lambda moment: moment.set_velocity("rod", (0, 0, 0), (0, 0, 0)),
    )
    with pytest.raises(ModelError, match="there are two of the name 'again'"):
        endless.event("again", lambda t, moment: t)
