"""Links that the model gives no place get one by the search for layers, those with one keep it."""

from __future__ import annotations

import math
from itertools import combinations

import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from tests.mechanisms.automatic.shafts.proofs import checked
from tools.models.shaft_machines import SINGLE, engine


def four_bar(**places: float) -> Mechanism:
    m = Mechanism("four_bar")
    bars = [
        m.bar(name, length, z=places.get(name))
        for name, length in (("crank", 0.04), ("coupler", 0.12), ("rocker", 0.1))
    ]
    m.revolute("O", m.ground.at(0, 0), bars[0].start)
    m.revolute("A", bars[0].end, bars[1].start)
    m.revolute("B", bars[1].end, bars[2].end)
    m.revolute("D", m.ground.at(0.13, 0), bars[2].start)
    m.drive_angle("motor", bars[0], constant_rate(2 * math.pi))
    m.start_near(crank=20, coupler=40, rocker=100)
    return m


def planned(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep(steps=90))


def test_two_of_three_bars_are_placed_beside_the_third() -> None:
    made = planned(four_bar(crank=0.03))
    low, high = made.span("crank")
    assert (low + high) / 2 == pytest.approx(30.0)
    assert made.along is not None
    made.along.refuse()
    spans = {name: made.span(name) for name in ("crank", "coupler", "rocker")}
    assert spans["coupler"][0] > spans["crank"][1], "the pivot of the crank stands on the base"
    for a, b in combinations(spans.values(), 2):
        assert a == b or a[0] > b[1] or b[0] > a[1]


def test_parts_with_two_places_given_are_built_and_nothing_touches() -> None:
    checked(four_bar(crank=0.0, rocker=0.004))


def test_a_machine_beside_an_engine_gets_layers() -> None:
    m = engine(SINGLE)
    arm = m.bar("arm", 0.05)
    m.revolute("hinge", m.ground.at(0.3, 0.0), arm.start)
    m.drive_angle("other", arm, constant_rate(2 * math.pi))
    made = planned(m)
    assert made.along is not None
    made.along.refuse()
    low, high = made.span("rod_1")
    assert (low + high) / 2 == pytest.approx(0.0)
    assert math.isfinite(made.span("arm")[0])
