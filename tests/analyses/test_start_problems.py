"""Findings of a check on a start that does not close, with their remedies."""

from __future__ import annotations

import pytest

from mbsd import AssemblyError, Mechanism


def wheels(apart: float) -> Mechanism:
    m = Mechanism("wheels")
    for name, x in (("a", 0.0), ("b", apart)):
        wheel = m.body(name, mass=1.0, inertia=1e-3)
        m.revolute(name.upper(), m.ground.at(x, 0.0), wheel.origin)
    return m


def test_gears_that_do_not_touch_are_found_before_they_are_solved() -> None:
    m = wheels(0.2)
    m.gear_pair("g", m.bodies["a"].origin, m.bodies["b"].origin, 0.05, 0.05)
    (finding,) = m.check()
    assert finding.name == "start"
    assert "centres are 0.2 m apart" in finding.problem
    assert "radius_i=0.1" in finding.remedy
    with pytest.raises(AssemblyError, match=r"centres are 0\.2 m apart"):
        m.mobility()


def test_links_that_cannot_close_are_found() -> None:
    m = Mechanism("short")
    crank, coupler = m.bar("crank", 0.02, mass=1.0), m.bar("coupler", 0.03, mass=1.0)
    m.revolute("A", m.ground.at(0.0, 0.0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, m.ground.at(0.2, 0.0))
    (finding,) = m.check()
    assert finding.name == "start"
    assert "do not close" in finding.problem
    assert "crank + coupler = 0.05 m must reach 0.2 m" in finding.remedy


def test_gears_that_touch_are_no_finding() -> None:
    m = wheels(0.1)
    m.gear_pair("g", m.bodies["a"].origin, m.bodies["b"].origin, 0.05, 0.05)
    assert m.check() == []
