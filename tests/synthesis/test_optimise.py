"""Optimised numbers: optima that are known, conditions that hold, and what is refused before anything runs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import mbsd.synthesis.evaluation
from mbsd import Mechanism, ModelError, constant_rate, optimise
from mbsd.measures import final, largest, smallest


def crank(weight: float = 0.5, arm: float = 0.05) -> Mechanism:
    m = Mechanism("crank")
    rod = m.bar("rod", 0.2, mass=1.0)
    weighted = m.body("weight", mass=weight)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.weld("W", rod.at(-arm, 0), weighted.origin)
    m.drive_angle("motor", rod, constant_rate(2 * math.pi))
    return m


def door() -> Mechanism:
    m = Mechanism("door", gravity=None)
    rod = m.bar("rod", 0.8, mass=10.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.torsion_spring("closer", m.ground, rod, stiffness=20.0, damping=20.0, free_angle=-0.1)
    m.start_near(rod=90)
    return m


@pytest.mark.parametrize("method", ["SLSQP", "trust-constr"])
def test_a_counterweight_takes_the_torque_away(method: str) -> None:
    of = lambda sol: float((sol.driver("motor").effort ** 2).mean())  # noqa: E731
    r = optimise(crank(), of, {"weight.mass": (0.1, 5.0)}, steps=60, method=method)
    assert r.values["weight.mass"] == pytest.approx(0.1 / 0.05, rel=1e-4)
    assert r.objective < 1e-6
    assert r.met
    assert r.mechanism.bodies["weight"].mass == r.values["weight.mass"]


def test_a_place_and_a_mass_within_bounds_and_a_condition() -> None:
    of = lambda sol: float((sol.driver("motor").effort ** 2).mean())  # noqa: E731
    r = optimise(
        crank(), of, {"weight.mass": (0.1, 1.0), "W.i.x": (-0.3, -0.01)}, {"light": ("weight.mass", None, 0.4)}
    )
    assert r.met
    assert r.conditions["light"] <= 0.4 + 1e-6
    assert -r.values["W.i.x"] * r.values["weight.mass"] == pytest.approx(0.1, rel=1e-3)


def test_the_softest_closer_that_shuts_a_door_in_time() -> None:
    r = optimise(
        door(), "closer.stiffness", {"closer.stiffness": (1, 100), "closer.damping": (5, 50)},
        [(final("rod.theta"), None, 0.05), (smallest("rod.omega"), -1.0, None)], duration=4.0, steps=80,
    )  # fmt: skip
    assert r.met
    assert r.conditions["rod.theta"] == pytest.approx(0.05, abs=1e-5)
    assert r.evaluations < 40
    m = door()
    for factor, shuts in ((1.0, True), (0.97, False)):
        m.change("closer", stiffness=factor * r.values["closer.stiffness"], damping=r.values["closer.damping"])
        assert bool(m.simulate(4.0).body("rod").theta[-1] <= 0.05 + 1e-5) is shuts


def test_functions_of_the_author_are_optimised_by_their_arguments() -> None:
    def build(weight: float = 0.5, arm: float = 0.05) -> Mechanism:
        return crank(weight, arm)

    of = lambda sol: float((sol.driver("motor").effort ** 2).mean())  # noqa: E731
    r = optimise(crank(), of, {"arm": (0.01, 0.4)}, build=build, steps=60)
    assert r.values["arm"] == pytest.approx(0.1 / 0.5, rel=1e-4)


def test_maximise_and_a_search_that_meets_motions_that_are_none() -> None:
    m = Mechanism("four_bar")
    a, b, c = m.bar("a", 0.04), m.bar("b", 0.12), m.bar("c", 0.09)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(0.12, 0), c.start)
    m.drive_angle("motor", a, constant_rate(1.0))
    m.start_near(a=0, b=45, c=100)
    swing = lambda sol: float(np.ptp(sol.body("c").theta))  # noqa: E731
    r = optimise(m, swing, {"a.length": (0.02, 0.2)}, maximise=True, steps=90, most=15)
    assert 0.08 < r.values["a.length"] < 0.09 + 1e-6  # Grashof: 0.04 + ... ends where the crank no longer turns
    assert r.objective > 1.5
    assert np.isnan(r.history).any()


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ({"vary": {"closer.stifness": (1, 2)}}, "'closer': there is no number 'stifness', did you mean 'stiffness'"),
        ({"vary": {"closer.stiffness": (5, 2)}}, "may be from 5 to 2; the first must be smaller"),
        ({"vary": {"closer.stiffness": (1, math.nan)}}, "bound of 'closer.stiffness' is nan"),
        ({"vary": {"closer.stiffness": (1, "much")}}, "bound of 'closer.stiffness' is 'much'"),
        ({"vary": {"closer.stiffness": 3.0}}, "bounds of 'closer.stiffness' are 3.0"),
        ({"vary": {}}, "vary is {}"),
        ({"vary": {"rod": (-0.5, 2.0)}}, "'rod' may be from -0.5 to 2, and the mechanism refuses -0.5: bar 'rod'"),
        ({"vary": {"rod": (0.5, 2.0), "rod.length": (0.5, 2.0)}}, "'rod' and 'rod.length' are the same number"),
        ({"precision": -1.0}, "precision is -1; it must be positive"),
        ({"simulate": "no"}, "simulate is 'no'"),
        ({"build": 3}, "build is 3; give a function"),
        ({"steps": 0}, "steps is 0"),
        ({"most": 0}, "most is 0"),
        ({"stps": 10}, "door: optimise: there is no argument 'stps', did you mean 'steps'"),
        ({"duration": -1.0}, "duration"),
        ({"objective": "rod.theta"}, "'rod.theta', which is no number that varies; for a quantity take a measure"),
        ({"objective": 3}, "the objective is|objective is 3"),
        ({"objective": final("rod.thet")}, "there is no quantity 'rod.thet', did you mean 'rod.theta'"),
        ({"constraints": [(final("rod.theta"), 2, 1)]}, "goes from 2 to 1"),
        ({"constraints": [(final("rod.theta"), None, None)]}, "has no end"),
        ({"constraints": [final("rod.theta")]}, "write \\(measure, lowest, highest\\)"),
        ({"method": "simplex"}, "there is no method 'simplex'"),
        ({"start": {"closer.stiffness": 300}}, "start of 'closer.stiffness' is 300; it may be from 1 to 100"),
        ({"start": {"closer.damping": 3}}, "no number that varies 'closer.damping'"),
        ({"tolerance": 0.0}, "tolerance is 0"),
        ({"progress": 3}, "progress is 3"),
        ({"progress": lambda motions: None}, "progress must be a function of the number of motions and the objective"),
        ({"objective": lambda sol, more: 1.0}, "objective must be a function of a solution, a single argument"),
        ({"constraints": [(final("rod.thet"), 0, 1)]}, "there is no quantity 'rod.thet', did you mean 'rod.theta'"),
        ({"build": lambda stiff=3.0: door()}, "build has no argument 'closer.stiffness'"),
    ],
)
def test_invalid_requests_are_refused_before_anything_runs(
    asked: dict[str, Any], says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ran(*given: Any) -> None:
        raise AssertionError("it ran")

    monkeypatch.setattr(mbsd.synthesis.evaluation.Moves, "_tangents", ran)
    given = {"objective": "closer.stiffness", "vary": {"closer.stiffness": (1, 100)}, "duration": 1.0} | asked
    if "vary" in asked or "build" in asked:
        given["objective"] = largest("rod.omega") if "objective" not in asked else asked["objective"]
    with pytest.raises(ModelError, match=says):
        optimise(door(), given.pop("objective"), given.pop("vary"), **given)


def test_a_measure_that_gives_text_or_many_numbers_is_refused_at_the_first_motion() -> None:
    for what, says in ((lambda sol: "fast", "gives 'fast'"), (lambda sol: sol.t, "gives 11 numbers")):
        with pytest.raises(ModelError, match=says):
            optimise(door(), what, {"closer.stiffness": (1, 100)}, duration=0.1, steps=10)
