"""Runs that hardly advance: a force that jumps, stiff friction; long runs say where they are and can be interrupted."""

from __future__ import annotations

import logging
import math
import re
import signal
import subprocess
import sys
import time
from typing import Any

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, SimulationError
from mbsd.dynamics.runs import motion, run
from mbsd.dynamics.runs import steps as pace
from mbsd.dynamics.runs.diagnosis import Look, creeps_to
from mbsd.measures import final


def pendulum() -> Mechanism:
    m = Mechanism("pendulum", gravity=(0.0, -9.81))
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("pin", m.ground.at(0, 0), rod.start)
    m.start_near(rod=-60)
    return m


@pytest.mark.parametrize("formulation", ["auto", "reference"])
def test_friction_that_jumps_is_named(formulation: str) -> None:
    """A brake that holds: its sign changes with every step, for ever."""
    m = pendulum()
    m.user_force("brake", lambda t, q, v: [0.0, 0.0, -3.0 * np.sign(v[2])], m.bodies["rod"])
    m.torsion_spring("spring", m.ground, m.bodies["rod"], 0.5)
    seen: list[float] = []
    with pytest.raises(
        SimulationError,
        match=r"pendulum: dop853 no longer advances at t = 0\.\d+ s: .* force 'brake' jumps there, by 6 .*sticks=True",
    ):
        m.simulate(1.0, formulation=formulation, progress=seen.append)
    assert seen, "progress was reported meanwhile"
    assert seen == sorted(seen)


def test_a_force_that_jumps_now_and_then_is_no_matter() -> None:
    """The brake is too weak to hold: the rod swings to and fro, and each turn is one jump."""
    m = pendulum()
    m.user_force("brake", lambda t, q, v: [0.0, 0.0, -0.3 * np.sign(v[2])], m.bodies["rod"])
    sol = m.simulate(3.0, tolerance=1e-6)
    assert np.ptp(sol.audit) < 1e-4


@pytest.mark.parametrize("friction", [{"viscous": 1e7}, {"viscous": 1e12}, {"coefficient": 1e7}])
def test_friction_that_is_far_too_stiff_is_named(friction: dict[str, float]) -> None:
    m = pendulum()
    m.friction("rub", "pin", **{"coefficient": 0.0, "radius": 0.01, **friction})
    with pytest.raises(
        SimulationError,
        match=r"pendulum: dop853 no longer advances at t = .* s: .* force 'rub' of joint 'pin' is stiff.*radau",
    ):
        m.simulate(1.0)


def test_friction_without_bound_jams() -> None:
    m = pendulum()
    m.friction("rub", "pin", 1e12, radius=0.01)
    with pytest.raises(SimulationError, match="joints jam"):
        m.simulate(1.0)


def test_stiff_dampers_that_take_many_steps_are_let_run(monkeypatch: pytest.MonkeyPatch) -> None:
    """Thousands of steps for stability's sake, and an end in sight: looked at, and gone on with."""
    monkeypatch.setattr(pace, "MANY", 1e3)
    looked = []
    original = pace.diagnosis
    monkeypatch.setattr(pace, "diagnosis", lambda *given: looked.append(given) or original(*given))
    m = pendulum()
    m.torsion_spring("damper", m.ground, m.bodies["rod"], 0.0, damping=3e4)
    sol = m.simulate(1.0)
    assert sol.stats.steps > 1000
    assert looked, "the run was looked at"
    assert np.ptp(sol.audit) < 1e-4


def test_long_runs_say_where_they_are(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    monkeypatch.setattr(pace, "PATIENCE", 1e-6)
    monkeypatch.setattr(run, "STEPS_AT_ONCE", 20)
    with caplog.at_level(logging.WARNING, "mbsd"):
        pendulum().simulate(20.0)
    words = [record.getMessage() for record in caplog.records]
    assert words
    assert all(word.startswith("mbsd: pendulum: t = ") and "of 20 s" in word for word in words)
    caplog.clear()
    with caplog.at_level(logging.WARNING, "mbsd"):
        pendulum().simulate(20.0, progress=lambda done: None)
    assert not caplog.records, "who takes the progress needs no words"


RUNNING = """
from tests.dynamics.test_pace import pendulum
m = pendulum()
{extra}
m.simulate(0.1, {options})
print("running", flush=True)
m.simulate(1e7, steps=10, {options})
"""
FORCE = "m.user_force('wind', lambda t, q, v: [0.0, 0.0, 0.01 * v[2]], m.bodies['rod'])"
EVENT = "m.event('down', lambda t, now: now.body('rod').theta + 1.5)"


@pytest.mark.parametrize(
    ("extra", "options"),
    [("", ""), ("", "formulation='reference'"), (FORCE, ""), (EVENT, ""), ("", "method='radau'")],
    ids=["independent", "reference", "user force", "event", "radau"],
)
def test_ctrl_c_ends_a_run_at_once(extra: str, options: str) -> None:
    code = RUNNING.format(extra=extra, options=options)
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert child.stdout is not None
        assert child.stdout.readline() == "running\n"
        time.sleep(0.5)
        assert child.poll() is None
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=60)  # about a second; without the cure the run goes on for hours
        assert "KeyboardInterrupt" in errors
        assert child.returncode != 0
    finally:
        child.kill()


def test_steps_that_creep_towards_a_change_point_end_with_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Parallelograms in a row of which one is off by 1e-7 m: where both are flat links whip ever faster."""
    m, length = Mechanism("row"), 1.3
    rods = [m.bar(f"rod{k}", length, mass=1.0) for k in range(3)]
    for k, rod in enumerate(rods):
        m.revolute(f"foot{k}", m.ground.at(k * length, 0), rod.start)
    for k, more in ((1, 0.0), (2, 1e-7)):
        deck = m.bar(f"deck{k}", length, mass=1.0)
        m.revolute(f"left{k}", rods[k - 1].end, deck.start)
        m.revolute(f"right{k}", deck.at(length + more, 0.0), rods[k].end)
    m.start_near(rod0=113, rod1=113, rod2=113, deck1=0, deck2=0)
    m.start_moving(rod0=0.48)
    calls, original = [], motion.advance

    def advance(*given: Any) -> int:
        calls.append(given)
        assert len(calls) < 5000, "it creeps for ever"
        return original(*given)

    monkeypatch.setattr(motion, "advance", advance)
    with pytest.raises(SimulationError, match=r"no longer advances at t = 1\.\d+ s.* Look for a pose that is singular"):
        m.simulate(1.34, steps=20, tolerance=1e-9)


def looks(times: list[float], steps: list[int]) -> list[Look]:
    """Looks at the end of so many steps, of which the last 2000 took these times (s)."""
    return [Look(count, time / 2000.0) for count, time in zip(steps, times, strict=True)]


DOUBLED = [2000, 4000, 8000, 16000]


@pytest.mark.parametrize(
    ("passed", "known"), [([4.8e-5, 1.5e-5, 5.2e-6, 1.56e-6], 0.75421), ([3.6e-6, 2.1e-6, 1e-6, 3.6e-7], None)]
)
def test_steps_that_shorten_for_ever_tell_where_they_end(passed: list[float], known: float | None) -> None:
    """Two rows of inexact parallelograms: one is known to creep after three looks, the other not after four."""
    ends = creeps_to(looks(passed, DOUBLED)[:3], 0.754171, 1.07)
    if known is None:
        assert ends is None
        assert creeps_to(looks(passed, DOUBLED), 0.754171, 1.07) is None
    else:
        assert ends == pytest.approx(known, abs=5e-5)
    assert creeps_to(looks(passed, DOUBLED)[:2], 0.754171, 1.07) is None


def test_steps_that_shorten_but_get_there_do_not_creep() -> None:
    growing = looks([1e-4, 5e-5, 2.5e-5, 1.25e-5], DOUBLED)  # as frequencies that grow exponentially ask for
    assert creeps_to(growing, 0.5, 1.0) is None
    entering = looks([1e-2, 1e-5, 0.9e-5, 0.9e-5], DOUBLED)  # a stiff stretch
    assert creeps_to(entering, 0.5, 1.0) is None
    near = looks([1e-3, 1e-4, 1e-5], DOUBLED[:3])
    assert creeps_to(near, 0.5, 0.5 + 5e-5) is None, "the end is nearer"
    assert creeps_to(near, 0.5, 1.0) is not None
    assert creeps_to(looks([0.0, 1e-5, 0.0], DOUBLED[:3]), 0.5, 1.0) is None


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


def _braked(function, speed: float) -> Mechanism:
    m = Mechanism("brake", gravity=None)
    sledge = m.body("sledge", 1.0, inertia=1.0)
    m.user_force("drag", function, sledge)
    m.start_moving(sledge=(speed, 0.0, 0.0))
    return m


def _exponential(t, q, v):
    return 1.0 - math.exp(50.0 * v[0]), 0.0, 0.0


def _root(t, q, v):
    return math.sqrt(0.5 - t), 0.0, 0.0


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("function", [_exponential, numba.njit(_exponential)], ids=["Python", "numba"])
def test_a_stage_that_overflows_shortens_the_step(function, method: str) -> None:
    """v' = 1 - exp(50 v):  exp(-50 v) = 1 - (1 - exp(-50 v0)) exp(-50 t), and v0 = 0.4 pushes with 5e8 N."""
    sol = _braked(function, 0.4).simulate(0.1, steps=10, method=method, tolerance=1e-9)
    expected = -np.log(1.0 - (1.0 - math.exp(-20.0)) * np.exp(-50.0 * sol.t)) / 50.0
    np.testing.assert_allclose(sol.body("sledge").vx, expected, atol=1e-7)


@pytest.mark.parametrize("method", ["dop853", "radau"])
@pytest.mark.parametrize("function", [_root, numba.njit(_root)], ids=["Python", "numba"])
def test_what_fails_however_short_the_step_is_an_error_with_force_time_and_number(function, method: str) -> None:
    said = r"brake: force 'drag': at t = 0\.5 s with \[.*\] the user's function (fails: ValueError|gives \[nan)"
    with pytest.raises(ModelError, match=said):
        _braked(function, 0.4).simulate(1.0, steps=10, method=method)


def test_what_is_no_number_is_told_at_once() -> None:
    def forgetful(t, q, v):
        return unknown, 0.0, 0.0  # noqa: F821  # pyright: ignore[reportUndefinedVariable]

    with pytest.raises(ModelError, match=r"at t = 0 s with .* NameError"):
        _braked(forgetful, 0.4).simulate(1.0, steps=10)
    with pytest.raises(ModelError, match=r"at t = 0\.5\d* s with .* ValueError"):
        _braked(_root, 0.4).simulate(1.0, method="rk4", step=0.01)


def test_an_overflow_long_ago_is_not_blamed_for_another_end() -> None:
    def sharp(t, q, v):
        return 1.0 - math.exp(50.0 * v[0]), 1.0 / (0.3 - t) if t < 0.3 else 1e12, 0.0

    with pytest.raises(SimulationError, match=r"stops at t = 0\.3 s"):
        _braked(sharp, 0.4).simulate(1.0, steps=10)
