"""Contacts with friction in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, SimulationError, harmonic
from mbsd.measures import final, first, samples
from tools.models.guided import loose_gears
from tools.models.rough_contacts import ball, belt, crank, discs, freewheel, hills, incline, ring, rod, tumbling

pytestmark = pytest.mark.slow
G = 9.81
STEPS = 30
Start = dict[str, tuple[float, float, float]]


def test_rows_whose_friction_is_refused_or_none_are_prepared_by_themselves() -> None:
    given = {"friction": [0.0, 0.2, 0.3], "static_friction": [0.0, 0.3, 0.2], "restitution": 0.5}
    many = ball().simulate_many(0.5, vary={"floor": given}, measure={"x": final("ball.x")}, steps=4)
    assert many.good.tolist() == [True, True, False]
    assert "static friction" in str(many.reason[2])
    for k in range(2):
        m = ball()
        m.change("floor", friction=given["friction"][k], static_friction=given["static_friction"][k], restitution=0.5)
        np.testing.assert_allclose(many["x"][k], m.simulate(0.5, steps=4).body("ball").x[-1], atol=1e-12)


CASES: dict[str, tuple[Callable[[], Mechanism], float, dict[str, Any], str]] = {
    "stops": (incline, 1.0, {"rear": {"friction": [0.3, 0.6, 0.9]}}, "box"),
    "static": (lambda: incline(0.3, 0.7), 1.0, {"box": {"inertia": [0.005, 0.02]}}, "box"),
    "steep": (lambda: incline(0.3, slope=40.0), 1.0, {"box": {"mass": [0.5, 2.0]}}, "box"),
    "ball": (ball, 2.0, {"ball": {"inertia": [1e-4, 2e-4, 4e-4]}}, "ball"),
    "tumbling": (tumbling, 1.5, {"corner 0": {"friction": [0.1, 0.5]}}, "box"),
    "belt": (belt, 2.0, {"spring": {"stiffness": [20.0, 50.0, 120.0]}}, "block"),
    "crank": (crank, 1.0, {"motor": {"torque": [0.5, 1.5, 3.0]}}, "block"),
    "hills": (hills, 2.0, {"wheel": {"inertia": [1e-3, 2.5e-3, 5e-3]}}, "wheel"),
    "freewheel": (freewheel, 1.5, {"spring": {"stiffness": [50.0, 80.0, 200.0]}}, "fly"),
    "discs": (discs, 0.8, {"a": {"mass": [1.0, 1.4]}}, "b"),
    "ring": (ring, 0.5, {"disc": {"mass": [0.3, 0.4]}}, "disc"),
}


def compare(build: Callable[[], Mechanism], duration: float, vary: dict[str, Any], body: str) -> list[set[str]]:
    """Simulate rows in the loop and by themselves; what happened in each of the single ones."""
    times = np.linspace(0.0, duration, STEPS + 1)
    measures: dict[str, Any] = {part: samples(f"{body}.{part}", times.tolist()) for part in ("x", "y", "theta")}
    measures |= {"omega": final(f"{body}.omega"), "work": final("work")}
    joint = next(iter(build().joints), None)
    if joint is not None:
        measures["fx"] = samples(f"{joint}.fx", times.tolist())
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * len(many), many.way
    assert "anew" not in many.way
    (name, values), *_ = vary.items()
    happened = []
    for k in range(len(many)):
        m = build()
        m.change(name, **{key: column[k] for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        happened.append({event.what for event in sol.events})
        for part in ("x", "y", "theta"):
            np.testing.assert_allclose(many[part][k], getattr(sol.body(body), part), atol=2e-9, err_msg=f"{k} {part}")
        np.testing.assert_allclose(many["omega"][k], sol.body(body).omega[-1], atol=1e-7)
        if joint is not None:
            np.testing.assert_allclose(many["fx"][k], sol.joint(joint).fx, rtol=1e-6, atol=1e-6)
        assert sol.work is not None
        np.testing.assert_allclose(many["work"][k], sol.work[-1], atol=1e-8)
    return happened


@pytest.mark.parametrize("case", CASES)
def test_friction_is_that_of_single_simulations(case: str) -> None:
    happened = compare(*CASES[case])
    assert all(happened)


def test_rows_that_end_early_and_threads_change_no_digit() -> None:
    """Rows are put away and taken up again while blocks slide and stick."""
    vary = {"spring": {"stiffness": [20.0, 50.0, 90.0, 120.0]}}
    early = {"when": first("block.x", above=0.03), "how": first("block.x", above=0.03, give="block.vx")}
    single, double = (belt().simulate_many(2.0, vary=vary, measure=early, steps=400, threads=n) for n in (1, 2))
    whole = belt().simulate_many(2.0, vary=vary, measure=early | {"x": final("block.x")}, steps=400)
    assert single.alone == [None] * 4, single.way
    assert np.isfinite(single["when"]).any()
    for name in early:
        np.testing.assert_array_equal(single[name], double[name])
        np.testing.assert_array_equal(single[name], whole[name])


def test_wheels_that_may_meet_go_in_the_loop_up_to_where_they_do() -> None:
    compare(loose_gears, 0.9, {"coil": {"stiffness": [0.0, 1.0, 3.0]}}, "gear")
    many = loose_gears().simulate_many(
        1.5, vary={"coil": {"stiffness": [0.0, 3.0]}}, measure={"x": final("gear.x")}, steps=10
    )
    assert many.good.tolist() == [False, True]
    assert many.alone[1] is None
    assert "'mesh' meet at t = " in str(many.reason[0])
    np.testing.assert_allclose(many["x"][1], loose_gears(3.0).simulate(1.5, steps=10).body("gear").x[-1], atol=1e-9)


def test_numbers_of_friction_vary_and_jamming_rows_say_so() -> None:
    """A rod that slides into the floor: from some friction on there is no motion (Painleve)."""
    rows = [0.2, 0.5, 2.5]
    m = rod()
    many = m.simulate_many(0.3, vary={"tip": {"friction": rows}}, measure={"x": final("rod.x")}, steps=10)
    assert many.good.tolist() == [True, True, False]
    with pytest.raises(SimulationError) as jams:
        rod(rows[2]).simulate(0.3, steps=10)
    assert str(jams.value) in str(many.reason[2])
    for k in range(2):
        expected = rod(rows[k]).simulate(0.3, steps=10).body("rod").x[-1]
        np.testing.assert_allclose(many["x"][k], expected, atol=2e-9)


def thrown(
    slope: float,
    friction: float,
    above: float,
    restitution: float,
    feet: int,
    swing: float,
    spring: float,
    moving: Start,
) -> Mechanism:
    """A body on some feet above a plane that swings to and fro, tied to ground by a spring, thrown."""
    m = Mechanism("thrown", gravity=(0, -G))
    base, body = m.body("base", 1.0, inertia=1.0), m.body("body", 1.0, inertia=0.02)
    m.prismatic("rail", m.ground.at(0, 0, math.radians(slope)), base.origin)
    m.drive_coordinate("motor", m.ground.at(0, 0, math.radians(slope)), base.origin, harmonic(swing, 9.0))
    for k in range(feet):
        angle = -math.pi / 2 + (k - 0.5 * (feet - 1)) * 0.9
        foot = body.at(0.2 * math.cos(angle), 0.2 * math.sin(angle))
        m.rigid_contact(f"foot {k}", base.origin, foot, 0.02, restitution, friction, friction * (1 + above))
    m.spring("spring", m.ground.at(0, 1), body.origin, spring, 0.1, free_length=0.8)
    m.start_near(base=(0, 0, slope), body=(0, 0.5, slope))
    m.start_moving(**moving)
    return m


@settings(max_examples=25)
@given(
    slope=st.floats(-30, 30),
    friction=st.floats(0.05, 0.9),
    above=st.sampled_from([0.0, 0.0, 0.3]),
    restitution=st.sampled_from([0.0, 0.3, 0.7]),
    feet=st.integers(1, 4),
    swing=st.sampled_from([0.0, 0.02, 0.1]),
    spring=st.sampled_from([0.0, 20.0]),
    speed=st.tuples(st.floats(-2, 2), st.floats(-2, 1), st.floats(-10, 10)),
)
def test_random_bodies_thrown_onto_a_rough_plane(speed: tuple[float, float, float], **given: Any) -> None:
    compare(lambda: thrown(moving={"body": speed}, **given), 1.0, {"body": {"mass": [1.0, 1.3]}}, "body")
