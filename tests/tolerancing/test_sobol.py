"""Sobol's indices against a function whose indices are known, and against the linear shares."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Uniform, tolerances
from mbsd.measures import samples
from tests.tolerancing.linkages import SIZES, four_bar


def ishigami(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> float:
    return math.sin(x) + 7.0 * math.sin(y) ** 2 + 0.1 * z**4 * math.sin(x)


def test_the_indices_of_ishigami_and_homma() -> None:
    """Ishigami, Homma, An importance quantification technique in uncertainty analysis, 1990: the closed form."""
    t = tolerances(ishigami, dict.fromkeys("xyz", Uniform(math.pi)), n=4096, sobol=True, corners=False)
    assert t.sobol is not None
    x, y, z = 0.5 * (1 + 0.1 * math.pi**4 / 5) ** 2, 7.0**2 / 8, 0.1**2 * math.pi**8 * (1 / 18 - 1 / 50)
    total = x + y + z
    assert t.sobol.first == pytest.approx([x / total, y / total, 0.0], abs=0.02)
    assert t.sobol.total == pytest.approx([(x + z) / total, y / total, z / total], abs=0.02)
    assert t.sobol.machines == 5 * 4096
    assert t.sobol.failed == 0


def test_a_curved_result_is_known_as_one_and_solved_again() -> None:
    """x^2 of x even in -1 .. 1 has no slope in the middle: variance 4/45, a sixteenth of it if x is halved."""
    t = tolerances(lambda x=0.0, y=1.0: x * x + y, {"x": Uniform(1.0), "y": Uniform(0.01)}, limits=(0.0, 1.5), n=4000)
    assert t.curved
    assert "curved" in str(t)
    assert t.linear_std == pytest.approx(0.01 / math.sqrt(3))
    assert t.std == pytest.approx(math.sqrt(4 / 45), rel=0.03)
    x, y = t.rows
    assert x.std_halved == pytest.approx(math.sqrt(4 / 45) / 4, rel=0.04)
    assert x.yield_halved == 1.0
    assert y.yield_halved == pytest.approx(math.sqrt(0.5), abs=0.03)
    assert t.vertex_worst == pytest.approx((1.0, 2.01))  # the middle is less than all corners
    assert not tolerances(four_bar(), {"crank": 1e-4}, samples("crank.theta", [0.25]), n=50, steps=4).curved  # it stays
    assert not tolerances(lambda x=0.0, y=1.0: x + y, {"x": Uniform(1.0), "y": Uniform(0.01)}, n=50).curved


def test_where_all_is_nearly_linear_they_are_the_linear_shares() -> None:
    t = tolerances(four_bar(), SIZES, samples("rocker.theta", [0.25]), n=2048, steps=4, sobol=True)
    assert t.sobol is not None
    assert t.sobol.first == pytest.approx(t.shares, abs=0.01)
    assert t.sobol.total == pytest.approx(t.shares, abs=0.01)
    assert np.isfinite([row.sobol_total for row in t.rows]).all()
