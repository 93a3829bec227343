"""Invalid requests are refused before anything runs, by name and with the remedy."""

from __future__ import annotations

from typing import Any

import pytest

from mbsd import Clearance, Mechanism, ModelError, Normal, Uniform, tolerances
from mbsd.measures import largest, samples
from tests.tolerancing.linkages import four_bar, switch

ANGLE = largest("rocker.theta")


@pytest.fixture(autouse=True)
def _nothing_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """No machine but those in the middle is solved."""

    def refuse(*_: object) -> None:
        raise AssertionError("machines were drawn")

    monkeypatch.setattr("mbsd.tolerancing.tolerances.drawn", refuse)


@pytest.mark.parametrize(
    ("sizes", "said"),
    [
        ({"crnk": 1e-5}, "did you mean 'crank'"),
        ({}, "give names and tolerances"),
        ([1e-5], "give names and tolerances"),
        ("x", "class of ISO 2768-1"),
        ({"crank": 0.05}, "would pass 0"),
        ({"crank": Uniform(0.04)}, "would pass 0; narrow it"),
        ({"crank": 0.02}, "cut=True"),
        ({"crank": {"mass": Normal(0.3, cut=True)}}, "'crank.mass' is 0.2 and strays from -0.3"),
        ({"crank": -1e-5}, "a tolerance is above 0"),
        ({"crank": (1e-5, 1e-5)}, "the lower limit comes first"),
        ({"crank": "IT99"}, "a grade such as 'IT7'"),
        ({"crank": {"lenth": 1e-5}}, "did you mean 'length'"),
        ({"crank": {"com": 1e-5}}, "only a number can stray"),
        ({"motor": 1e-5}, r"say which of its numbers strays \(rate, start, "),
        ({"motor": {"rat": 1e-5}}, "did you mean 'rate'"),
        ({"crank": {"B.x": 0.5}}, "'crank.B.x' strays by up to 0.5 m, and 'crank' reaches 0.04 m"),
        ({"gravity": {"z": 0.1}}, "no number 'z'"),
        ({"motor": Clearance(1e-5)}, "no pin 'motor'"),
        ({"ground": 1e-5}, "'ground'"),
        ({"B": {"x": 1e-5, "play": 1e-5}}, "give Clearance"),
        ({"A": {"y": "m"}}, "by the size of a length"),
        ({"A": {"z": 1e-5}}, "no number 'z'"),
        ({"D": {"x": 0.5}}, "'D.x' strays by up to 0.5 m, and 'ground' reaches"),
        ({"P": {"y": 5.0}}, "'P.y' strays by up to 5 m"),
        ({"B": Clearance(0.5)}, "half of its play, up to 0.25 m, and 'crank' reaches 0.04 m"),
        ({"P": {"z": 1e-5}}, "'P': there is no number 'z'"),
        ({"crank": 1e-5, "coupler": {"length": 1e-5}, "P": {"x": 1e-5}, "D": None}, "'D.x' is None"),
    ],
)
def test_sizes(sizes: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        tolerances(four_bar(mass=0.2), sizes, ANGLE)


def test_a_number_named_twice() -> None:
    m = four_bar()
    m.spring("crank.length", m.ground.at(0, 0), m.bodies["rocker"].end, stiffness=1.0, free_length=0.1)
    with pytest.raises(ModelError, match="there is no"):
        tolerances(m, {"crank": {"length": 1e-5, "lengths": 1e-5}}, ANGLE)


@pytest.mark.parametrize(
    ("result", "said"),
    [
        (None, "give a measure of mbsd.measures"),
        ("P.y", "give a measure of mbsd.measures"),
        (largest("Q.y"), "did you mean 'P.y'"),
        (samples("P.y", [0.25, 0.5]), "gives 2 numbers"),
        (samples("P.y", [0.2501]), "the nearest is at 0.25 s"),
        (lambda batch: "wide", "result gives 'wide'"),
        (lambda batch: ["wide"], "result gives"),
        (lambda batch: batch.points["P"], "an array"),
        (lambda batch: batch.points["Q"], "result fails: KeyError"),
    ],
)
def test_results(result: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        tolerances(four_bar(), {"crank": 1e-5}, result)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"n": 0}, "n is 0"),
        ({"n": 1}, "n is 1"),
        ({"n": 1e4}, "four_bar: tolerances: n is 10000.0"),
        ({"seed": -1}, "seed is -1"),
        ({"steps": 0}, "steps is 0"),
        ({"limits": (2.0, 1.0)}, "from 2 to 1; the lowest comes first"),
        ({"limits": (None, None)}, "of which one may be None"),
        ({"limits": ("low", 1.0)}, "lowest is 'low'"),
        ({"limits": (0.0, float("inf"))}, "highest is inf; give None where there is no limit"),
        ({"limits": 3.0}, "limits are 3.0"),
        ({"confidence": 95.0}, "between 0 and 1"),
        ({"way": "fly"}, "no way 'fly'"),
        ({"threads": 0}, "threads is 0"),
        ({"threads": 10**6}, "it must be 1024 at most"),
        ({"corners": 3}, "corners is 3"),
        ({"progress": 3}, "progress is 3"),
        ({"sobol": "yes"}, "sobol is 'yes'"),
    ],
)
def test_numbers(asked: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        tolerances(four_bar(), {"crank": 1e-5}, ANGLE, **asked)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (({"lever": 1e-3}, largest("lever.theta")), "how long is not given"),
        (({"pivot": Clearance(1e-5)}, largest("lever.theta")), "cannot stray in a simulation"),
        (({"spring": 1.0}, largest("lever.theta")), r"\(stiffness, "),
    ],
)
def test_simulations(asked: tuple[Any, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        tolerances(switch(), *asked, duration=None if "long" in said else 0.1)


def test_driven_and_simulated_are_told_apart() -> None:
    with pytest.raises(ModelError, match="1 degree of freedom is not driven"):
        tolerances(switch(), {"lever": 1e-3}, largest("lever.theta"), way="sweep")
    with pytest.raises(ModelError, match="cannot be swept all at once"):
        tolerances(four_bar(0.2), {"crank": {"mass": 1e-2}}, ANGLE, way="batch")


@pytest.mark.parametrize(
    ("function", "sizes", "said"),
    [
        (lambda a: a, {"a": 0.1}, "'a' has no default"),
        (lambda a=1.0: a, {"b": 0.1}, "no argument with a number 'b'"),
        (lambda a="x": a, {"a": 0.1}, "no argument with a number 'a'"),
        (lambda a=1.0: "text", {"a": 0.1}, "result gives 'text'"),
        (lambda a=1.0: 1 / 0, {"a": 0.1}, "ZeroDivisionError"),
        (lambda a=1.0: float("nan"), {"a": 0.1}, "the machine as it is given has no result"),
        (lambda a=float("nan"): a, {"a": 0.1}, "no argument with a number 'a'"),
        (lambda a=1.0: four_bar(), {"a": 0.1}, "result= is missing"),
        (lambda a=1.0: a, {"a": Clearance(1e-5)}, "an argument takes a tolerance"),
        (lambda a=1.0: a, {}, "give names and tolerances"),
        (3, {"a": 0.1}, "give a mechanism, or a function"),
        (Mechanism, {"a": 0.1}, "give a mechanism, or a function"),
    ],
)
def test_functions(function: Any, sizes: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        tolerances(function, sizes)


def test_tolerances_too_wide_for_derivatives() -> None:
    with pytest.raises(
        ModelError, match=r"a standard deviation of 'rocker' beside the middle .* too wide for derivatives"
    ):
        tolerances(four_bar(), {"rocker": Uniform(0.089)}, ANGLE)


def test_a_quantity_of_two_things_is_asked_for_by_its_kind() -> None:
    """A trace and a pin of one name: the kind in front says which."""
    m = four_bar()
    m.trace("B", m.bodies["coupler"].at(0.01, 0.0))
    with pytest.raises(
        ModelError, match=r"'B' names several things; say which: joint B\.y, trace B\.y|trace B\.y, joint"
    ):
        tolerances(m, {"crank": 1e-5}, largest("B.y"))
