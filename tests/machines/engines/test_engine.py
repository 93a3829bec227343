"""Engines as mechanisms, against the harmonic formulas; their firing orders."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import ModelError, four_stroke
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.free_forces import free_forces
from mbsd.machines.engines.layout import (
    INLINE_THROWS,
    NAMES,
    Layout,
    boxer,
    even_split,
    fan,
    inline,
    layout,
    named,
    vee,
)
from mbsd.results.solution import Solution

CASE = json.loads((Path(__file__).parents[2] / "published/reference/engine_free_forces.json").read_text())
BORE, STROKE, ROD, SPACING, SPEED = 0.08, 0.08, 0.16, 0.1, 100.0
PISTON, CON = 0.45, 0.5
SIZE: dict[str, Any] = {"bore": BORE, "stroke": STROKE, "rod": ROD, "spacing": SPACING, "speed": SPEED}
MASS: dict[str, Any] = {"piston_mass": PISTON, "rod_mass": CON, "rod_com": 0.3}
OSCILLATING = PISTON + 0.3 * CON
FIRST = OSCILLATING * STROKE / 2 * SPEED**2


@pytest.mark.parametrize("entry", CASE["engines"], ids=lambda entry: entry["engine"])
def test_every_published_layout_shakes_as_its_coefficients_say(entry: dict) -> None:
    """All that rotates is balanced, so that the oscillating masses are left."""
    banks, throws, z = zip(*entry["bank_throw_z"], strict=True)
    of = layout(entry["engine"], banks, throws, z)
    m = engine(of, **SIZE, **MASS, bank_offset=0.0, rods="pin", counterweight="rotating")
    _agrees_with_formulas(m.sweep(steps=120), of, turns=1, error=1e-9)


def _agrees_with_formulas(sol: Solution, of: Layout, turns: int, error: float) -> None:
    """Forces and couples of a motion over so many turns, relative to those of one cylinder."""
    shaking, free = sol.shaking(), free_forces(of, STROKE / 2 / ROD)
    for got, expected, unit in (
        (sol.orders(shaking.force, crank="crank", turns=turns), free.force, FIRST),
        (sol.orders(shaking.couple, crank="crank", turns=turns), free.couple, FIRST * SPACING),
    ):
        for k, order in enumerate((1, 2, 4, 6)):
            row = got.index(order)
            assert got.forward[row] == pytest.approx(unit * expected.forward[k], abs=error * unit)
            assert got.backward[row] == pytest.approx(unit * expected.backward[k], abs=error * unit)


@pytest.mark.parametrize("name", ["I1", "I3", "V2", "V6", "V8", "flat-4", "radial-5"])
def test_counterweights_of_half_the_oscillating_masses_leave_no_first_order_that_turns(name: str) -> None:
    m = engine(name, **SIZE, **MASS, bank_offset=0.0, rods="pin", throw_mass=0.3)
    sol = m.sweep(steps=120)
    for values, unit in ((sol.shaking().force, FIRST), (sol.shaking().couple, FIRST * SPACING)):
        got = sol.orders(values, crank="crank", turns=1)
        assert abs(got.forward[got.index(1)]) < 1e-9 * unit


@pytest.mark.parametrize("name", NAMES)
def test_every_named_layout_turns(name: str) -> None:
    of = named(name)
    assert len(of.cylinders) == int("".join(c for c in name if c.isdigit()))
    m = engine(name, **SIZE, rods="pin")
    assert m.mobility().dof == 1
    assert not m.check()
    sol = m.sweep(steps=8)
    for k, cylinder in enumerate(of.cylinders, start=1):
        piston = sol.body(f"piston_{k}")
        along = np.exp(1j * (math.pi / 2 + cylinder.bank))
        height = (piston.x + 1j * piston.y) / along
        phi = sol.body("crank").theta + cylinder.throw - cylinder.bank
        exact = STROKE / 2 * np.cos(phi) + np.sqrt(ROD**2 - (STROKE / 2 * np.sin(phi)) ** 2)
        assert height == pytest.approx(exact, abs=1e-12)


def test_rods_on_one_throw_stand_side_by_side() -> None:
    m = engine("V8", **SIZE)
    z = [m.bodies[f"rod_{k}"].z or 0.0 for k in (1, 2, 3)]
    assert z[1] - z[0] == pytest.approx(SPACING / 6)
    assert z[2] - z[0] == pytest.approx(SPACING)
    assert not m.bodies["rod_1"].mass_given


@pytest.mark.parametrize(("name", "order"), [("I4", (1, 3, 4, 2)), ("V8", None), ("radial-5", (1, 3, 5, 2, 4))])
def test_cylinders_fire_in_their_order_and_the_motor_takes_their_work(name: str, order: tuple[int, ...] | None) -> None:
    m = engine(name, **SIZE, **MASS, gas=four_stroke(10.0, heat_density=2e6), order=order, rods="pin")
    sol = m.sweep(duration=4 * math.pi / SPEED, steps=1440)
    angle = sol.body("crank").theta
    fired = firing(named(name), order)
    count = len(fired.order)
    peaks = [angle[int(np.argmax(sol.force(f"gas_{k}").pressure))] for k in fired.order]
    since = np.mod(np.array(peaks) - peaks[0], 4 * math.pi)
    assert since == pytest.approx(4 * math.pi / count * np.arange(count), abs=0.05)
    work = sum(float(sol.force(f"gas_{k}").indicated_work[0]) for k in range(1, count + 1))
    driver = sol.driver("motor")
    assert -np.trapezoid(driver.power, sol.t) == pytest.approx(work, rel=1e-3)
    assert work > 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"layout": "V7"}, "no layout 'V7'.*V6"),
        ({"layout": "I4", "rod": 0.03}, "rod of 30 mm is no longer than the throw of 40 mm.*120 mm"),
        ({"layout": "I4", "spacing": 0.05}, "cylinders 1 and 2 of one bank are 50 mm apart.*bore is 80 mm"),
        ({"layout": "I4", "spacing": 0.05}, "bore is 80 mm; make spacing 1.6 times as large"),
        ({"layout": "V8", "bank_offset": 0.1}, "offset of 100 mm rod 2 does not.* rod 3 .*100 mm.* less than 100 mm"),
        ({"layout": "W12", "bank_offset": 0.05}, "rod 3 does not stand before rod 4.*less than 50 mm"),
        ({"layout": "V8", "throws": (0, 90, 180)}, "3 throws; it has 4, one for two cylinders"),
        ({"layout": "I4", "angle": 90}, "angle 90; only V and VR"),
        ({"layout": "V8", "angle": 200}, "angle 200 degrees; it must be above 0 and at most 180"),
        ({"layout": "I4", "split": 30}, "split 30; only V engines"),
        ({"layout": "I4", "bore": -1.0}, "bore is -1 m; it must be positive"),
        ({"layout": "I4", "piston_mass": 0.4}, "both piston_mass and rod_mass"),
        ({"layout": "I4", "piston_mass": -0.4, "rod_mass": 1.0}, "piston_mass is -0.4 kg; it cannot be negative"),
        ({"layout": "I4", "counterweight": "some"}, "counterweight 'some'; it is 'auto'"),
        ({"layout": "I4", "rod_com": 2.0}, "rod_com is 2; it must be from 0"),
        ({"layout": "I4", "order": (1, 2, 3, 4)}, "a firing order without gas"),
        ({"layout": "I4", "gas": 8.0}, r"gas must be four_stroke\(...\)"),
        ({"layout": "I4", "gas": four_stroke(10.0), "order": (1, 2, 3, 3)}, "no permutation of the cylinders"),
        ({"layout": named("I4"), "angle": 20.0}, "those of its layout"),
    ],
)
def test_invalid_requests_are_refused(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        engine(**(SIZE | arguments))


@pytest.mark.parametrize(
    ("of", "intervals"),
    [
        (inline(INLINE_THROWS[1]), [720]),
        (inline((0, 0)), [360, 360]),
        (inline((0, 180)), [180, 540]),
        (inline((0, 270)), [270, 450]),
        (inline(INLINE_THROWS[3]), [240] * 3),
        (inline(INLINE_THROWS[4]), [180] * 4),
        (inline(INLINE_THROWS[5]), [144] * 5),
        (inline(INLINE_THROWS[6]), [120] * 6),
        (inline((0, 90, 270, 180)), [270, 180, 90, 180]),
        (vee(90, (0,)), [270, 450]),
        (vee(45, (0,)), [315, 405]),
        (vee(60, (0, 180), even_split(60, 4)), [180] * 4),
        (vee(90, (0, 120, 240)), [90, 150] * 3),
        (vee(90, (0, 120, 240), even_split(90, 6)), [120] * 6),
        (vee(60, (0, 120, 240), even_split(60, 6)), [120] * 6),
        (vee(90, (0, 90, 270, 180)), [90] * 8),
        (vee(60, INLINE_THROWS[6]), [60] * 12),
        (boxer((0, 180)), [360, 360]),
        (boxer((0, 180, 180, 0)), [180] * 4),
        (fan((0, 72, 144, 216, 288), (0,)), [144] * 5),
    ],
    ids=lambda value: value.name if isinstance(value, Layout) else "",
)
def test_intervals_of_engines(of: Layout, intervals: list[float]) -> None:
    got = firing(of)
    assert sorted(got.order) == list(range(1, len(of.cylinders) + 1))
    assert sorted(np.degrees(got.intervals)) == pytest.approx(sorted(intervals), abs=1e-6)
    assert got.even == (max(intervals) - min(intervals) < 1e-6)


@pytest.mark.parametrize("order", [(1, 3, 4, 2), (1, 2, 4, 3)])
def test_a_given_order_of_a_straight_four(order: tuple[int, ...]) -> None:
    got = firing(inline(INLINE_THROWS[4]), order)
    assert got.order == order
    assert got.even
    assert np.degrees(got.angles) == pytest.approx([0, 180, 360, 540])


def test_the_order_of_a_cross_plane_v8_is_even() -> None:
    # Cylinders 1 to 4 of the right-hand bank are 1, 3, 5, 7 here and fire in the order of a well-known American V8.
    of = vee(90, (0, 90, 270, 180))
    assert firing(of, firing(of).order).even


def test_a_two_stroke_engine_fires_at_each_turn() -> None:
    got = firing(inline((0, 180)), strokes=2)
    assert np.degrees(got.intervals) == pytest.approx([180, 180])
    assert got.cycle == pytest.approx(2 * math.pi)


@pytest.mark.parametrize(
    ("order", "words"),
    [
        ((1, 1, 2, 3), r"1-1-2-3 is no permutation of the cylinders 1 \.\. 4"),
        ((1, 2, 3), "no permutation"),
        ((1, 2, 3, 4), "as evenly as they can, 1-"),
    ],
)
def test_an_order_that_cannot_be_is_refused(order: tuple[int, ...], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        firing(inline(INLINE_THROWS[4]), order) if order != (1, 2, 3, 4) else firing(inline((0, 90, 180, 270)), order)


def test_strokes_are_two_or_four() -> None:
    with pytest.raises(ModelError, match="3 strokes"):
        firing(inline((0,)), strokes=3)
