"""Functions of the user that are called while something runs: what they take, and what they raise."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mbsd import Mechanism, ModelError, constant_rate, fit_path, optimise, tolerances
from mbsd.measures import largest, samples
from tools.models import linkages

POINTS = [(0.05, 0.05), (0.04, 0.06), (0.03, 0.07)]


def four_bar() -> Mechanism:
    return linkages.four_bar(
        0.12, 0.04, 0.12, 0.09, masses=(0.1, None, None), law=constant_rate(6.0), traced=(0.06, 0.03)
    )


def door() -> Mechanism:
    m = Mechanism("door", gravity=None)
    leaf = m.bar("door", 0.9, mass=30.0)
    m.revolute("hinge", m.ground.at(0, 0), leaf.start)
    m.torsion_spring("closer", m.ground, leaf, 10.0, 20.0)
    m.start_near(door=90)
    return m


CALLS: dict[str, Callable[[Any, Path], object]] = {
    "simulate": lambda progress, folder: door().simulate(1.0, progress=progress),
    "simulate_many": lambda progress, folder: door().simulate_many(
        1.0, {"closer": {"stiffness": [1.0, 2.0]}}, measure={"x": largest("door.x")}, progress=progress
    ),
    "tolerances": lambda progress, folder: tolerances(
        four_bar(), {"crank": 1e-5}, samples("P.y", [0.0]), n=20, steps=12, progress=progress
    ),
    "optimise": lambda progress, folder: optimise(
        four_bar(), largest("P.y"), {"coupler": (0.11, 0.13)}, steps=12, progress=progress
    ),
    "fit_path": lambda progress, folder: fit_path(
        four_bar(), POINTS, {"coupler": (0.11, 0.13)}, point="P", generations=2, starts=1, progress=progress
    ),
    "better": lambda progress, folder: fit_path(
        four_bar(), POINTS, {"coupler": (0.11, 0.13)}, point="P", generations=2, starts=1, better=progress
    ),
    "animate": lambda progress, folder: four_bar().sweep(steps=4).animate(folder / "film.gif", progress=progress),
}


def own_fault(*given: Any) -> None:
    raise ZeroDivisionError("of the user")


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_its_exceptions_reach_the_user_as_they_are(call: Callable[[Any, Path], object], tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError, match="of the user"):
        call(own_fault, tmp_path)


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_objects_that_cannot_be_called_are_refused_before_anything_runs(
    call: Callable[[Any, Path], object], tmp_path: Path
) -> None:
    with pytest.raises(ModelError, match=r"is 3; it must be a function of"):
        call(3, tmp_path)
    with pytest.raises(ModelError, match=r"must be a function of .*: too many positional arguments"):
        call(lambda: None, tmp_path)


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_it_is_called(call: Callable[[Any, Path], object], tmp_path: Path) -> None:
    heard: list[tuple[Any, ...]] = []
    call(lambda *given: heard.append(given), tmp_path)
    assert heard
