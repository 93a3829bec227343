"""Closed chains with change points are named with their lengths, and no others."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism
from mbsd.analyses.findings import Finding
from tests.kinematics.test_change_points import LINKAGES, linkage, slider_crank


def notes(m: Mechanism) -> list[Finding]:
    return [finding for finding in m.check() if finding.is_note]


@pytest.mark.parametrize("name", LINKAGES)
def test_linkages_with_change_points_are_named(name: str) -> None:
    (note,) = notes(linkage(name, turn=31.0, scale=2.0))
    assert note.name == "chain ground - crank - coupler - rocker"
    least, *others, most = sorted(2.0 * length for length in LINKAGES[name][0])
    assert f"{least:g} + {most:g} = {others[0]:g} + {others[1]:g} m" in note.problem


@given(more=st.floats(1e-6, 0.05), bar=st.sampled_from(["crank", "coupler", "rocker"]))
def test_a_length_that_differs_is_no_change_point(more: float, bar: str) -> None:
    m = linkage("2-5-4-3", 75.0)
    length = m.bodies[bar].length
    assert length is not None
    m.change(bar, length=length + more)
    assert notes(m) == []


def test_an_equal_slider_crank_is_named_and_a_longer_rod_is_not() -> None:
    (note,) = notes(slider_crank())
    assert "crank and rod are equally long, 0.1 m" in note.problem
    m = slider_crank()
    m.change("rod", length=0.1001)
    assert notes(m) == []


def test_welded_bodies_count_as_one_link() -> None:
    """The coupler is two bars welded at a right angle: 0.3 m from pin to pin."""
    m = Mechanism("welded")
    left, right = m.bar("left", 0.1), m.bar("right", 0.1)
    first, second = m.bar("first", 0.18), m.bar("second", 0.24)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", left.end, first.start)
    m.weld("W", first.end, second.at(0, 0, math.pi / 2))
    m.revolute("C", second.end, right.end)
    m.revolute("D", m.ground.at(0.3, 0), right.start)
    m.start_near(left=60, right=60, first=53.13, second=-36.87)
    (note,) = notes(m)
    assert note.name == "chain ground - left - first - right"
    assert "0.1 + 0.3 = 0.1 + 0.3 m" in note.problem
