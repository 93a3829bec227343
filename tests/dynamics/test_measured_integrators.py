"""docs/integrators.md shows the numbers of docs/integrators.json, of every integrator there is."""

from __future__ import annotations

import json
import math

import pytest
from scipy.special import ellipk

from mbsd.dynamics.integrators.kind import INTEGRATORS
from mbsd.testing import integrators
from shared.stage.paths import ROOT
from tools.documents.integrators import (
    AMPLITUDE,
    RUNS,
    G,
    Rung,
    case,
    cost,
    four_bar,
    order,
    pendulum,
    swing,
    with_tables,
)

PAGE = (ROOT / "docs" / "integrators.md").read_text()
MEASURED = json.loads((ROOT / "docs" / "integrators.json").read_text())


def test_the_tables_are_those_of_the_numbers() -> None:
    assert with_tables(PAGE, MEASURED) == PAGE


@pytest.mark.parametrize("name", sorted(method.name for method in integrators()))
def test_every_integrator_is_measured_and_explained(name: str) -> None:
    assert MEASURED["accuracy"][name]["stated"] == INTEGRATORS[name].order
    assert f"`{name}`" in PAGE
    stated = INTEGRATORS[name].order
    for chain in ("pendulum", "four-bar"):
        assert MEASURED["accuracy"][name][chain] > stated - 0.6


def test_every_long_run_is_there() -> None:
    for runs in MEASURED["long"].values():
        assert list(runs) == list(RUNS)
        for name in ("symplectic", "rattle"):
            errors = runs[name]["errors"]
            assert errors[-1] < 1.1 * errors[len(errors) // 2], f"{name} drifts"


def test_measuring_finds_known_slopes_and_costs() -> None:
    """A run by a method of order 4, and a ladder of order 2 that costs in proportion to its steps."""
    short = case(pendulum, "rod", 1.0, 0.04)
    assert order(short.ladder(INTEGRATORS["rk4"], 1e-7)) == pytest.approx(4.0, abs=0.1)
    ladder = [Rung(n, 1.0 / n**2, 0.01 * n) for n in (10, 100, 1000)]
    assert order(ladder[1:]) == pytest.approx(2.0)
    assert cost(ladder) == (pytest.approx(0.01 * 1e5**0.5), True)
    assert cost(ladder[:2]) == (1.0, False)


def test_the_period_is_the_elliptic_integral() -> None:
    period, kinetic = swing(pendulum())
    k2 = 0.5 * (1 - math.cos(AMPLITUDE))
    assert period == pytest.approx(4 * ellipk(k2) / G**0.5, abs=1e-6)
    assert kinetic == pytest.approx(1.0 * G * 0.75 * 2 * k2, rel=1e-4)
    assert swing(four_bar())[0] == pytest.approx(1.845, abs=1e-3)
