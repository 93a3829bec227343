"""Spreads and shares of variance: what a sample tells of all machines."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import ModelError, Normal, Triangular, Uniform, tolerances
from mbsd.measures import samples
from tests.tolerancing.linkages import SIZES, four_bar

# Distributions: limits, standard deviations, what is drawn.


EVEN = (np.arange(200_000) + 0.5) / 200_000


@pytest.mark.parametrize(
    ("spread", "sigma"),
    [
        (Normal(3.0), 1.0),
        (Normal((-1.0, 5.0), sigmas=2.0), 1.5),
        (Uniform(3.0), math.sqrt(3.0)),
        (Triangular(3.0), math.sqrt(1.5)),
        (Normal(1.0, sigmas=1.0, cut=True), 0.5395600628),  # of a normal distribution cut at one standard deviation
    ],
)
def test_samples_have_the_standard_deviation(spread: Normal | Uniform | Triangular, sigma: float) -> None:
    drawn = spread.deviations(EVEN)
    assert spread.sigma == pytest.approx(sigma, rel=1e-6)
    assert drawn.std() == pytest.approx(sigma, rel=1e-3)
    assert drawn.mean() == pytest.approx(spread.middle, abs=1e-9)
    assert (np.diff(drawn) > 0).all()


@pytest.mark.parametrize("spread", [Uniform((-1.0, 3.0)), Triangular((-1.0, 3.0)), Normal((-1.0, 3.0), cut=True)])
def test_limits_hold(spread: Normal | Uniform | Triangular) -> None:
    drawn = spread.deviations(np.array([0.0, 0.5, 1.0 - 2.0**-53]))
    assert drawn == pytest.approx([-1.0, 1.0, 3.0], abs=1e-6)


def test_a_triangle_is_likeliest_in_its_middle() -> None:
    counts, _ = np.histogram(Triangular(1.0).deviations(EVEN), 4, (-1.0, 1.0))
    assert counts / len(EVEN) == pytest.approx([0.125, 0.375, 0.375, 0.125], abs=1e-3)


def test_nothing_normal_lies_beyond_its_reach() -> None:
    spread = Normal(3.0)
    assert np.abs(spread.deviations(np.array([0.0, 1.0 - 2.0**-53]))).max() < spread.reach < 8.5
    assert np.isfinite(spread.deviations(np.array([0.0, 1.0]))).all()


def test_a_class_takes_its_number_from_the_size() -> None:
    assert Normal("m").at_size(0.05).half == pytest.approx(3e-4)
    assert Uniform("IT7").at_size(0.05).half == pytest.approx(12.5e-6)
    assert isinstance(Uniform("IT7").at_size(0.05), Uniform)


@pytest.mark.parametrize(
    "tolerance", [0.0, -1.0, (1.0, -1.0), (1.0, 1.0), "x", "IT17", "IT0", None, True, float("nan")]
)
def test_invalid_tolerances_are_refused(tolerance: object) -> None:
    with pytest.raises(ModelError):
        Uniform(tolerance)


# Sobol's indices against a function whose indices are known, and against the linear shares.


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
