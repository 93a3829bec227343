"""Measures of many simulations: rows that end early and outputs that are left out leave no trace in the digits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, harmonic
from mbsd.dynamics.batch import loop
from mbsd.measures import Measure, final, first, integral, largest, samples, smallest
from tests.dynamics.many_models import STEPS, door, pendulum
from tools.models.stops import barrier
from tools.numbers.blocks import cam


def test_measures_are_what_they_say() -> None:
    many = door().simulate_many(
        4.0,
        vary={"closer": {"stiffness": [4.0, 8.0]}},
        measure={
            "shut": first("door.theta", below=1.0),
            "speed": first("door.theta", below=1.0, give="door.omega"),
            "never": first("door.theta", above=7.0),
            "fast": smallest("door.omega"),
            "way": integral("door.omega"),
            "power": integral("closer.power"),
        },
        steps=400,
    )
    for k, stiffness in enumerate((4.0, 8.0)):
        sol = door(stiffness).simulate(4.0, steps=400)
        leaf = sol.body("door")
        at = sol.at([many["shut"][k]])
        np.testing.assert_allclose(at.body("door").theta, 1.0, atol=1e-4)
        np.testing.assert_allclose(at.body("door").omega, many["speed"][k], atol=1e-4)
        assert np.isnan(many["never"][k])
        assert many["fast"][k] == leaf.omega.min()
        assert many["fast_time"][k] == sol.t[np.argmin(leaf.omega)]
        np.testing.assert_allclose(many["way"][k], leaf.theta[-1] - leaf.theta[0], atol=1e-4)
        np.testing.assert_allclose(many["power"][k], np.trapezoid(sol.force("closer").power, sol.t), rtol=1e-12)
    assert "'closer.power'" in many.way


def test_a_function_of_solutions_measures_too() -> None:
    many = door().simulate_many(
        1.0, vary={"closer": {"stiffness": [4.0, 8.0]}}, measure=lambda sol: {"x": sol.body("door").theta[-1]}, steps=5
    )
    assert many["x"][1] == door(8.0).simulate(1.0, steps=5).body("door").theta[-1]
    assert "function of a solution" in many.way


@pytest.mark.parametrize("build", [door, pendulum, barrier, lambda: barrier(stops=True)])
@pytest.mark.parametrize("formulation", ["auto", "reference"])
def test_what_is_measured_beside_changes_no_digit(build: Callable[[], Mechanism], formulation: str) -> None:
    m = build()
    body, joints = list(m.bodies)[-1], list(m.joints)
    motion = {"theta": samples(f"{body}.theta", [0.1, 0.4]), "fast": largest(f"{body}.omega"), "e": integral("kinetic")}
    forces = {"a": smallest(f"{body}.alpha")} | {name: largest(f"{name}.torque") for name in joints}
    asked = [motion, motion | forces, *({name: each} for name, each in forces.items())]
    vary = {body: {"mass": [1.0, 2.0]}}
    made = [m.simulate_many(0.4, vary=vary, measure=each, steps=STEPS, formulation=formulation) for each in asked]
    whole = made[1]
    assert whole.alone == [None, None]
    for each in made:
        for name, column in each.columns.items():
            assert column.tolist() == whole[name].tolist()


@pytest.mark.parametrize("method", ["rk4", "radau", "generalized_alpha"])
def test_other_methods_end_early_or_not_with_the_same_digits(method: str) -> None:
    asked = {"vary": {"closer": {"stiffness": [4.0, 8.0, 12.0]}}, "steps": 400, "method": method, "step": 0.02}
    shut = {"shut": first("door.theta", below=1.0)}
    early = door().simulate_many(20.0, measure=shut, **asked)
    whole = door().simulate_many(20.0, measure=shut | {"end": final("door.theta")}, **asked)
    assert np.array_equal(early["shut"], whole["shut"])
    assert early.good.all()


DURATION, OUTPUTS = 2.0, 120
TIMES = [0.5, 1.5]
ALL = {"all": integral("kinetic")}
"""What reads all outputs."""


def driven() -> Mechanism:
    """A crank that is driven to and fro, with a pendulum on it."""
    m = Mechanism("driven")
    crank, rod = m.bar("crank", 0.2, mass=0.5), m.bar("rod", 0.4, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.drive_angle("motor", crank, harmonic(0.6, 3.0))
    m.start_near(rod=-80)
    return m


def rough() -> Mechanism:
    """Friction goes on from the last output: none is left out."""
    m = door()
    m.friction("pin", "hinge", coefficient=0.1, radius=0.02)
    return m


MACHINES: dict[str, tuple[Callable[[], Mechanism], str, bool]] = {
    "door": (door, "door", True),
    "pendulum": (pendulum, "b", True),
    "barrier": (barrier, "rocker", True),
    "driven": (driven, "rod", True),
    "barrier with a stop": (lambda: barrier(stops=True), "rocker", False),
    "rough door": (rough, "door", False),
    "cam": (cam, "lever", False),
}
"""What builds it, a body of it, and whether outputs may be left out in independent coordinates."""


def _measures(body: str) -> tuple[dict[str, Measure], dict[str, Measure]]:
    last = {
        "work": final("work"),
        "t": final("t"),
        "alpha": final(f"{body}.alpha"),
        "some": samples(f"{body}.theta", TIMES),
    }
    return last, {"slow": first(f"{body}.omega", below=0.3, give=f"{body}.theta"), "never": first("kinetic", above=1e9)}


@pytest.mark.parametrize("formulation", ["auto", "reference"])
@pytest.mark.parametrize("name", MACHINES)
def test_no_digit_depends_on_what_is_left_out(name: str, formulation: str) -> None:
    build, body, _ = MACHINES[name]
    m, mass = build(), build().bodies[body].mass
    last, until = _measures(body)
    asked = [last, {"slow": until["slow"], **last}, {**until, **last}, {**ALL, **until, **last}]
    made = [_many(m, body, mass, each, formulation) for each in asked]
    for many, measures in zip(made, asked, strict=True):
        assert many.good.all()
        for column in measures:
            np.testing.assert_array_equal(many[column], made[-1][column], err_msg=column)


@pytest.mark.parametrize("name", MACHINES)
def test_they_are_left_out_where_nothing_goes_on_from_them(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    build, body, possible = MACHINES[name]
    made, run_rows = [], loop.run_rows

    def noted(*arguments):
        made.append(len(arguments[-1].t))
        run_rows(*arguments)

    monkeypatch.setattr(loop, "run_rows", noted)
    m = build()
    _many(m, body, m.bodies[body].mass, _measures(body)[0], "auto")
    assert set(made) == ({4} if possible else {OUTPUTS + 1})


@given(st.floats(1.0, 30.0), st.floats(0.5, 40.0), st.integers(2, 200), st.floats(-1.0, 1.5), st.data())
def test_doors_of_any_kind(stiffness: float, damping: float, steps: int, level: float, data: st.DataObject) -> None:
    m, at = door(), data.draw(st.integers(0, steps))
    times = np.linspace(0.0, 3.0, steps + 1)
    measures = {
        "there": first("door.theta", below=level),
        "some": samples("door.omega", [times[at]]),
        "end": final("door.theta"),
        "place": final("door.x"),
    }
    vary = {"closer": {"stiffness": [stiffness, 2.0 * stiffness], "damping": damping}}
    few, whole = (m.simulate_many(times=times, vary=vary, measure=each) for each in (measures, {**measures, **ALL}))
    for column in measures:
        np.testing.assert_array_equal(few[column], whole[column], err_msg=column)
    assert np.isfinite(few["end"]).all()
    assert (few["there"] <= 3.0).sum() == (~np.isnan(few["there"])).sum()


def test_starts_vary_and_lengths_too() -> None:
    m = pendulum()
    last, until = _measures("b")
    for vary, start in (({}, {"a": [-80.0, 10.0, 170.0]}), ({"a": {"length": [0.9, 1.0, 1.1]}}, None)):
        few, whole = (
            m.simulate_many(DURATION, vary=vary, start=start, measure=each, steps=OUTPUTS)
            for each in ({**until, **last}, {**ALL, **until, **last})
        )
        assert few.alone == [None] * 3
        for column in (*last, *until):
            np.testing.assert_array_equal(few[column], whole[column], err_msg=column)


def test_what_is_changed_in_between_counts() -> None:
    m, made = door(), []
    for stiffness in (5.0, 9.0, 5.0):
        m.change("closer", stiffness=stiffness)
        many = m.simulate_many(DURATION, start={"door": [90.0]}, measure={"end": final("door.theta")}, steps=OUTPUTS)
        made.append(many["end"][0])
        assert many["end"][0] == m.simulate(DURATION, steps=OUTPUTS).body("door").theta[-1]
    assert made[0] == made[2] != made[1]


def _many(m: Mechanism, body: str, mass: float, measures: dict[str, Measure], formulation: str):
    vary = {body: {"mass": [mass, 1.3 * mass]}}
    return m.simulate_many(DURATION, vary=vary, measure=measures, steps=OUTPUTS, formulation=formulation, threads=1)
