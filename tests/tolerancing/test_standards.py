"""Tables of ISO 2768-1 and ISO 286-1: values, the ends of their steps, what they do not have."""

from __future__ import annotations

import math

import pytest

from mbsd import ModelError
from mbsd.tolerancing.dimensions.standards import (
    GRADES,
    STEPS,
    deviations,
    fit,
    general_tolerance,
    standard_tolerance,
)

GENERAL = [(0.0005, "f", 0.05), (0.003, "m", 0.1), (0.00301, "c", 0.3), (0.006, "v", 0.5), (0.030, "m", 0.2),
           (0.0301, "m", 0.3), (0.120, "f", 0.15), (0.121, "f", 0.2), (0.4, "c", 1.2), (1.0, "v", 4.0), (2.0, "f", 0.5),
           (2.1, "m", 2.0), (4.0, "v", 8.0)]  # fmt: skip


@pytest.mark.parametrize(("size", "name", "deviation"), GENERAL)
def test_general_tolerances_are_those_of_iso_2768(size: float, name: str, deviation: float) -> None:
    assert general_tolerance(size, name) == pytest.approx(deviation * 1e-3)


@pytest.mark.parametrize(
    ("size", "name"), [(0.0004, "m"), (0.002, "v"), (2.5, "f"), (4.1, "m"), (0.1, "g"), (0.0, "m")]
)
def test_a_size_without_a_general_tolerance_is_refused(size: float, name: str) -> None:
    with pytest.raises(ModelError):
        general_tolerance(size, name)


def test_grades_are_those_of_iso_286() -> None:
    """IT14 is 0.36 mm at 10 mm and 0.87 mm at 100 mm, the examples of the article on IT grades in Wikipedia."""
    assert standard_tolerance(0.010, 14) == pytest.approx(0.36e-3)
    assert standard_tolerance(0.100, 14) == pytest.approx(0.87e-3)
    assert standard_tolerance(0.0101, 7) == pytest.approx(18e-6)
    assert standard_tolerance(0.500, 6) == pytest.approx(40e-6)


@pytest.mark.parametrize("grade", range(6, 12))
def test_grades_follow_the_formula_of_the_standard(grade: int) -> None:
    """i = 0.45 D^(1/3) + 0.001 D (um) at the geometric mean D (mm) of a step, times 10, 16, 25, 40, 64, 100.

    The values are rounded, most in the smallest step, which is left out.
    """
    factor = (10, 16, 25, 40, 64, 100)[grade - 6]
    low = STEPS[0]
    for high, value in zip(STEPS[1:], GRADES[grade][1:], strict=True):
        mean = math.sqrt(low * high)
        assert value == pytest.approx(factor * (0.45 * mean ** (1 / 3) + 0.001 * mean), rel=0.12)
        low = high


@pytest.mark.parametrize(
    ("size", "name", "least", "largest"),
    [
        (0.010, "H7/g6", 5, 29),
        (0.010, "H8/f7", 13, 50),
        (0.025, "H7/h6", 0, 34),
        (0.050, "H7/k6", -18, 23),
        (0.050, "H7/k8", -39, 25),
        (0.020, "G7/h6", 7, 41),
        (0.020, "JS7/h6", -10.5, 23.5),
        (0.020, "H7/p6", -35, -1),
    ],
)
def test_fits_have_the_play_of_the_standard(size: float, name: str, least: float, largest: float) -> None:
    assert fit(size, name) == pytest.approx((least * 1e-6, largest * 1e-6))


def test_zones_lie_on_their_side_of_the_nominal_size() -> None:
    assert deviations(0.010, "H7") == pytest.approx((0.0, 15e-6))
    assert deviations(0.010, "g6") == pytest.approx((-14e-6, -5e-6))
    assert deviations(0.010, "js6") == pytest.approx((-4.5e-6, 4.5e-6))


@pytest.mark.parametrize("name", ["H7", "g6/H7", "H7/g6/h6", "Z7/g6", "H17/g6", "H0/g6", "K7/h6", "H7g6", ""])
def test_what_is_no_fit_is_refused(name: str) -> None:
    with pytest.raises(ModelError):
        fit(0.010, name)
