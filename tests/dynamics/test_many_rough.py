"""Contacts with friction beside friction of joints, in the compiled loop: what single simulations give."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import final, samples
from tools.models.rough import leaning_ladder, pushed_block, struck_slider, swinging_load, thrown_bars

STEPS, TOLERANCE = 30, 1e-9
EXACT = 2e-9
CASES: dict[str, tuple[Callable[..., Mechanism], float, dict[str, Any], str]] = {
    "bars": (thrown_bars, 1.5, {"b": {"mass": [0.6, 0.8]}}, "b"),
    "slider": (struck_slider, 1.5, {"ball": {"mass": [0.5, 0.7]}}, "ball"),
    "block": (pushed_block, 1.0, {"motor": {"torque": [1.0, 1.5]}}, "block"),
    "load": (swinging_load, 2.0, {"bob": {"mass": [0.5, 0.8]}}, "bob"),
    "ladder": (leaning_ladder, 1.0, {"right": {"mass": [1.5, 1.2]}}, "right"),
}
SLOW = pytest.mark.slow


@pytest.mark.parametrize("static", [None, pytest.param(0.45, marks=SLOW)])
@pytest.mark.parametrize("sticks", [False, True])
@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[] if case in ("slider", "ladder") else SLOW) for case in CASES]
)
def test_contacts_and_joints_slide_and_stick_as_in_single_simulations(
    case: str, sticks: bool, static: float | None
) -> None:
    build, duration, vary, body = CASES[case]
    times = np.linspace(0.0, duration, STEPS + 1)
    joint = next(iter(build(sticks, static).joints))
    parts, forces = ("x", "y", "theta", "omega"), ("fx", "fy", "torque")
    measures: dict[str, Any] = {part: samples(f"{body}.{part}", times.tolist()) for part in parts}
    measures |= {part: samples(f"{joint}.{part}", times.tolist()) for part in forces}
    measures["work"] = final("work")
    many = build(sticks, static).simulate_many(duration, vary=vary, measure=measures, steps=STEPS, tolerance=TOLERANCE)
    assert many.alone == [None] * len(many), many.way
    (name, values), *_ = vary.items()
    for k in range(len(many)):
        m = build(sticks, static)
        m.change(name, **{key: column[k] for key, column in values.items()})
        sol, near = (
            m.simulate(duration, steps=STEPS, tolerance=tolerance) for tolerance in (TOLERANCE, 0.1 * TOLERANCE)
        )
        assert {event.what for event in sol.events} & {"closes"}
        for part in parts:
            there, closer = (getattr(each.body(body), part) for each in (sol, near))
            allowed = EXACT + 3.0 * float(np.abs(there - closer).max())
            np.testing.assert_allclose(many[part][k], there, atol=allowed, err_msg=part)
        for part in forces:
            np.testing.assert_allclose(
                many[part][k], getattr(sol.joint(joint), part), rtol=1e-6, atol=2e-6, err_msg=part
            )
        assert sol.work is not None
        np.testing.assert_allclose(many["work"][k], sol.work[-1], atol=2e-8)
