"""Tables of ISO 2768-1 and ISO 286-1: values, the ends of their steps, what they do not have."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from mbsd import ModelError
from mbsd.tolerancing.dimensions import standards

MIDDLES = (2.0, 5.0, 18.0, 75.0, 260.0, 700.0, 1500.0, 3000.0)
PUBLISHED = {
    "f": (0.05, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, None),
    "m": (0.1, 0.1, 0.2, 0.3, 0.5, 0.8, 1.2, 2.0),
    "c": (0.2, 0.3, 0.5, 0.8, 1.2, 2.0, 3.0, 4.0),
    "v": (None, 0.5, 1.0, 1.5, 2.5, 4.0, 6.0, 8.0),
}
"""ISO 2768-1:1989, table 1 (mm), as several public transcriptions have it, read independently of ours."""
ENDS = [(0.0005, "f", 0.05), (0.003, "m", 0.1), (0.00301, "c", 0.3), (0.006, "v", 0.5), (0.030, "m", 0.2),
        (0.0301, "m", 0.3), (0.120, "f", 0.15), (0.121, "f", 0.2), (2.0, "f", 0.5), (2.1, "m", 2.0),
        (4.0, "v", 8.0)]  # fmt: skip


@pytest.mark.parametrize("name", PUBLISHED)
def test_general_tolerances_are_those_of_iso_2768(name: str) -> None:
    for middle, deviation in zip(MIDDLES, PUBLISHED[name], strict=True):
        if deviation is None:
            with pytest.raises(ModelError, match="has no deviation"):
                standards.general_tolerance(middle * 1e-3, name)
        else:
            assert standards.general_tolerance(middle * 1e-3, name) == pytest.approx(deviation * 1e-3)


@pytest.mark.parametrize(("size", "name", "deviation"), ENDS)
def test_a_step_of_general_tolerances_includes_its_upper_end(size: float, name: str, deviation: float) -> None:
    assert standards.general_tolerance(size, name) == pytest.approx(deviation * 1e-3)


@pytest.mark.parametrize(
    ("size", "name"), [(0.0004, "m"), (0.002, "v"), (2.5, "f"), (4.1, "m"), (0.1, "g"), (0.0, "m")]
)
def test_a_size_without_a_general_tolerance_is_refused(size: float, name: str) -> None:
    with pytest.raises(ModelError):
        standards.general_tolerance(size, name)


def test_grades_are_those_of_iso_286() -> None:
    """IT14 is 0.36 mm at 10 mm and 0.87 mm at 100 mm, the examples of the article on IT grades in Wikipedia."""
    assert standards.standard_tolerance(0.010, 14) == pytest.approx(0.36e-3)
    assert standards.standard_tolerance(0.100, 14) == pytest.approx(0.87e-3)
    assert standards.standard_tolerance(0.0101, 7) == pytest.approx(18e-6)
    assert standards.standard_tolerance(0.500, 6) == pytest.approx(40e-6)


FACTORS = {5: 7, 6: 10, 7: 16, 8: 25, 9: 40, 10: 64, 11: 100, 12: 160, 13: 250, 14: 400, 15: 640, 16: 1000}
MEANS = [math.sqrt(low * high) for low, high in pairwise((1.0, *standards.STEPS))]
"""Geometric means (mm) of the steps, of which the first counts from 1 mm."""


def unit(mean: float) -> float:
    """The standard's unit of tolerance i (um) at the geometric mean of a step (mm)."""
    return 0.45 * mean ** (1 / 3) + 0.001 * mean


@pytest.mark.parametrize("grade", FACTORS)
def test_grades_follow_the_formula_of_the_standard(grade: int) -> None:
    """i = 0.45 D^(1/3) + 0.001 D times 7, 10, 16, 25, 40, 64, 100 and so on, rounded (ISO 286-1:1988, annex A).

    Up to 3 mm values are rounded up more than beyond, and so is IT6 up to 6 mm.
    """
    for k, (mean, value) in enumerate(zip(MEANS, standards.GRADES[grade], strict=True)):
        exact = FACTORS[grade] * unit(mean)
        near = 0.155 if k == 0 else 0.092 if k == 1 and grade == 6 else 0.065 if value < 10 else 0.045
        assert value == pytest.approx(exact, rel=near), (grade, standards.STEPS[k])


@pytest.mark.parametrize("grade", range(1, 5))
def test_fine_grades_are_a_geometric_series_up_to_it5(grade: int) -> None:
    """IT1 is 0.8 + 0.020 D um; IT2 to IT4 lie between it and IT5 in equal ratios, rounded."""
    for k, (mean, value) in enumerate(zip(MEANS, standards.GRADES[grade], strict=True)):
        first = 0.8 + 0.020 * mean
        exact = first * (7 * unit(mean) / first) ** ((grade - 1) / 4)
        assert value == pytest.approx(exact, rel=0.23), (grade, standards.STEPS[k])


@pytest.mark.parametrize("grade", range(11, 17))
def test_five_grades_coarser_is_ten_times_as_much(grade: int) -> None:
    """The standard's rule for the rounded values: IT15 is 10 IT10, IT16 is 10 IT11. IT11 of 3 to 6 mm alone is 75."""
    tenfold = [10 * value for value in standards.GRADES[grade - 5]]
    if grade == 11:
        assert (tenfold[1], standards.GRADES[11][1]) == (80, 75)
        tenfold[1] = 75
    assert list(standards.GRADES[grade]) == tenfold


def test_zones_follow_the_formulas_of_the_standard() -> None:
    """d 16 D^0.44, e 11 D^0.41, f 5.5 D^0.41, g 2.5 D^0.34, n 5 D^0.34; m is IT7 - IT6, p IT7 and 0 to 5 um more."""
    formulas = {"d": (16, 0.44), "e": (11, 0.41), "f": (5.5, 0.41), "g": (2.5, 0.34), "n": (5, 0.34)}
    for letter, (factor, power) in formulas.items():
        for mean, value in zip(MEANS, (standards.BELOW | standards.ABOVE)[letter], strict=True):
            room = 2.3 if letter == "n" and mean < 2 else 1.25 if value < 60 else 0.045 * value
            assert abs(value - factor * mean**power) < room, (letter, mean)
    seventh, sixth = standards.GRADES[7], standards.GRADES[6]
    assert list(standards.ABOVE["m"][1:]) == [a - b for a, b in zip(seventh[1:], sixth[1:], strict=True)]
    assert all(0 <= p - it7 <= 5 for p, it7 in zip(standards.ABOVE["p"][1:], seventh[1:], strict=True))


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
    assert standards.fit(size, name) == pytest.approx((least * 1e-6, largest * 1e-6))


def test_zones_lie_on_their_side_of_the_nominal_size() -> None:
    assert standards.deviations(0.010, "H7") == pytest.approx((0.0, 15e-6))
    assert standards.deviations(0.010, "g6") == pytest.approx((-14e-6, -5e-6))
    assert standards.deviations(0.010, "js6") == pytest.approx((-4.5e-6, 4.5e-6))


@pytest.mark.parametrize("name", ["H7", "g6/H7", "H7/g6/h6", "Z7/g6", "H17/g6", "H0/g6", "K7/h6", "H7g6", ""])
def test_invalid_fits_are_refused(name: str) -> None:
    with pytest.raises(ModelError):
        standards.fit(0.010, name)
