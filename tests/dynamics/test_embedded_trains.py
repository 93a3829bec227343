"""Gear trains, belts and locks in independent coordinates, beside groups, against reference coordinates."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, harmonic
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.embedding import embedded_at_start
from mbsd.kinematics.groups.blocks import TRAIN
from mbsd.kinematics.groups.groups import KIND
from tests.dynamics.test_embedding import agree, both


def planetary(m: Mechanism, size: float = 1.0, turned: float = 0.0) -> None:
    """Sun, planet on an arm, ring on ground; the arm is eccentric."""
    center = m.ground.at(0.0, 0.0, turned)
    arm = m.body("arm", 0.5, (0.1 * size, 0.02 * size), 0.01 * size**2)
    sun = m.body("sun", 1.0, (0.01 * size, 0.0), 0.01 * size**2)
    planet = m.body("planet", 0.4, (0.0, 0.02 * size), 0.004 * size**2)
    m.revolute("A", center, arm.origin)
    m.revolute("S", center, sun.origin)
    m.revolute("P", arm.at(0.3 * size, 0.0), planet.origin)
    m.gear_pair("inner", sun.origin, planet.origin, radius_i=0.2 * size, radius_j=0.1 * size)
    m.gear_pair("outer", center, planet.origin, radius_i=0.4 * size, radius_j=0.1 * size, internal=True)
    m.start_near(arm=40 + math.degrees(turned), sun=math.degrees(turned), planet=math.degrees(turned))


def beside_a_four_bar(size: float = 1.0, turned: float = 0.0) -> Mechanism:
    """A spring from the arm to the coupler."""
    m = Mechanism("beside_a_four_bar", gravity=(9.81 * size * math.sin(turned), -9.81 * size * math.cos(turned)))
    planetary(m, size, turned)
    c, s = math.cos(turned), math.sin(turned)
    crank, coupler, rocker = (m.bar(name, size * length, 0.2) for name, length in (("a", 0.1), ("b", 0.3), ("c", 0.25)))
    m.revolute("B0", m.ground.at(size * c, size * s), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(1.28 * size * c, 1.28 * size * s), rocker.start)
    m.start_near(a=60 + math.degrees(turned), b=20 + math.degrees(turned), c=100 + math.degrees(turned))
    m.spring("spring", m.bodies["arm"].at(0.3 * size, 0.0), coupler.at(0.1 * size, 0.05 * size), 20.0, free_length=0.5)
    return m


def differential() -> Mechanism:
    """The ring turns, too, and is driven; the planet throws a rod about."""
    m = Mechanism("differential", gravity=(0.5, -9.81))
    planetary(m)
    ring = m.body("ring", 1.0, (0.0, 0.0), 0.1)
    m.revolute("R", m.ground.origin, ring.origin)
    del m.joints["outer"]
    m.gear_pair("outer", ring.origin, m.bodies["planet"].origin, radius_i=0.4, radius_j=0.1, internal=True)
    m.drive_angle("motor", ring, harmonic(0.6, 5.0, 0.2, 0.3))
    rod = m.bar("rod", 0.2, 0.3)
    m.revolute("hang", m.bodies["planet"].at(0.08, 0.0), rod.start)
    return m


def on_a_rocker() -> Mechanism:
    """Wheels on the links of a four-bar: one is fixed to its crank, one rolls round it, a lock and a belt go on."""
    m = Mechanism("on_a_rocker", gravity=(0.5, -9.81))
    crank, coupler, rocker = (m.bar(name, length, 0.4) for name, length in (("a", 0.1), ("b", 0.3), ("c", 0.25)))
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.28, 0.0), rocker.start)
    m.start_near(a=60, b=20, c=100)
    first, second, third = (m.body(name, 0.3, (0.01, 0.0), 0.002) for name in ("first", "second", "third"))
    m.revolute("F", coupler.at(0.1, 0.0), first.origin)
    m.revolute("G", coupler.at(0.25, 0.0), second.origin)
    m.revolute("H", rocker.at(0.1, 0.05), third.origin)
    m.gear_pair("round", crank.end, first.origin, radius_i=0.07, radius_j=0.03)
    m.belt("belt", first.origin, second.origin, radius_i=0.02, radius_j=0.05)
    m.angle_lock("lock", second.origin, third.origin)
    return m


MACHINES = {"beside a four-bar": beside_a_four_bar, "differential": differential, "on a rocker": on_a_rocker}


@pytest.mark.parametrize("name", MACHINES)
def test_trains_beside_groups(name: str) -> None:
    made = embedded_at_start(prepare_dynamics(MACHINES[name](), 0.0, 1.0))
    assert made is not None
    assert TRAIN in made.arrays.group[:, KIND]
    agree(*both(MACHINES[name](), 0.6), close=1e-5)


@settings(max_examples=4, deadline=None)
@given(size=st.sampled_from([0.1, 1.0, 30.0]), turned=st.floats(-3.0, 3.0))
def test_size_and_direction_do_not_matter(size: float, turned: float) -> None:
    m = beside_a_four_bar(size, turned)
    del m.forces["spring"]
    transformed = m.simulate(0.5, steps=10, tolerance=1e-10)
    straight = beside_a_four_bar()
    del straight.forces["spring"]
    original = straight.simulate(0.5, steps=10, tolerance=1e-10)
    assert transformed.stats.independent
    for name in ("planet", "b"):
        np.testing.assert_allclose(transformed.body(name).theta - turned, original.body(name).theta, atol=1e-6)


def test_whole_turns_are_counted_in_long_steps() -> None:
    """Fast wheels at a loose tolerance: an angle that is 2 pi off would turn a wheel of ratio 0.2/0.1 elsewhere."""
    m = beside_a_four_bar()
    m.gravity = (0.0, 0.0)
    del m.forces["spring"]
    m.start_moving(arm=(0.0, 0.0, 90.0))
    loose = m.simulate(2.0, steps=3, tolerance=1e-4, formulation="independent")
    exact = m.simulate(2.0, steps=3, tolerance=1e-10, formulation="reference")
    assert loose.stats.position_residual < 1e-10
    assert abs(exact.body("planet").theta[-1]) > 100.0
    np.testing.assert_allclose(loose.body("planet").theta, exact.body("planet").theta, rtol=1e-2, atol=1e-9)
