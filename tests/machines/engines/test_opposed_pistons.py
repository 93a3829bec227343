"""Opposed pistons: nothing shakes without phase, what is left with one, the gas between them, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import ModelError, four_stroke, pressure_table, two_stroke
from mbsd.machines.engines.free_forces import piston_harmonics
from mbsd.machines.engines.opposed_pistons import opposed_pistons

BORE, STROKE, ROD, SPEED = 0.08, 0.09, 0.17, 100.0
THROW, AREA = STROKE / 2, math.pi / 4 * BORE**2
SIZE: dict[str, Any] = {"bore": BORE, "stroke": STROKE, "rod": ROD, "speed": SPEED}
MASS: dict[str, Any] = {"piston_mass": 0.5, "rod_mass": 0.4}
UNIT = (0.5 + 0.3 * 0.4) * THROW * SPEED**2
CYCLE = two_stroke(15.0, heat_density=1e6)


def between(theta: np.ndarray, phase: float) -> np.ndarray:
    """How much farther the wrist pins are apart than where they would meet."""
    ways = [THROW * np.cos(a) + np.sqrt(ROD**2 - (THROW * np.sin(a)) ** 2) for a in (theta, theta + phase)]
    return -ways[0] - ways[1]


@pytest.mark.parametrize("opposite", [False, True])
@pytest.mark.parametrize("throws", [(0,), (0, 120, 240), (0, 100, 37)])
def test_without_phase_nothing_shakes(throws: tuple[float, ...], opposite: bool) -> None:
    sol = opposed_pistons(throws, **SIZE, **MASS, opposite=opposite).sweep(steps=60)
    shaking = sol.shaking()
    assert np.abs(shaking.force).max() < 1e-11 * UNIT
    assert max(np.abs(shaking.mx).max(), np.abs(shaking.my).max()) < 1e-11 * UNIT


def test_shafts_that_turn_in_one_sense_need_no_counterweights() -> None:
    for opposite, least, most in ((False, 0.0, 1e-11), (True, 0.5, 5.0)):
        m = opposed_pistons(**SIZE, **MASS, throw_mass=0.3, counterweight="none", opposite=opposite)
        force = np.abs(m.sweep(steps=60).shaking().force).max() / UNIT
        assert least <= force <= most


@settings(max_examples=15, deadline=None)
@given(st.floats(-30, 30), st.booleans())
def test_a_phase_leaves_what_the_harmonics_say(phase: float, opposite: bool) -> None:
    sol = opposed_pistons(**SIZE, **MASS, phase=phase, opposite=opposite).sweep(steps=64)
    orders = sol.orders(sol.shaking().force, crank="crank", turns=1)
    size = piston_harmonics(THROW / ROD, 4)
    for n in (1, 2, 4):
        expected = 2 * abs(size[n - 1] * math.sin(0.5 * n * math.radians(phase)))
        assert orders.largest[orders.index(n)] / UNIT == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("opposite", [False, True])
@pytest.mark.parametrize("phase", [0.0, 15.0])
def test_the_gas_is_between_both_crowns(phase: float, opposite: bool) -> None:
    m = opposed_pistons((0, 180), **SIZE, **MASS, phase=phase, opposite=opposite, gas=CYCLE)
    assert not m.check()
    assert m.mobility().dof == 1
    sol = m.sweep(steps=1440)
    theta, gas = sol.body("crank").theta, sol.force("gas_1")
    lead = math.radians(phase)
    way = 4 * THROW * math.cos(lead / 2)
    above = between(theta, lead) - between(np.array([-lead / 2]), lead)
    assert gas.volume == pytest.approx(AREA * (way / 14 + above), rel=1e-9)
    assert gas.volume.max() / gas.volume.min() == pytest.approx(15.0, rel=1e-5)
    work = sum(float(sol.force(f"gas_{k}").indicated_work[0]) for k in (1, 2))
    assert -np.trapezoid(sol.driver("motor").power, sol.t) == pytest.approx(work, rel=2e-3)
    assert work > 0
    upper = sol.body("upper_crank").theta
    assert upper - upper[0] == pytest.approx((-1 if opposite else 1) * (theta - theta[0]), abs=1e-9)


def test_the_slider_crank_that_counts_for_the_heat_moves_as_both_pistons_do() -> None:
    phi = np.linspace(0, 2 * math.pi, 181)
    for phase, most in ((0.0, 1e-12), (12.0, 2e-4), (20.0, 6e-4)):
        lead = math.radians(phase)
        throw, rod = 2 * THROW * math.cos(lead / 2), 2 * ROD * math.cos(lead / 2) ** 2 / math.cos(lead)
        equivalent = -throw * np.cos(phi) - np.sqrt(rod**2 - (throw * np.sin(phi)) ** 2)
        both = between(phi - lead / 2, lead)
        assert np.abs((equivalent - equivalent[0]) - (both - both[0])).max() < most * STROKE


def test_a_table_of_pressures_needs_the_gap() -> None:
    angles = np.radians(np.arange(-180.0, 180.0, 10.0))
    table = pressure_table(angles, 1e5 * (1 + 40 * np.exp(-(angles**2) / 0.1)), turns=1)
    m = opposed_pistons(**SIZE, **MASS, gas=table, gap=0.004)
    volume = m.sweep(steps=360).force("gas_1").volume
    assert np.ptp(volume) == pytest.approx(AREA * 2 * STROKE, rel=1e-4)
    with pytest.raises(ModelError, match="gas without compression; give gap"):
        opposed_pistons(**SIZE, gas=table)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"rod": 0.04}, "rod of 40 mm is no longer than the throw of 45 mm.*135 mm"),
        ({"bore": 0.0}, "bore is 0 m; it must be positive"),
        ({"phase": 90.0}, "phase is 90 degrees; the exhaust pistons lead by 5 to 20, 60 at most"),
        ({"throws": (0, 180), "spacing": 0.05}, "cylinders are 50 mm apart along the shafts, and the bore is 80 mm"),
        ({"piston_mass": 0.5}, "both piston_mass and rod_mass"),
        ({"rod_com": 1.5}, "rod_com is 1.5; it must be from 0"),
        ({"crown": -0.01}, "crown is -0.01 m; it cannot be negative"),
        ({"gas": four_stroke(10.0)}, "a cycle of 2 turns; opposed pistons open ports at every turn"),
        ({"gas": CYCLE, "gap": 0.01}, "gap is 10 mm, and a compression of 15 makes it 12.8571 mm; leave it out"),
        ({"gas": 8.0}, r"gas must be two_stroke\(...\)"),
        ({"gap": -0.01}, "gap is -0.01 m; it must be positive"),
        ({"throws": ()}, "no banks"),
        ({"counterweight": "some"}, "counterweight 'some'; it is 'auto'"),
    ],
)
def test_invalid_requests_are_refused(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        opposed_pistons(**(SIZE | arguments))
