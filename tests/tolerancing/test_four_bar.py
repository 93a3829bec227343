"""A four-bar that gives a function: first derivatives, variance and worst case against its closed form."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from mbsd import tolerances
from mbsd.measures import largest, samples
from tests.tolerancing.linkages import COUPLER, CRANK, GROUND, ROCKER, SIZES, four_bar, rocker_angle, slider_crank

ORDER = ("crank", "coupler", "rocker", "ground")
LENGTHS = np.array([CRANK, COUPLER, ROCKER, GROUND])
WIDTHS = np.array([5e-5, 8e-5, 6e-5, 4e-5])


def loop_slopes(angle: float) -> np.ndarray:
    """d psi / d length by the closed loop a e^(i angle) + b e^(i phi) = d + c e^(i psi), along the coupler."""
    psi = float(rocker_angle(angle))
    arm = GROUND + ROCKER * np.exp(1j * psi) - CRANK * np.exp(1j * angle)
    along = arm / abs(arm)

    def part(z: complex) -> float:
        return (z / along).real

    turning = ROCKER * part(1j * np.exp(1j * psi))
    return np.array([part(np.exp(1j * angle)), 1.0, -part(np.exp(1j * psi)), -part(1.0 + 0j)]) / turning


@pytest.mark.parametrize("time", [0.0, 0.1, 0.25, 0.7])
def test_slopes_are_those_of_the_closed_loop(time: float) -> None:
    t = tolerances(four_bar(), SIZES, samples("rocker.theta", [time]), n=100, steps=20)
    exact = loop_slopes(2 * math.pi * time)
    assert t.slopes == pytest.approx(exact, rel=1e-5)
    assert t.linear_std == pytest.approx(math.sqrt(((exact * WIDTHS / 3) ** 2).sum()), rel=1e-5)
    assert t.linear_worst[1] - t.nominal == pytest.approx((np.abs(exact) * WIDTHS).sum(), rel=1e-5)


def test_every_machine_is_its_closed_form() -> None:
    t = tolerances(four_bar(), SIZES, samples("rocker.theta", [0.3]), n=2000, steps=10)
    exact = rocker_angle(0.6 * math.pi, *(LENGTHS + t.deviations).T)
    assert t.values == pytest.approx(exact, abs=1e-13)
    assert t.std == pytest.approx(exact.std(ddof=1), rel=1e-9)
    assert t.std == pytest.approx(t.linear_std, rel=0.05)
    assert t.columns == ("crank", "coupler", "rocker", "D.x")


def test_corners_are_the_worst_of_all_machines() -> None:
    t = tolerances(four_bar(), SIZES, samples("rocker.theta", [0.3]), n=2000, steps=10)
    corners = [
        rocker_angle(0.6 * math.pi, *(LENGTHS + np.array(signs) * WIDTHS))
        for signs in itertools.product((-1.0, 1.0), repeat=4)
    ]
    assert t.vertex_worst == pytest.approx((min(corners), max(corners)), abs=1e-13)
    assert t.linear_worst == pytest.approx(t.vertex_worst, abs=1e-6)
    assert t.corners_failed == 0


def test_extremes_over_the_sweep_and_places_of_bodies() -> None:
    """The rocker turns farthest where crank and coupler lie on one line; a slider is farthest at r + l."""
    t = tolerances(four_bar(), SIZES, largest("rocker.theta"), n=50, steps=7200)
    reach = COUPLER - CRANK
    exact = math.pi - math.acos((GROUND**2 + ROCKER**2 - reach**2) / (2 * GROUND * ROCKER))
    assert t.nominal == pytest.approx(exact, abs=1e-6)
    t = tolerances(slider_crank(), {"crank": 1e-4, "rod": 2e-4, "guide": {"y": 1e-4}}, largest("slider.x"), n=200)
    assert t.slopes == pytest.approx([1.0, 1.0, 0.0], abs=1e-6)
    crank, rod, offset = (np.array([0.05, 0.15, 0.0]) + t.deviations).T
    assert t.values == pytest.approx(crank + np.sqrt(rod**2 - offset**2), abs=1e-9)


def test_a_class_goes_by_the_size_of_each_bar() -> None:
    t = tolerances(four_bar(), "m", samples("P.y", [0.25]), n=50, steps=4)
    assert [(row.name, row.high) for row in t.rows] == [
        ("crank", pytest.approx(3e-4)), ("coupler", pytest.approx(3e-4)), ("rocker", pytest.approx(3e-4)),
    ]  # fmt: skip
    t = tolerances(four_bar(), {"crank": "IT7", "D": {"x": "f"}}, samples("P.y", [0.25]), n=50, steps=4)
    assert [row.high for row in t.rows] == pytest.approx([12.5e-6, 1.5e-4])


def test_all_machines_make_parts_that_are_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = tolerances(four_bar(), SIZES, largest("P.y"), n=700, steps=36)
    monkeypatch.setattr("mbsd.tolerancing.machines.batched.NUMBERS_AT_ONCE", 1)
    parts = tolerances(four_bar(), SIZES, largest("P.y"), n=700, steps=36, threads=1)
    assert parts.values.tobytes() == whole.values.tobytes()
