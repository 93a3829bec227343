"""Tangents of paths of designs that are swept one by one: exact, where differences of sweeps have six digits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mbsd.synthesis.designs import Designs, tangents_of_path
from mbsd.synthesis.least_squares import Residuals
from mbsd.synthesis.target import Target
from mbsd.synthesis.variables import varied
from tools.models import linkages

GRID = np.linspace(0.0, 1.0, 25)


def four_bar() -> Mechanism:
    return linkages.four_bar((0.4, 0.02), 0.1, 0.38, 0.3, (45, 90), traced=(0.2, 0.1))


def geared(far: float = 0.30, arm: float = 0.12, place: tuple[float, float] = (0.05, 0.0)) -> Mechanism:
    m = Mechanism("geared")
    first, second = m.body("first"), m.body("second")
    left, right = m.bar("left", 0.25), m.bar("right", 0.25)
    m.revolute("O", m.ground.at(0, 0), first.origin)
    m.revolute("Q", m.ground.at(far, 0), second.origin)
    m.gear_pair("mesh", first.origin, second.origin, far / 2, far / 2)
    m.revolute("A", first.at(*place), left.start)
    m.revolute("B", second.at(-0.05, 0), right.start)
    m.revolute("C", left.end, right.end)
    m.drive_angle("motor", first, constant_rate(2 * np.pi))
    m.trace("P", left.at(arm, 0.03))
    m.start_near(left=60, right=120, second=0)
    return m


@pytest.mark.parametrize(
    ("build", "vary"),
    [
        (geared, {"far": (0.28, 0.34), "arm": (0.05, 0.2), "place": ((0.02, 0.08), (-0.02, 0.02))}),
        (
            None,
            {"left": (0.2, 0.3), "right": (0.2, 0.3), "P": ((0.1, 0.2), (0.0, 0.05)), "A": ((0.0, 0.1), (0.0, 0.1))},
        ),
    ],
)
def test_tangents_are_those_of_sweeps(build: Any, vary: Any) -> None:
    designs = Designs(geared(), varied("geared", vary), build, "P", {True: GRID, False: GRID}, False)
    assert not designs.at_once
    x = designs.varied.low + 0.4 * (designs.varied.high - designs.varied.low)
    paths, angles = tangents_of_path(designs, x, GRID)
    assert len(angles) == len(designs.turned)
    h = 1e-4
    for k in range(len(x)):
        step = h * np.eye(len(x))[k]
        ahead, behind, far, back = designs(np.array([x + step, x - step, x + 2 * step, x - 2 * step]), True).path
        difference = (8 * (ahead - behind) - (far - back)) / (12 * h)
        assert np.abs(paths[k] - difference).max() < 1e-7 * np.abs(difference).max() + 1e-9


def test_designs_beside_one_differ_as_their_sweeps_do() -> None:
    vary = {"left": (0.2, 0.3), "right": (0.2, 0.3)}
    designs = Designs(geared(), varied("geared", vary), None, "P", {True: GRID, False: GRID}, False)
    x, steps = np.array([[0.24, 0.26]]), np.array([[1e-5, -1e-5]])
    neighbours, swept = designs.neighbours(x, steps, True), designs(x + steps[0][:, None] * np.eye(2), True)
    assert neighbours.closes.all()
    assert np.abs(neighbours.path - swept.path).max() < 1e-9
    assert np.abs(neighbours.transmission - swept.transmission).max() < 1e-8
    assert designs.evaluations == 2  # neighbours counts none


def test_slopes_of_residuals_are_the_same_whatever_the_bounds() -> None:
    """Bounds of kilometres about a linkage of a few decimetres: a part of them is no small step."""
    grids = {True: np.linspace(0.0, 1.0, 61), False: np.linspace(0.0, 1.0, 25)}
    target = Target(np.array([[0.2, 0.1], [0.3, 0.15], [0.25, 0.0]]), None, False, True, (0.0, 1.0))
    x, slopes = np.array([0.31, 0.41, 0.01]), []
    for half in (0.005, 5e3):
        vary = varied("four-bar", {"rocker": (0.305, 0.305 + half), "D": ((x[1] - half, x[1] + half), (-half, half))})
        designs = Designs(four_bar(), vary, None, "P", grids, False)
        size = vary.high - vary.low
        residuals = Residuals(designs, target, 0.0, vary.low, size)
        u = ((x - vary.low) / size)[None]
        slopes.append(residuals.slopes(u, residuals.missed(u, True), True)[0] / size)
    assert np.abs(slopes[0]).max() > 1.0
    np.testing.assert_allclose(slopes[1], slopes[0], atol=1e-4)
