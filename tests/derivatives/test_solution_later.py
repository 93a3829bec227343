"""The solution of sensitivities is solved when it is asked for, and is that of the model as it was."""

from __future__ import annotations

import copy
import pickle

import numpy as np

import mbsd
from benchmarks.derivatives.measure import linkage
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
    found, known = m.sensitivities(ASKED, NUMBERS, 0.2, 20), m.simulate(0.2, steps=20, tolerance=1e-9)
    m.change("a", length=0.05)
    m.change("s", stiffness=10.0)
    m.bodies["b"].z = 0.3
    m.trace("Q", m.bodies["c"].at(0.01, 0.0))
    later = found.solution
    assert later is found.solution
    for part in PARTS:
        np.testing.assert_array_equal(getattr(later, part), getattr(known, part))
    assert set(later.traces or {}) == {"P"}
    assert repr(later.planes) == repr(known.planes)
    np.testing.assert_array_equal(later.at(0.0123).q, known.at(0.0123).q)


def test_values_are_those_of_the_simulation() -> None:
    m = traced()
    found, known = m.sensitivities(ASKED, NUMBERS, 0.2, 20), m.simulate(0.2, steps=20, tolerance=1e-9)
    body = known.body("b")
    expected = {
        "x": body.x,
        "path": known.point("P").vy,
        "end": known.body("a").theta[-1],
        "kinetic": known.energy.kinetic,
        "some": body.y[[10, 20]],
    }
    np.testing.assert_array_equal(found.t, known.t)
    for label, values in expected.items():
        np.testing.assert_allclose(found.values[label], values, rtol=1e-14, atol=1e-16)


def test_it_comes_along_when_sensitivities_are_pickled_or_copied() -> None:
    m = traced()
    found = m.sensitivities(ASKED, NUMBERS, 0.2, 20)
    for other in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found)):
        np.testing.assert_array_equal(other["x"], found["x"])
        np.testing.assert_array_equal(other.solution.q, found.solution.q)
        np.testing.assert_array_equal(other.solution.lam, found.solution.lam)
