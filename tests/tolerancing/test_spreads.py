"""Distributions: limits, standard deviations, what is drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import ModelError, Normal, Triangular, Uniform

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
