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


def test_where_all_is_nearly_linear_they_are_the_linear_shares() -> None:
    t = tolerances(four_bar(), SIZES, samples("rocker.theta", [0.25]), n=2048, steps=4, sobol=True)
    assert t.sobol is not None
    assert t.sobol.first == pytest.approx(t.shares, abs=0.01)
    assert t.sobol.total == pytest.approx(t.shares, abs=0.01)
    assert np.isfinite([row.sobol_total for row in t.rows]).all()
