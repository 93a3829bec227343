"""Firing orders and intervals of engines that are built."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import ModelError
from mbsd.machines.engines.firing import firing
from mbsd.machines.engines.layout import INLINE_THROWS, Layout, boxer, even_split, fan, inline, vee


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
