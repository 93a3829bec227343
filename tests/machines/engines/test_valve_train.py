"""Overhead camshafts of engines: when their valves open, against the cycle of the gas; springs; bad input."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import ModelError, four_stroke, two_stroke
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.valve_train import ValveTrain

SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.15, "spacing": 0.1}
SPEED = 100.0


@pytest.mark.parametrize(("layout", "order"), [("I4", (1, 3, 4, 2)), ("V2", None), ("flat-2", None)])
def test_valves_open_when_their_cylinder_asks_for_it(layout: str, order: tuple[int, ...] | None) -> None:
    gas = four_stroke(10.0, heat_density=1e6, exhaust_opens=math.radians(150), intake_closes=math.radians(-150))
    m = engine(layout, **SIZE, gas=gas, order=order, valves=ValveTrain(lift=0.006, ramp=30), speed=SPEED)
    sol = m.sweep(times=np.linspace(0, 4 * math.pi / SPEED, 1441))
    crank = sol.body("crank").theta
    for k in range(1, sum(name.startswith("piston") for name in m.bodies) + 1):
        fires = m.forces[f"gas_{k}"].params["fires_at"]
        phi = np.degrees(crank - fires) % 720
        for kind, begin, end in (("exhaust", 120.0, 390.0), ("intake", 330.0, 600.0)):
            valve = sol.body(f"{kind}_{k}")
            away = np.hypot(valve.x, valve.y)
            lift = away.max() - away
            is_open = (phi > begin + 1) & (phi < end - 1)
            assert lift[is_open].min() > 0
            assert lift[~((phi > begin - 1) & (phi < end + 1))].max() < 1e-9
            assert lift.max() == pytest.approx(0.006, abs=1e-9)
            assert phi[lift.argmax()] == pytest.approx((begin + end) / 2, abs=0.5)


def test_the_camshaft_turns_at_half_speed_and_springs_close_the_valves() -> None:
    m = engine("V8", **SIZE, valves=ValveTrain(preload=150.0, stiffness=2e4), speed=SPEED)
    sol = m.sweep(duration=4 * math.pi / SPEED, steps=720)
    assert sol.body("camshaft_1").omega == pytest.approx(SPEED / 2)
    push = sol.force("spring_intake_1").effort
    assert push is not None
    assert push.min() == pytest.approx(150.0, rel=1e-6)
    assert push.max() == pytest.approx(150.0 + 2e4 * 0.0064, rel=1e-4)
    assert len(m.bodies) == 1 + 17 + 2 + 16


@pytest.mark.parametrize(
    ("layout", "given", "valves", "words"),
    [
        ("W12", {}, {}, "it has 3 banks"),
        ("radial-5", {}, {}, "pistons on a master rod"),
        ("I1", {"gas": two_stroke(8.0)}, {}, "a cycle of one turn"),
        ("I1", {}, {"base_radius": 0.01}, r"would be undercut: a flat tappet needs more than 2\d"),
        ("I1", {}, {"height": 0.285}, "between the heads and the tappets there is no room for springs"),
        ("I1", {}, {"height": 0.24}, "its cams would reach into the cylinders"),
    ],
)
def test_invalid_requests_are_refused(layout: str, given: dict[str, Any], valves: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        engine(layout, **SIZE, **given, valves=ValveTrain(**valves), speed=SPEED)


def test_numbers_of_valves_are_checked() -> None:
    with pytest.raises(ModelError, match="ramp of the valves is 90 degrees"):
        ValveTrain(ramp=90)
    with pytest.raises(ModelError, match="lift of the valves"):
        ValveTrain(lift=-0.001)
    with pytest.raises(ModelError, match=r"valves must be ValveTrain\(\.\.\.\)"):
        engine("I1", **SIZE, valves=True, speed=SPEED)  # pyright: ignore[reportArgumentType]
