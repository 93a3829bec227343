"""The solution of sensitivities is solved when it is asked for, and is that of the model as it was."""

from __future__ import annotations

import copy
import pickle

import numpy as np

import mbsd
from benchmarks.derivatives import linkage
from mbsd.measures import final, samples

ASKED = {"x": "b.x", "path": "P.vy", "end": final("a.theta"), "kinetic": "kinetic", "some": samples("b.y", [0.1, 0.2])}
NUMBERS = ["a.mass", "a.length", "P.x", "s.stiffness"]
PARTS = ("t", "q", "v", "a", "lam", "wrench", "margin", "work", "held")


def traced() -> mbsd.Mechanism:
    m = linkage()
    m.trace("P", m.bodies["b"].at(0.05, 0.02))
    return m


def test_the_model_may_change_before_it_is_asked_for() -> None:
    m = traced()
    slopes, known = m.sensitivities(ASKED, NUMBERS, 0.2, 20), m.simulate(0.2, steps=20, tolerance=1e-9)
    m.change("a", length=0.05)
    m.change("s", stiffness=10.0)
    m.bodies["b"].z = 0.3
    m.trace("Q", m.bodies["c"].at(0.01, 0.0))
    later = slopes.solution
    assert later is slopes.solution
    for part in PARTS:
        np.testing.assert_array_equal(getattr(later, part), getattr(known, part))
    assert set(later.traces or {}) == {"P"}
    assert repr(later.planes) == repr(known.planes)
    np.testing.assert_array_equal(later.at(0.0123).q, known.at(0.0123).q)


def test_values_are_those_of_the_simulation() -> None:
    m = traced()
    slopes, known = m.sensitivities(ASKED, NUMBERS, 0.2, 20), m.simulate(0.2, steps=20, tolerance=1e-9)
    body = known.body("b")
    expected = {
        "x": body.x,
        "path": known.point("P").vy,
        "end": known.body("a").theta[-1],
        "kinetic": known.energy.kinetic,
        "some": body.y[[10, 20]],
    }
    np.testing.assert_array_equal(slopes.t, known.t)
    for label, values in expected.items():
        np.testing.assert_allclose(slopes.values[label], values, rtol=1e-14, atol=1e-16)


def test_it_comes_along_when_sensitivities_are_pickled_or_copied() -> None:
    m = traced()
    slopes = m.sensitivities(ASKED, NUMBERS, 0.2, 20)
    for other in (pickle.loads(pickle.dumps(slopes)), copy.deepcopy(slopes)):
        np.testing.assert_array_equal(other["x"], slopes["x"])
        np.testing.assert_array_equal(other.solution.q, slopes.solution.q)
        np.testing.assert_array_equal(other.solution.lam, slopes.solution.lam)


def test_a_function_that_asks_for_the_mechanism_gets_the_one_with_the_other_number() -> None:
    m, seen = traced(), []

    def pull(sol: mbsd.Solution) -> float:
        seen.append(sol.mechanism.forces["s"].params["stiffness"])
        return sol.mechanism.forces["s"].params["stiffness"] * float(sol.body("b").x[-1])

    def mean(sol: mbsd.Solution) -> float:
        return float(sol.joint("A").fx.mean())

    slopes = m.sensitivities({"pull": pull, "mean": mean, "x": "b.x", "fx": "A.fx"}, ["s.stiffness"], 0.2, 20)
    stiffness, x = m.forces["s"].params["stiffness"], float(slopes.solution.body("b").x[-1])
    assert len(set(seen)) == 3
    np.testing.assert_allclose(slopes["pull"], x + stiffness * slopes["x"][-1], rtol=1e-6)
    np.testing.assert_allclose(slopes["mean"], slopes["fx"].mean(axis=0), rtol=1e-6)
