"""Mechanisms that differ in numbers alone share a plan, and move as each does by itself."""

from __future__ import annotations

import copy

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, constant_rate
from mbsd.kinematics.prepared import prepare
from mbsd.kinematics.sweep import sweep

GRID = np.linspace(0.0, 1.0, 19)


def planetary(wheels: int = 3) -> Mechanism:
    """A planet whose pin drives a slider, and idle wheels in a row on the crank."""
    m = Mechanism("planetary")
    arm, planet = m.bar("arm", 0.06, mass=0.2), m.body("planet", mass=0.3, inertia=1e-4)
    bar, slider = m.bar("bar", 0.15, mass=0.1), m.body("slider", mass=0.2, inertia=1e-4)
    m.revolute("O", m.ground.at(0, 0), arm.start)
    m.revolute("A", arm.end, planet.origin)
    m.gear_pair("mesh", m.ground.at(0, 0), planet.origin, 0.04, 0.02)
    m.revolute("B", planet.at(0.015, 0), bar.start)
    m.revolute("C", bar.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    before = arm.at(0, 0)
    for k in range(wheels):
        wheel = m.body(f"wheel {k}", mass=0.1, inertia=1e-4)
        m.revolute(f"pin {k}", m.ground.at(-0.05 * (k + 1), 0), wheel.origin)
        m.gear_pair(f"mesh {k}", before, wheel.origin, 0.025, 0.025)
        before = wheel.origin
    m.drive_angle("motor", arm, constant_rate(2 * np.pi))
    m.start_near(arm=0, planet=0, bar=0)
    return m


@pytest.mark.parametrize("length", [0.12, 0.15, 0.3])
def test_motion_and_reactions_are_those_of_one_made_ready_by_itself(length: float) -> None:
    m = planetary()
    ready, other = prepare(m, 0.0, 1.0), copy.deepcopy(m)
    other.change("bar", length=length)
    other.change("slider", mass=1.0)
    beside, alone = sweep(other, None, 1, GRID, beside=ready), other.sweep(times=GRID)
    assert beside.route == "Newton-Raphson" != alone.route
    np.testing.assert_allclose(beside.q, alone.q, atol=1e-12)
    np.testing.assert_allclose(beside.a, alone.a, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(beside.wrench, alone.wrench, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(m.sweep(times=GRID).q, sweep(m, None, 1, GRID).q)  # the first is left as it was


def test_open_loops_are_refused_as_by_single_solutions() -> None:
    m = planetary()
    ready, other = prepare(m, 0.0, 1.0), copy.deepcopy(m)
    other.change("arm", length=0.07)
    with pytest.raises(AssemblyError, match="its centres are"):
        sweep(other, None, 1, GRID, beside=ready)


def test_joints_that_repeat_others_are_planned_anew() -> None:
    """A parallel crank with a third one: which rows are left out follows from the numbers."""
    m = Mechanism("three cranks")
    coupler = m.bar("coupler", 0.2)
    for k, at in enumerate((0.0, 0.1, 0.2)):
        crank = m.bar(f"crank {k}", 0.05)
        m.revolute(f"O {k}", m.ground.at(at, 0), crank.start)
        m.revolute(f"A {k}", crank.end, coupler.at(at, 0))
        m.start_near(**{f"crank {k}": 60.0})
    m.drive_angle("motor", m.bodies["crank 0"], constant_rate(1.0, start=1.0))
    m.start_near(coupler=0.0)
    ready, other = prepare(m, 0.0, 0.5), copy.deepcopy(m)
    assert ready.mobility.redundant_rows
    for k in range(3):
        other.change(f"crank {k}", length=0.06)
    times = np.linspace(0.0, 0.5, 6)
    np.testing.assert_array_equal(sweep(other, None, 1, times, beside=ready).q, other.sweep(times=times).q)
