"""Where a force jumps at a known time data.json has a row right before and one right after, which share that time."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from mbsd import Mechanism, Motion, Solution, function
from mbsd.drawing.animation.clip import at_times
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.motion_file import to_motion
from shared.contract.consistency import refuse_inconsistent_motion

JUMP = 0.3003


def _step(before: float, after: float) -> Motion:
    return function(lambda t: before if t < JUMP else after)


def _sledge(push: Motion) -> Mechanism:
    m = Mechanism("sledge")
    sled = m.body("sled", mass=2.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, sled.origin)
    m.force("push", sled.origin, push)
    return m


def _solved(m: Mechanism, **constants: float) -> Solution:
    solution = solving.motion_of(m.name, SimpleNamespace(**constants), m, None)
    masses = dict.fromkeys((name for name in m.bodies if name != "ground"), "mechanism")
    refuse_inconsistent_motion(to_motion(solution, None, "", {}, masses), "data.json")
    return solution


def _twins(solution: Solution) -> tuple[int, int]:
    """The only two rows that share a time."""
    (first,) = np.flatnonzero(np.diff(solution.t) == 0)
    return int(first), int(first) + 1


@pytest.mark.parametrize("steps", [{}, {"STEPS": 50}, {"STEPS": 100, "DURATION": 2 * JUMP}])
def test_a_force_that_steps_has_two_rows(steps: dict[str, float]) -> None:
    """Also where the step falls on a time of output, as the middle one of the last case does."""
    solution = _solved(_sledge(_step(4.0, -8.0)), **{"DURATION": 1.0} | steps)
    both = list(_twins(solution))
    assert solution.t[both] == pytest.approx(JUMP, abs=1e-12)
    assert solution.body("sled").ax[both] == pytest.approx([2.0, -4.0])
    assert solution.force("push").on("sled").fx[both] == pytest.approx([4.0, -8.0])
    assert solution.body("sled").vx[both] == pytest.approx([2.0 * JUMP] * 2)
    assert [(event.name, event.what, event.time) for event in solution.events] == [
        ("push", "jumps", solution.t[both[0]])
    ]


def test_a_bend_is_no_jump_and_what_was_asked_for_stays() -> None:
    bent = function(lambda t: abs(t - 0.5), breaks=[0.5])
    solution = _solved(_sledge(bent), DURATION=1.0, STEPS=50)
    np.testing.assert_allclose(solution.t, np.linspace(0.0, 1.0, 51), rtol=0.0, atol=1e-15)
    assert solution.events == ()


def test_a_force_of_the_user_that_steps_has_two_rows() -> None:
    m = _sledge(function(lambda t: 0.0))
    m.user_force("kick", lambda t, q, v: [3.0 if t < 0.7 else 1.0, 0.0, 0.0], m.bodies["sled"], breaks=[0.7])
    solution = _solved(m, DURATION=1.0)
    both = list(_twins(solution))
    assert solution.t[both] == pytest.approx(0.7, abs=1e-12)
    assert solution.body("sled").ax[both] == pytest.approx([1.5, 0.5])


def _crank(law: Motion) -> Mechanism:
    m = Mechanism("crank")
    crank = m.bar("crank", 0.2, mass=1.0, inertia=0.1)
    m.revolute("O", m.ground.origin, crank.at(0.1, 0))
    m.drive_angle("motor", crank, law)
    return m


RAMP = function(
    lambda t: 0.5 * min(t, JUMP) ** 2 + JUMP * max(t - JUMP, 0.0),
    lambda t: min(t, JUMP),
    lambda t: 1.0 if t < JUMP else 0.0,
)
"""An acceleration that ends at once."""


@pytest.mark.parametrize("steps", [{}, {"STEPS": 50}, {"STEPS": 100, "DURATION": 2 * JUMP}])
@pytest.mark.parametrize("law", [RAMP, function(RAMP.f)], ids=["derivatives", "fitted"])  # pyright: ignore[reportAttributeAccessIssue]
def test_the_effort_of_a_driver_whose_acceleration_jumps_has_two_rows(law: Motion, steps: dict[str, float]) -> None:
    solution = _solved(_crank(law), **{"DURATION": 1.0} | steps)
    both = list(_twins(solution))
    assert solution.t[both] == pytest.approx(JUMP, abs=1e-6)
    assert solution.driver("motor").effort[both] == pytest.approx([0.1, 0.0], abs=1e-6)
    assert len(solution.singularity_margin) == len(solution.t) < 375


def test_a_load_that_steps_on_a_driven_body_has_two_rows() -> None:
    m = _crank(function(lambda t: t, lambda t: 1.0, lambda t: 0.0))
    m.torque("load", m.bodies["crank"], _step(-1.0, -3.0))
    solution = _solved(m, DURATION=1.0)
    both = list(_twins(solution))
    assert solution.driver("motor").effort[both] == pytest.approx([1.0, 3.0])
    assert solution.force("load").on("crank").torque[both] == pytest.approx([-1.0, -3.0])


def test_other_times_and_a_plain_run_know_nothing_of_these_rows() -> None:
    m = _sledge(_step(4.0, -8.0))
    solution = _solved(m, DURATION=1.0, STEPS=50)
    assert solution.at([0.2, 0.31]).t.tolist() == [0.2, 0.31]
    plain = m.simulate(1.0, 50)
    assert len(plain.t) == 51
    assert plain.events == ()
    at = np.isin(solution.t, plain.t)
    np.testing.assert_array_equal(solution.q[at], plain.q)


def test_what_jumps_at_the_same_time_has_two_rows_together() -> None:
    """The end of an acceleration is found in the values of a law, within rounding."""
    m = _crank(RAMP)
    m.torque("load", m.bodies["crank"], _step(-1.0, -3.0))
    hung = m.bar("hung", 0.2, mass=0.5)
    m.revolute("B", m.bodies["crank"].end, hung.start)
    solution = _solved(m, DURATION=1.0)
    both = list(_twins(solution))
    assert [event.name for event in solution.events] == ["motor", "load"]
    assert solution.force("load").on("crank").torque[both] == pytest.approx([-1.0, -3.0])
    assert solution.body("crank").alpha[both] == pytest.approx([1.0, 0.0], abs=1e-9)


def test_rows_of_events_at_the_time_of_a_bend_stay() -> None:
    m = _sledge(function(lambda t: abs(t - 0.5), breaks=[0.5]))
    m.user_force("kick", lambda t, q, v: [0.0, 0.0, 0.0], m.bodies["sled"], breaks=[0.5])
    m.event("half", lambda t, moment: t - 0.5, action=lambda moment: moment.set_velocity("sled", 3.0, 0.0, 0.0))
    solution = _solved(m, DURATION=1.0, STEPS=51)
    assert [event.name for event in solution.events] == ["half"]
    assert solution.body("sled").vx[list(_twins(solution))] == pytest.approx([0.0625, 3.0])


def test_inverse_dynamics_takes_both_rows() -> None:
    m = _crank(RAMP)
    m.torque("hand", m.bodies["crank"], 0.0)
    m.torque("load", m.bodies["crank"], _step(-1.0, -3.0))
    motion = m.sweep(1.0, 50, event_rows=True)
    both = list(_twins(motion))
    assert m.inverse_dynamics(motion, ["hand"]).efforts["hand"][both] == pytest.approx([1.1, 3.0])


def test_a_film_shows_the_side_of_its_time() -> None:
    """Films of the skeleton look at times of their own, between rows."""
    m = _crank(RAMP)
    m.torque("load", m.bodies["crank"], _step(-1.0, -3.0))
    motion = m.sweep(1.0, 50, event_rows=True)
    at = motion.t[_twins(motion)[0]]
    film = at_times(motion, np.array([0.1, at - 1e-3, at, at + 1e-3, 0.9]))
    assert film.body("crank").alpha == pytest.approx([1.0, 1.0, 0.0, 0.0, 0.0], abs=1e-9)
    assert film.force("load").on("crank").torque[1:4] == pytest.approx([-1.0, -3.0, -3.0])
