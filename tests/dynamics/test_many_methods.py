"""Many simulations by other integrators than the usual one: the digits of single ones."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import final, first, samples
from tests.dynamics.many_models import STEPS, door, pendulum

METHODS = [
    ("rk4", {"step": 2e-3}),
    ("baumgarte", {"step": 2e-3, "alpha": 20.0}),
    ("rattle", {"step": 2e-3}),
    ("symplectic", {"step": 5e-3}),
    ("generalized_alpha", {"step": 2e-3, "rho": 0.6}),
    ("radau", {"tolerance": 1e-6}),
]


@pytest.mark.parametrize(("method", "options"), METHODS, ids=[method for method, _ in METHODS])
def test_other_methods_go_in_the_loop_with_their_own_digits(method: str, options: dict[str, float]) -> None:
    def swinging(stiffness: float, mass: float) -> Mechanism:
        m = pendulum()
        m.torsion_spring("early", m.ground, m.bodies["a"], stiffness, 0.0)
        m.change("b", mass=mass)
        return m

    stiffness, mass = np.array([1.0, 4.0, 9.0]), np.array([0.4, 0.5, 0.6])
    many = swinging(1.0, 0.4).simulate_many(
        0.5,
        vary={"early": {"stiffness": stiffness}, "b": {"mass": mass}},
        measure={"x": samples("P.x", [0.25, 0.5]), "r": final("A.fx"), "when": first("a.theta", above=-1.2)},
        steps=STEPS,
        method=method,
        **options,
    )
    assert many.alone == [None] * 3
    for k in range(3):
        sol = swinging(stiffness[k], mass[k]).simulate(0.5, steps=STEPS, method=method, **options)
        assert many["x"][k].tolist() == sol.point("P").x[[10, 20]].tolist()
        np.testing.assert_allclose(many["r"][k], sol.joint("A").fx[-1], rtol=1e-9)


@pytest.mark.parametrize("method", ["rk4", "radau", "generalized_alpha"])
def test_other_methods_end_early_or_not_with_the_same_digits(method: str) -> None:
    asked = {"vary": {"closer": {"stiffness": [4.0, 8.0, 12.0]}}, "steps": 400, "method": method, "step": 0.02}
    shut = {"shut": first("door.theta", below=1.0)}
    early = door().simulate_many(20.0, measure=shut, **asked)
    whole = door().simulate_many(20.0, measure=shut | {"end": final("door.theta")}, **asked)
    assert np.array_equal(early["shut"], whole["shut"])
    assert early.good.all()


def test_a_method_of_python_and_a_step_without_solution_say_why_they_are_by_themselves() -> None:
    asked = {"vary": {"closer": {"stiffness": [4.0, 8.0]}}, "measure": {"x": final("door.theta")}, "steps": 4}
    assert "'scipy-radau' has no loop over many" in door().simulate_many(0.5, method="scipy-radau", **asked).way
    many = door().simulate_many(
        40.0, vary={"closer": {"stiffness": [4.0, 4e6]}}, measure=asked["measure"], steps=4, method="rk4", step=1.0
    )
    assert many.good.tolist() == [True, False]
    assert "the equations of a step of 1 s have no solution" in str(many.reason[1])
    assert many.alone == [None, "the equations of a step had no solution"]
