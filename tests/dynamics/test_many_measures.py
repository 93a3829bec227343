"""What many simulations measure: the numbers of single ones, whatever is asked beside."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import first, integral, largest, samples, smallest
from tests.dynamics.many_models import STEPS, door, pendulum
from tools.models.stops import barrier


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
