"""Contacts with friction beside friction of joints, in the compiled loop: what single simulations give."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import final, samples
from tools.models.rough import (
    block_beside_slider_crank,
    carried_five_bar,
    dragged_arm,
    leaning_ladder,
    pushed_block,
    struck_slider,
    swinging_load,
    thrown_bars,
)

STEPS, TOLERANCE = 30, 1e-9
EXACT = 2e-9
CASES: dict[str, tuple[Callable[..., Mechanism], float, dict[str, Any], str]] = {
    "bars": (thrown_bars, 1.5, {"b": {"mass": [0.6, 0.8]}}, "b"),
    "slider": (struck_slider, 1.5, {"ball": {"mass": [0.5, 0.7]}}, "ball"),
    "block": (pushed_block, 1.0, {"motor": {"torque": [1.0, 1.5]}}, "block"),
    "load": (swinging_load, 2.0, {"bob": {"mass": [0.5, 0.8]}}, "bob"),
    "ladder": (leaning_ladder, 1.0, {"right": {"mass": [1.5, 1.2]}}, "right"),
}
SHARING: dict[str, tuple[Callable[..., Mechanism], float, dict[str, Any], str]] = {
    "beside": (block_beside_slider_crank, 0.6, {"block": {"mass": [2.0, 1.7]}}, "block"),
    "arm": (dragged_arm, 0.4, {"cart": {"mass": [3.0, 2.0]}}, "fore"),
    "five-bar": (carried_five_bar, 0.8, {"d": {"mass": [0.5, 0.4]}}, "b"),
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
    compare(*CASES[case], sticks, static)


@pytest.mark.parametrize("static", [None, pytest.param(0.45, marks=SLOW)])
@pytest.mark.parametrize("case", [pytest.param(case, marks=SLOW if case == "five-bar" else []) for case in SHARING])
def test_joints_share_beside_contacts_as_in_single_simulations(case: str, static: float | None) -> None:
    compare(*SHARING[case], True, static)


def compare(
    build: Callable[..., Mechanism],
    duration: float,
    vary: dict[str, Any],
    body: str,
    sticks: bool,
    static: float | None,
) -> None:
    """Many simulations beside single ones."""
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


def test_two_linkages_share_beside_a_rough_block_as_in_single_simulations() -> None:
    """Each holds one freedom by three pins; the feet of the block stick, break away and slide."""
    times = np.linspace(0.0, 0.6, STEPS + 1)
    names = [f"{pin}.{part}" for pin in "OABPQR" for part in ("fx", "fy")]
    measures = {name: samples(name, times.tolist()) for name in names}
    m = block_beside_slider_crank(True)
    many = m.simulate_many(0.6, vary={"block": {"mass": [2.0]}}, measure=measures, steps=STEPS, tolerance=TOLERANCE)
    assert many.alone == [None], many.way
    sol = m.simulate(0.6, steps=STEPS, tolerance=TOLERANCE)
    stops = {event.name: event.time for event in sol.events if event.what == "sticks"}
    slides = {event.name: event.time for event in sol.events if event.what == "slides"}
    assert {f"rub {pin}" for pin in "OABPQR"} | {"rear", "front"} == set(stops)
    assert {f"rub {pin}" for pin in "OAB"} | {"rear", "front"} == set(slides)
    shared = (times > max(stops.values())) & (times < slides["rub O"])
    assert shared.sum() > 10
    for pin in "AQ":
        assert (np.abs(sol.friction(f"rub {pin}").force[shared]) > 1e-3).any()
    for name in names:
        pin, part = name.split(".")
        np.testing.assert_allclose(many[name][0], getattr(sol.joint(pin), part), rtol=1e-6, atol=2e-6, err_msg=name)
