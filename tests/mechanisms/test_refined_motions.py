"""Refinement of output times of sweeps and simulations, and rows at jumps."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from mbsd import Mechanism, Motion, Solution, constant_rate, function, polynomial
from mbsd.drawing.animation.clip import at_times
from mechanisms.quick_return import mechanism as shaper
from mechanisms.stages.clearance.path import paths
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.solving import CLOSE
from shared.contract.consistency import refuse_inconsistent_motion

# A simulation has more rows where something snaps, so many that the proof of clearance trusts what is between them.


SIZE, PROVEN = 0.2, 0.2
"""Size of the truss (m), and doubt that the proof may have of its bars (mm)."""


def _truss() -> Mechanism:
    """Two flat bars between a pin and a spring of 400 N/mm, which a growing force pushes through (von Mises)."""
    m = Mechanism("truss")
    left, right = (m.bar(name, float(np.hypot(SIZE / 2, 0.03)), mass=0.05) for name in ("left", "right"))
    block = m.body("block", mass=0.1, inertia=1e-5)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, right.start)
    m.revolute("C", right.end, block.at(0, 0))
    m.prismatic("S", m.ground.at(0, 0), block.at(0, 0))
    m.spring("spring", m.ground.at(SIZE + 0.1, 0), block.at(0, 0), 4e5, free_length=0.1, damping=30.0)
    m.force("hand", left.end, polynomial(0.0, -20e3), (0.0, 1.0))
    m.start_near(left=17, right=-17)
    return m


def _doubted(solution: Solution) -> float:
    """How far the proof of clearance takes a bar to be from its quintic, at the most (mm)."""
    masses = dict.fromkeys(("left", "right", "block"), "mechanism")
    bodies = paths(to_motion(solution, None, "", {}, masses))
    return max(float(bodies[name].interpolation_error(1e3 * SIZE / 2).max()) for name in ("left", "right", "block"))


def test_a_truss_that_snaps_through_has_rows_for_the_proof() -> None:
    m = _truss()
    solution = solving.motion_of("truss", SimpleNamespace(DURATION=0.5), m, None)
    assert np.ptp(np.sign(solution.body("left").theta)) == 2.0
    assert _doubted(solution) < 3 * PROVEN < _doubted(m.simulate(0.5))
    assert len(solution.t) < 3000
    even = np.diff(solution.t)
    assert even.max() == pytest.approx(0.5 / 360)
    fast = np.abs(solution.body("left").omega)[1:] > 0.5 * np.abs(solution.body("left").omega).max()
    assert np.median(even[fast]) < 0.3 * even.max()


def test_the_worst_of_too_many_steps_are_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solving, "MOST_ROWS", 400)
    m = _truss()
    solution = solving.motion_of("truss", SimpleNamespace(DURATION=0.5), m, None)
    assert 380 < len(np.unique(solution.t)) <= 400
    assert _doubted(solution) < 0.7 * _doubted(m.simulate(0.5))


@pytest.mark.parametrize("own", ["STEPS", "motion()"])
def test_steps_of_ones_own_that_are_too_long_are_told(own: str, capsys: pytest.CaptureFixture[str]) -> None:
    m = _truss()
    given = {"STEPS": 300} if own == "STEPS" else {"motion": lambda m, p: m.simulate(0.5, 300)}
    assert len(solving.motion_of("truss", SimpleNamespace(DURATION=0.5, **given), m, None).t) == 301
    said = " ".join("".join(capsys.readouterr()).split())
    assert "too long for the fastest bodies, first at t = " in said
    assert f"leave out {own}, so that rows are added there" in said


# A sweep of a mechanism has more times where a link flies past a dead point, and only there.


def _swept(p: shaper.Params) -> Solution:
    return solving.motion_of("quick_return", shaper, shaper.build(p), p)


def test_a_usual_motion_keeps_its_times() -> None:
    p = shaper.Params()
    np.testing.assert_array_equal(_swept(p).t, shaper.build(p).sweep().t)


def test_an_arm_that_flies_back_gets_more_times_and_keeps_its_period() -> None:
    """The crank is nearly as long as the arm's pivot is away: the arm swings back within 15 degrees of the crank.

    Half way between two times the quintic is the motion itself, known here: the arm points at the crank's pin.
    """
    p = replace(shaper.Params(), crank=0.0992, arm=0.3, ram=0.25, link=0.35)
    swept = _swept(p)
    assert swept.period == 2 * np.pi / p.speed
    rate = np.abs(swept.body("arm").omega)
    assert np.diff(swept.t)[rate[1:] > 0.5 * rate.max()].max() < 0.3 * np.median(np.diff(swept.t))
    assert _off(p, swept) < 2 * CLOSE < 1e-3 < _off(p, shaper.build(p).sweep())


def _off(p: shaper.Params, swept: Solution) -> float:
    """The largest difference of the quintic and the motion half way between two times (rad)."""
    h, arm = np.diff(swept.t), swept.body("arm")
    q, v, a = arm.theta, arm.omega, arm.alpha
    middle = (q[:-1] + q[1:]) / 2 + 5 * h / 32 * (v[:-1] - v[1:]) + h**2 / 64 * (a[:-1] + a[1:])
    crank = swept.body("crank").theta[0] + p.speed * (swept.t[:-1] + h / 2)
    exact = np.arctan2(p.height + p.crank * np.sin(crank), p.crank * np.cos(crank))
    return float(np.abs(np.exp(1j * middle) - np.exp(1j * exact)).max())


@pytest.mark.parametrize(("turns", "rows"), [(None, 361), (2.0, 721), (0.5, 361)])
def test_a_duration_of_two_turns_has_rows_for_both(turns: float | None, rows: int) -> None:
    m = Mechanism("wheel")
    m.revolute("O", m.ground.origin, m.body("disc").origin)
    m.drive_angle("motor", m.bodies["disc"], constant_rate(2.0))
    given = {} if turns is None else {"DURATION": turns * np.pi}
    assert len(solving.motion_of("wheel", SimpleNamespace(**given), m, None).t) == rows


# Where a force jumps at a known time data.json has a row right before and one right after, which share that time.


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


def test_simultaneous_jumps_have_two_rows_together() -> None:
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
