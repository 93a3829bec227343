"""Events of the user in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numba
import numpy as np
import pytest

from mbsd import Mechanism, ModelError, angle_reaches, distance_reaches, speed_reaches
from mbsd.dynamics.measures.quantities import quantity_named
from mbsd.measures import final, first, integral, largest, samples
from mbsd.results.columns import columns
from mbsd.results.solution import Solution
from tools.models.user_events import ball, crank, halved, height, rubbing, swing

STEPS = 20


Case = tuple[Callable[[], Mechanism], float, dict[str, tuple[str, float, float]], str, str]
CASES: dict[str, Case] = {
    "swing": (swing, 1.5, {"drive": ("torque", 1.0, 3.0)}, "arm", "hinge.fx"),
    "ball": (ball, 2.0, {"floor": ("restitution", 0.4, 0.9)}, "ball", "kinetic"),
    "rubbing": (rubbing, 1.5, {"bob": ("mass", 0.2, 0.6)}, "bob", "pin.fy"),
    "crank": (crank, 2.0, {"spring": ("stiffness", 10.0, 80.0)}, "slider", "motor.power"),
}


def measures_of(body: str, own: str, duration: float) -> dict[str, Any]:
    return {
        "end": final("t"),
        "x": samples(f"{body}.x", [0.5 * duration, duration]),
        "theta": final(f"{body}.theta"),
        "omega": final(f"{body}.omega"),
        "most": largest(own),
        "own": integral(own),
        "first": first(f"{body}.vx", above=0.1),
        "work": final("work"),
    }


def single(sol: Solution, measures: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The same measures of a single solution."""
    names = {name for each in measures.values() for name in each.quantities}
    along = {name: quantity_named(sol.mechanism, name, list(columns(sol))).of_solution(sol)[None] for name in names}
    out: dict[str, np.ndarray] = {}
    for name, each in measures.items():
        out |= each.of(name, sol.t, along)
    return out


@pytest.mark.parametrize("case", CASES)
def test_events_are_met_as_by_single_simulations(case: str) -> None:
    build, duration, varied, body, own = CASES[case]
    random, count = np.random.default_rng(5), 5 if case == "rubbing" else 10
    vary = {name: {key: random.uniform(low, high, count)} for name, (key, low, high) in varied.items()}
    measures = measures_of(body, own, duration)
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * count, many.way
    happened = ended = 0
    for k in range(count):
        m = build()
        for name, values in vary.items():
            m.change(name, **{key: float(column[k]) for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        happened += sum(event.what == "event" for event in sol.events)
        ended += sol.events[-1].what == "end"
        for name, value in single(sol, measures).items():
            np.testing.assert_allclose(many[name][k], value[0], rtol=1e-8, atol=1e-8, err_msg=f"{case} {k} {name}")
    assert happened >= count
    if case in ("swing", "crank"):
        assert ended == count


def test_rows_that_end_early_are_looked_at_in_windows() -> None:
    many = swing().simulate_many(
        6.0, vary={"drive": {"torque": [1.2, 2.0, 2.8]}}, steps=300,
        measure={"far": first("arm.theta", above=5.0), "slow": first("arm.theta", above=9.0), "t": samples("t", [0.1])},
    )  # fmt: skip
    assert many.alone == [None] * 3, many.way
    assert np.isfinite(many["far"]).all()
    assert np.isnan(many["slow"]).all()
    assert np.array_equal(many["t"], np.full((3, 1), 0.1))


def test_what_is_not_compiled_falls_back_and_is_named() -> None:
    cases: dict[str, Callable[[Mechanism, Any], object]] = {
        "gets a moment": lambda m, arm: m.event("late", lambda t, moment: t - 0.3),
        "function is one of Python": lambda m, arm: m.event("late", lambda t, q, v: t - 0.3, frames=arm),
        "action is one of Python": lambda m, arm: m.event("late", height, frames=arm, action=lambda t, q, v: v),
    }
    for why, add in cases.items():
        m = swing()
        add(m, m.bodies["arm"])
        many = m.simulate_many(0.5, start={"arm": [-80.0, -60.0]}, measure={"a": final("arm.theta")}, steps=STEPS)
        assert "2 one by one (event 'late'" in many.way
        assert why in many.way
        m.start_near(arm=-60)
        assert many["a"][1] == m.simulate(0.5, steps=STEPS).body("arm").theta[-1]


def test_a_function_that_fails_is_a_reason() -> None:
    m = swing()
    bad = numba.njit(lambda t, q, v: math.nan if q[1] < -0.495 else 1.0)
    m.event("bad", bad, frames=m.bodies["arm"].end)
    many = m.simulate_many(0.2, start={"arm": [-100.0, -30.0]}, measure={"a": final("arm.theta")}, steps=STEPS)
    assert many.good.tolist() == [False, True]
    assert "event 'bad': its function: at t = 0.09" in str(many.reason[0])


def test_the_interface_of_frames() -> None:
    m = swing()
    arm = m.bodies["arm"]
    with pytest.raises(ModelError, match=r"knows no moment.*frames="):
        m.event("a", height)
    with pytest.raises(ModelError, match="frames are 3"):
        m.event("a", height, frames=3)  # pyright: ignore[reportArgumentType]
    with pytest.raises(ModelError, match="another mechanism"):
        m.event("a", height, frames=swing().bodies["arm"])
    with pytest.raises(ModelError, match="each moving body once"):
        m.event("a", height, frames=(arm, arm.end), action=halved)
    m.event("three", lambda t, q, v: q[0] - 0.1, frames=arm.end, action=lambda t, q, v: (1.0, 2.0))
    with pytest.raises(ModelError, match=r"its action fails.*gives 2 numbers; 3 are wanted"):
        m.simulate(1.0)


def test_markers_at_the_end_of_a_bar_move_with_it() -> None:
    m = swing()
    m.event("near", distance_reaches(m.ground.at(0.4, 0.0), m.bodies["arm"].end, 0.05))
    m.change("arm", length=0.4)
    frames = [frame for event in m.events.values() for frame in event.frames]
    assert [frame.x for frame in frames] == [0.4, 0.4]
    assert min(event.time for event in m.simulate(1.5).events if event.name == "near") > 0.0


@pytest.mark.parametrize("direction", [0, 1, -1])
def test_a_turned_world_and_tight_tolerances_meet_them_too(direction: int) -> None:
    def tilted(angle: float) -> Mechanism:
        m = Mechanism("tilted", gravity=(9.81 * math.sin(angle), -9.81 * math.cos(angle)))
        arm = m.bar("arm", 0.5, mass=0.3)
        m.revolute("hinge", m.ground.at(0, 0), arm.start)
        m.event("low", angle_reaches(arm, angle - math.pi / 2), direction=direction)
        m.event("fast", speed_reaches(arm, 4.0), direction=direction, terminal=direction != 0)
        m.start_near(arm=math.degrees(angle) - 10)
        return m

    ends = []
    for angle in (0.0, 1.0):
        many = tilted(angle).simulate_many(
            2.0, start={"arm": np.degrees(angle) - np.array([10.0, 25.0])}, steps=5, tolerance=1e-12,
            measure={"end": final("t"), "w": final("arm.omega")},
        )  # fmt: skip
        assert many.alone == [None, None], many.way
        ends.append(np.concatenate([many["end"], many["w"]]))
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)
