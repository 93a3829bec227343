"""Joints that stick, and freewheels, in the compiled loop over simulations: what single simulations give."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import final, first, samples
from tools.models.sticking import (
    arm,
    bell,
    coasting_slider_crank,
    loaded_lever,
    ratchet,
    rubbed_ratchet,
    shaken_block,
    stopped_bell,
    stuck_five_bar,
    two_slider_cranks,
    weightless_slider_crank,
)

STEPS = 24
EXACT = 2e-9


CASES: dict[str, tuple[Callable[[], Mechanism], float, Mapping[str, Any], str]] = {
    "bell": (bell, 4.0, {"bar": {"mass": [1.0, 1.5]}}, "bar"),
    "slider-crank": (coasting_slider_crank, 0.6, {"rub": {"preload": [10.0, 12.0]}}, "crank"),
    "breaks away": (lambda: coasting_slider_crank(0.0, 3.0), 0.3, {"slider": {"mass": [1.5, 2.0]}}, "crank"),
    "shaken block": (shaken_block, 4.0, {"block": {"mass": [1.0, 1.3]}}, "block"),
    "arm": (arm, 3.0, {"fore": {"mass": [0.7, 0.9]}}, "fore"),
    "lever": (loaded_lever, 0.5, {"ball": {"mass": [0.5, 0.8]}}, "lever"),
    "stopped bell": (stopped_bell, 3.0, {"bar": {"mass": [1.0, 1.1]}}, "bar"),
    "ratchet": (ratchet, 3.0, {"load": {"inertia": [0.3, 0.4]}}, "wheel"),
    "rubbed ratchet": (rubbed_ratchet, 3.0, {"load": {"inertia": [0.3, 0.4]}}, "wheel"),
    "two slider-cranks": (lambda: two_slider_cranks(1.0), 0.6, {"slider a": {"mass": [1.5, 2.0]}}, "crank a"),
    "five-bar": (stuck_five_bar, 0.45, {"b": {"mass": [0.8, 0.9]}}, "b"),
}


QUICK = {"bell", "slider-crank", "shaken block", "lever", "ratchet", "two slider-cranks"}


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[] if case in QUICK else pytest.mark.slow) for case in CASES]
)
def test_joints_stick_and_slide_as_in_single_simulations(case: str) -> None:
    build, duration, vary, body = CASES[case]
    times = np.linspace(0.0, duration, STEPS + 1)
    joint = next(iter(build().joints))
    parts, forces = ("x", "y", "theta", "omega"), ("fx", "fy", "torque")
    measures: dict[str, Any] = {part: samples(f"{body}.{part}", times.tolist()) for part in parts}
    measures |= {part: samples(f"{joint}.{part}", times.tolist()) for part in forces}
    many = build().simulate_many(duration, vary=vary, measure={**measures, "w": final("work")}, steps=STEPS)
    assert many.alone == [None] * len(many), many.way
    (name, values), *_ = vary.items()
    for k in range(len(many)):
        m = build()
        m.change(name, **{key: column[k] for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        assert {event.what for event in sol.events} & {"sticks", "closes"}
        for part in parts:
            np.testing.assert_allclose(many[part][k], getattr(sol.body(body), part), atol=EXACT, err_msg=part)
        for part in forces:
            np.testing.assert_allclose(many[part][k], getattr(sol.joint(joint), part), atol=1e-7, err_msg=part)
        assert sol.work is not None
        assert many["w"][k] == pytest.approx(sol.work[-1], abs=EXACT)


def test_bells_come_to_rest_from_any_angle_where_single_ones_do() -> None:
    """Starts vary, rows end early, and the digits do not depend on the threads."""
    angles, measure = [-20.0, -60.0], {"still": first("bar.omega", above=-1e-9, give="bar.theta")}
    alone, together = (bell().simulate_many(4.0, start={"bar": angles}, measure=measure, threads=n) for n in (1, 2))
    assert alone.alone == [None] * 2, alone.way
    np.testing.assert_array_equal(alone["still"], together["still"])
    end = bell().simulate_many(4.0, start={"bar": angles}, measure={"rest": final("bar.theta")})
    for angle, rest in zip(angles, end["rest"], strict=True):
        sol = bell(angle).simulate(4.0)
        assert abs(sol.body("bar").omega[-1]) < 1e-12
        assert rest == pytest.approx(sol.body("bar").theta[-1], abs=EXACT)
        assert abs(rest + math.pi / 2) > 1e-3


def test_a_turned_world_changes_nothing() -> None:
    ends = []
    for turned in (0.0, 2.0):
        many = bell(-20.0, turned).simulate_many(4.0, vary={"bar": {"mass": [1.0]}}, measure={"a": final("bar.theta")})
        assert many.alone == [None], many.way
        ends.append(many["a"][0] - turned)
    assert ends[0] == pytest.approx(ends[1], abs=1e-7)


def test_what_has_come_to_rest_without_any_load_runs_on() -> None:
    """Velocities fall to 1e-155, whose squares are no numbers."""
    m = weightless_slider_crank()
    many = m.simulate_many(
        2.0, vary={"part": {"mass": [1.7456816106902577]}}, measure={"a": final("part.theta")}, steps=2
    )
    assert many.alone == [None], many.way
    assert many["a"][0] == pytest.approx(m.simulate(2.0, steps=2).body("part").theta[-1], abs=EXACT)


@pytest.mark.parametrize("method", ["rk4", "radau"])
def test_other_methods_meet_joints_that_stick(method: str) -> None:
    step = {"step": 1e-3} if method == "rk4" else {}
    m = bell()
    many = m.simulate_many(
        0.5, vary={"bar": {"mass": [1.0]}}, measure={"a": final("bar.theta")}, steps=10, method=method, **step
    )
    assert many.way == "all of 1 in the compiled loop"
    m.change("bar", mass=1.0)
    assert many["a"][0] == pytest.approx(m.simulate(0.5, steps=10).body("bar").theta[-1], abs=1e-6)
