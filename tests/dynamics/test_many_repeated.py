"""Joints that repeat others in the compiled loop over simulations: what single simulations of the same rows give."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.dynamics.batch import worker
from mbsd.dynamics.batch.simulate_many import asked_for
from mbsd.dynamics.batch.single_run import based_on, single_run
from mbsd.dynamics.events import driver as steps
from mbsd.dynamics.repeated_rows.arrays import Repeated
from mbsd.dynamics.repeated_rows.packing import opened
from mbsd.measures import final, largest, samples
from tests.dynamics.beside_single_runs import assert_as_single_ones, between
from tools.models.repeated_joints import cranks, doors, dry, row_of_cranks

STEPS = 40


Build = Callable[[], Mechanism]
CASES: dict[str, tuple[Build, float, dict[str, tuple[str, float, float]], str, str]] = {
    "swinging": (cranks, 2.0, {"spring": ("stiffness", 0.5, 4.0)}, "crank0", "A2.fx"),
    "turning": (lambda: cranks(12.0), 1.5, {"coupler": ("mass", 0.5, 2.0)}, "crank2", "B1.fy"),
    "stops": (lambda: cranks(stops=True), 1.5, {"spring": ("stiffness", 2.0, 9.0)}, "crank0", "A1.fy"),
    "motor": (lambda: cranks(motor=True), 1.0, {"crank2": ("mass", 0.2, 2.0)}, "crank2", "motor.effort"),
    "friction": (lambda: dry(False), 1.5, {"spring": ("stiffness", 0.5, 4.0)}, "crank0", "A2.fx"),
    "sticks": (lambda: dry(True), 1.5, {"spring": ("stiffness", 0.5, 4.0)}, "crank0", "A1.fy"),
    "row": (row_of_cranks, 0.5, {"spring": ("stiffness", 0.5, 4.0)}, "crank0", "A2.fx"),
    "doors": (doors, 2.0, {"tie": ("stiffness", 10.0, 60.0)}, "leaf", "other.fy"),
}


@pytest.mark.parametrize("case", CASES)
def test_rows_that_repeat_others_hold_as_in_single_simulations(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    build, duration, varied, body, own = CASES[case]
    random, count = np.random.default_rng(7), 4 if case == "row" else 10
    vary = {name: {key: random.uniform(low, high, count)} for name, (key, low, high) in varied.items()}
    measures: dict[str, Any] = {
        "theta": samples(f"{body}.theta", [0.5 * duration, duration]),
        "omega": final(f"{body}.omega"),
        "own": largest(own),
        "work": final("work"),
    }
    many = build().simulate_many(duration, vary=vary, measure=measures, steps=STEPS)
    assert many.alone == [None] * count, many.way
    assert "anew" not in many.way
    exchanged = list[int]()

    def noted(repeated: Repeated) -> list[int]:
        exchanged.append(len(opened(repeated)))
        return opened(repeated)

    monkeypatch.setattr(steps, "opened", noted)
    struck = 0
    for k in range(count):
        m = build()
        for name, values in vary.items():
            m.change(name, **{key: float(column[k]) for key, column in values.items()})
        sol = m.simulate(duration, steps=STEPS)
        struck += sum(event.what == "impact" for event in sol.events)
        reaction = dict(zip([c.rpartition(" [")[0] for c in sol.columns()], sol.columns().values(), strict=True))[own]
        np.testing.assert_allclose(many["theta"][k], sol.body(body).theta[[STEPS // 2, STEPS]], atol=1e-10)
        np.testing.assert_allclose(many["omega"][k], sol.body(body).omega[-1], atol=1e-9)
        np.testing.assert_allclose(many["own"][k], reaction.max(), rtol=1e-8)
        if case == "motor":  # where the rows that hold lie flat, what a driver gives is known as well as tolerated
            sol = m.simulate(duration, steps=STEPS, tolerance=1e-12)
        assert sol.work is not None
        np.testing.assert_allclose(many["work"][k], sol.work[-1], atol=5e-6 if case == "motor" else 1e-9)
    assert (case == "turning") <= (max(exchanged) > min(exchanged))
    assert (case == "stops") <= (struck >= count)


def test_rows_are_exchanged_for_steps_in_which_all_contacts_are_open_as_well() -> None:
    m = cranks(12.0, stops=True)
    asked = asked_for(m, 1.0, STEPS, None, "dop853", 1e-9, None, "auto", {})
    dyn, _, _, _, contacts, _ = based_on(single_run(m, asked)).arguments
    assert contacts.schur.rows is dyn.schur.rows
    assert contacts.schur.rows.flags.writeable


def test_machines_with_many_rows_are_prepared_a_few_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    vary, measure = (
        {"coupler": {"mass": [0.5, 0.7, 1.0, 2.0]}},
        {"own": largest("A1.fy"), "theta": final("crank2.theta")},
    )
    given = []
    for most in (worker.GRAMS_AT_ONCE, 0, 2 * 12**2):
        monkeypatch.setattr(worker, "GRAMS_AT_ONCE", most)
        many = cranks(stops=True).simulate_many(1.0, vary=vary, measure=measure, steps=10, threads=1)
        assert many.alone == [None] * 4
        assert "anew" in many.way
        given.append(many)
    for name in measure:
        np.testing.assert_array_equal(given[0][name], given[1][name])
        np.testing.assert_array_equal(given[0][name], given[2][name])


@pytest.mark.slow
def test_as_many_rows_repeat_others_as_single_simulations_exchange() -> None:
    measure = {"theta": final("crank0.theta"), "own": final("A2.fx")}
    many = row_of_cranks(60).simulate_many(0.5, vary={"spring": {"stiffness": [1.0, 3.0]}}, measure=measure, steps=10)
    assert many.alone == [None, None], many.way
    for k, stiffness in enumerate((1.0, 3.0)):
        m = row_of_cranks(60)
        m.change("spring", stiffness=stiffness)
        sol = m.simulate(0.5, steps=10)
        np.testing.assert_allclose(many["theta"][k], sol.body("crank0").theta[-1], atol=1e-10)
        np.testing.assert_allclose(many["own"][k], sol.joint("A2").fx[-1], rtol=1e-8)


@pytest.mark.slow
@settings(max_examples=12, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(st.data())
def test_random_cranks_with_friction_move_as_by_themselves(data: st.DataObject) -> None:
    m = Mechanism("cranks", gravity=(0, -9.81))
    coupler = m.bar("coupler", 0.6, mass=data.draw(between(0.3, 2.0)))
    start = data.draw(between(-85.0, -55.0))  # they hang and never lie flat, where joints that repeat others jam
    for k in range(data.draw(st.integers(3, 5))):
        x, y = 0.14 * k + data.draw(between(0.0, 0.1)), data.draw(between(-0.2, 0.2))
        crank = m.bar(f"crank{k}", 0.3, mass=data.draw(between(0.1, 1.0)))
        m.revolute(f"A{k}", m.ground.at(x, y), crank.start)
        m.revolute(f"B{k}", crank.end, coupler.at(x, y))
        if data.draw(st.booleans()):
            sticks = data.draw(st.booleans())
            m.friction(f"friction{k}", f"A{k}", data.draw(between(0.01, 0.1)), radius=0.02, sticks=sticks)
    m.torsion_spring(
        "spring", m.ground, m.bodies["crank0"], data.draw(between(0.0, 4.0)), 0.05, free_angle=-math.pi / 2
    )
    m.start_near(**dict.fromkeys([name for name in m.bodies if name.startswith("crank")], start))
    assert_as_single_ones(m, "coupler", 0.8, 8, 1e-9)
