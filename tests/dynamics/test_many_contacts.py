"""Stops and contacts in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.dynamics.batch.simulate_many import asked_for
from mbsd.dynamics.batch.single_run import single_run
from mbsd.dynamics.events import packing as made
from mbsd.measures import final, largest, samples, smallest
from tools.models.stops import ball, barrier, box, bumpers, limited, massless, plank

STEPS = 40


CASES: dict[str, tuple[Callable[[], Mechanism], float, Mapping[str, Any], str]] = {
    "barrier": (partial(barrier, True), 0.6, {"spring": {"damping": [0.2, 0.5, 0.9]}}, "rocker"),
    "rebound": (partial(barrier, True), 0.4, {"end upper": {"restitution": [0.0, 0.5, 0.8]}}, "rocker"),
    "ball": (ball, 4.0, {"band": {"stiffness": [0.5, 1.0, 30.0]}}, "ball"),
    "bumpers": (bumpers, 2.0, {"c1": {"mass": [0.5, 0.6, 0.4]}}, "c3"),
    "plank": (plank, 1.3, {"plank": {"mass": [0.9, 1.0]}}, "plank"),
    "box": (box, 1.5, {"box": {"inertia": [0.008, 0.01, 0.012]}}, "box"),
    "limited": (limited, 2.0, {"tie": {"stiffness": [10.0, 30.0, 60.0]}}, "fore"),
    "massless": (massless, 1.5, {"bob": {"inertia": [0.01, 0.02]}}, "link"),
}


@pytest.mark.parametrize("case", CASES)
def test_contacts_are_met_as_by_single_simulations(case: str) -> None:
    build, duration, vary, body = CASES[case]
    times = np.linspace(0.0, duration, STEPS + 1)
    joint = next(iter(build().joints), None)
    measures: dict[str, Any] = {f"{part}": samples(f"{body}.{part}", times.tolist()) for part in ("x", "y", "theta")}
    measures |= {"omega": final(f"{body}.omega"), "e": smallest("kinetic"), "w": final("work")}
    if joint is not None:
        measures["f"] = largest(f"{joint}.fy")
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * len(many), many.way
    if case == "rebound":
        assert "anew" not in many.way
    (name, values), *_ = vary.items()
    met = 0
    for k in range(len(many)):
        m = build()
        m.change(name, **{key: column[k] for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        met += len(sol.events)
        own = sol.body(body)
        for part in ("x", "y", "theta"):
            np.testing.assert_allclose(many[part][k], getattr(own, part), atol=2e-9, err_msg=f"{case} {k} {part}")
        np.testing.assert_allclose(many["omega"][k], own.omega[-1], atol=1e-7)
        if joint is not None:
            np.testing.assert_allclose(many["f"][k], sol.joint(joint).fy.max(), rtol=1e-6)
    assert met >= len(many)


def test_a_ball_comes_to_rest_from_any_height() -> None:
    heights = [0.3, 0.5, 0.8]
    start = {"ball": [(0.01, height, 0.0) for height in heights]}
    many = ball().simulate_many(6.0, start=start, measure={"y": final("ball.y"), "v": final("ball.vy")}, steps=60)
    assert many.alone == [None] * 3, many.way
    for k, height in enumerate(heights):
        m = ball()
        m.start_near(ball=(0.01, height, 0))
        sol = m.simulate(6.0, steps=60)
        assert [event.what for event in sol.events].count("closes") >= 1
        np.testing.assert_allclose(many["y"][k], sol.body("ball").y[-1], atol=1e-10)
        np.testing.assert_allclose(many["v"][k], sol.body("ball").vy[-1], atol=1e-10)


def test_rows_that_start_inside_or_jam_say_so_and_do_not_stop_others() -> None:
    m = Mechanism("pushed", gravity=None)
    arm = m.bar("arm", 0.5, mass=1.0)
    m.revolute("pivot", m.ground.origin, arm.start)
    m.angle_stop("stop", m.ground.origin, arm.start, 0.5, upper=True, restitution=0.5)
    m.torsion_spring("spring", m.ground, arm, 2.0, 0.1)
    m.start_near(arm=0)
    many = m.simulate_many(0.5, start={"arm": [-30.0, 60.0, 10.0]}, measure={"a": largest("arm.theta")}, steps=20)
    assert many.good.tolist() == [True, False, True]
    assert "'stop' starts" in str(many.reason[1])
    assert np.isnan(many["a"]).tolist() == [False, True, False]
    assert many["a"][0] <= 0.5 + 1e-9


def test_friction_of_contacts_is_met_as_by_single_simulations() -> None:
    def rough(friction: float = 0.2) -> Mechanism:
        m = ball()
        m.change("floor", friction=friction)
        m.start_moving(ball=(1.0, 0, 30))
        return m

    frictions = [0.0, 0.2, 0.6]
    many = rough().simulate_many(
        2.0, vary={"floor": {"friction": frictions}}, measure={"x": final("ball.x"), "spin": final("ball.omega")},
        steps=20,
    )  # fmt: skip
    assert many.alone == [None] * 3, many.way
    for k, friction in enumerate(frictions):
        sol = rough(friction).simulate(2.0, steps=20)
        assert any(event.what == "impact" for event in sol.events)
        np.testing.assert_allclose(many["x"][k], sol.body("ball").x[-1], atol=2e-9)
        np.testing.assert_allclose(many["spin"][k], sol.body("ball").omega[-1], atol=1e-7)


def test_steps_of_pins_without_contacts_have_the_digits_of_all_others(monkeypatch: pytest.MonkeyPatch) -> None:
    def measured() -> Any:
        many = barrier(stops=True).simulate_many(
            0.6,
            vary={"spring": {"damping": [0.1, 0.3, 0.8]}},
            measure={"angle": final("rocker.theta"), "force": largest("D.fy"), "back": smallest("rocker.omega")},
            steps=60,
            threads=1,
        )
        assert many.alone == [None] * 3
        return [many[name].tolist() for name in ("angle", "force", "force_time", "back")]

    by_pins = measured()
    monkeypatch.setattr(made, "PINS", 1000)
    assert measured() == by_pins


def test_only_pins_that_are_all_rows_go_their_own_way() -> None:
    def pins(m: Mechanism) -> int:
        return len(contacts_of_run(m).schur.pins)

    def contacts_of_run(m: Mechanism) -> Any:
        asked = asked_for(m, 0.5, 10, None, "dop853", 1e-7, None, "auto", {})
        return single_run(m, asked).arguments[4]

    assert pins(barrier(stops=True)) == 4
    assert pins(ball()) == pins(bumpers()) == 0
    dry = barrier(stops=True)
    dry.friction("dry", "D", coefficient=0.1, radius=0.01)
    assert pins(dry) == 0
