"""Cams, Genevas, racks, users' relations and triads in independent coordinates, against reference coordinates."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, MechanismError, harmonic
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.embedding import embedded_at_start
from mbsd.kinematics.groups.blocks import BLOCK, TRAIN
from mbsd.kinematics.groups.groups import KIND
from tests.dynamics.test_embedding import agree, both
from tools.random_mechanisms.shafts import RandomMachine

PARTS = sorted(RandomMachine.KINDS)


def heavy(machine: RandomMachine) -> Mechanism:
    """The machine with masses in a field of gravity, and a pendulum on its last body."""
    m, size = machine.m, machine.scale
    m.gravity = (0.3 * size, -1.0 * size)
    bodies = [body for body in m.bodies.values() if body is not m.ground]
    for body in bodies:
        body.mass, body.inertia, body.com = 1.0, 0.05 * size**2, (0.03 * size, 0.01 * size)
    bob = m.bar("bob", 0.3 * size, 0.5)
    m.revolute("hang", bodies[-1].at(0.2 * size, 0.05 * size), bob.start)
    return m


def machine_of(seed: int, kinds: list[str], scale: float, freed: bool) -> Mechanism:
    """Of random parts, as driven or left to itself."""
    machine = RandomMachine(seed, scale)
    for kind in kinds:
        RandomMachine.KINDS[kind](machine)
    m = heavy(machine)
    if freed:
        m.drivers.clear()
        m.start_moving(b1=3.0)
    return m


def held_plate(driven: bool = True) -> Mechanism:
    """A plate on three bars, one of them on a crank, with a pendulum: a group of the third class (a triad)."""
    m = Mechanism("held_plate", gravity=(0.0, -9.81))
    crank, plate = m.bar("crank", 0.1, 0.5), m.body("plate", 1.0, (0.0, 0.0), 0.02)
    bars = [m.bar(f"bar{k}", length, 0.4) for k, length in enumerate((0.36, 0.46, 0.48))]
    m.revolute("O", m.ground.origin, crank.start)
    bases = crank.end, m.ground.at(0.67, -0.5), m.ground.at(0.55, 0.6)
    corners = (-0.1, -0.05), (0.12, -0.04), (0.0, 0.12)
    for k, (bar, base, corner) in enumerate(zip(bars, bases, corners, strict=True)):
        m.revolute(f"A{k}", base, bar.start)
        m.revolute(f"B{k}", bar.end, plate.at(*corner))
    bob = m.bar("bob", 0.2, 0.5)
    m.revolute("hang", plate.origin, bob.start)
    m.start_near(crank=30, plate=0, bar0=-5, bar1=90, bar2=-90, bob=-60)
    if driven:
        m.drive_angle("motor", crank, harmonic(0.2, 6.0, 0.0, 0.5))
    return m


@pytest.mark.filterwarnings("ignore")
@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 100_000),
    kinds=st.lists(st.sampled_from(PARTS), min_size=1, max_size=3),
    scale=st.sampled_from([0.1, 1.0, 30.0]),
    freed=st.booleans(),
)
def test_random_machines(seed: int, kinds: list[str], scale: float, freed: bool) -> None:
    m = machine_of(seed, kinds, scale, freed)
    if embedded_at_start(prepare_dynamics(m, 0.0, 0.5)) is None:
        return
    independent, reference = (
        m.simulate(0.5, 30, tolerance=1e-10, formulation=name) for name in ("independent", "reference")
    )
    assert independent.stats.independent
    unit = np.array([scale, scale, 1.0])
    for name, close in (("q", 1e-6), ("v", 1e-5)):
        a, b = (getattr(x, name).reshape(31, -1, 3) / unit for x in (independent, reference))
        np.testing.assert_allclose(
            a, b, atol=close * max(1.0, float(np.abs(reference.v.reshape(31, -1, 3) / unit).max()))
        )
    if (
        kinds.count("geneva") > 1
    ):  # one that another indexes may rest at the edge of its slot: rounding says what holds it
        return
    np.testing.assert_allclose(independent.wrench, reference.wrench, atol=1e-4 * float(np.abs(reference.wrench).max()))


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("kind", ["cam", "geneva", "law", "rack"])
def test_each_kind_is_a_block(kind: str) -> None:
    m = machine_of(3, [kind], 1.0, True)
    made = embedded_at_start(prepare_dynamics(m, 0.0, 1.0))
    assert made is not None
    assert BLOCK in made.arrays.group[:, KIND]
    assert made.pays
    agree(*both(m, 0.5), close=1e-5)
    assert m.simulate(0.2, 4).stats.independent


def test_triad_beside_a_freedom() -> None:
    m = held_plate()
    made = embedded_at_start(prepare_dynamics(m, 0.0, 1.0))
    assert made is not None
    assert BLOCK in made.arrays.group[:, KIND]
    agree(*both(m, 2.0))


def test_what_does_not_pay_stays_in_reference_coordinates() -> None:
    m = held_plate()
    assert not m.simulate(0.1, 2).stats.independent
    at = m.bodies["plate"].at(0.02, 0.0)
    for k in range(4):  # closed forms beside the triad
        first, second = m.bar(f"first{k}", 0.2, 0.1), m.bar(f"second{k}", 0.25, 0.1)
        m.revolute(f"P{k}", at, first.start)
        m.revolute(f"Q{k}", first.end, second.end)
        m.revolute(f"R{k}", m.ground.at(0.6 + 0.02 * k, -0.2), second.start)
        m.start_near(**{f"first{k}": -20, f"second{k}": 80})
    made = embedded_at_start(prepare_dynamics(m, 0.0, 0.1))
    assert made is not None
    assert made.pays
    assert m.simulate(0.1, 2).stats.independent


def test_closed_forms_go_before_blocks() -> None:
    """Another coordinate opens the triad."""
    m = held_plate(driven=False)
    made = embedded_at_start(prepare_dynamics(m, 0.0, 1.0))
    assert made is not None
    assert BLOCK not in made.arrays.group[:, KIND]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("kind", ["cam", "geneva"])
def test_energy_is_kept_through_many_turns(kind: str) -> None:
    m = machine_of(5, [kind], 1.0, True)
    m.start_moving(b1=4.0)
    sol = m.simulate(10.0, 400, tolerance=1e-11)
    assert sol.stats.independent
    assert np.ptp(sol.q[:, list(m.bodies).index("b1"), 2]) > 4 * math.pi
    energy = sol.energy.total
    assert np.ptp(energy) < 1e-7 * np.abs(sol.energy.kinetic).max()


def test_a_triad_that_swings_back_from_its_ends() -> None:
    """Where the crank cannot turn on, both formulations swing back alike."""
    m = held_plate(driven=False)
    m.start_moving(crank=6.0)
    independent, reference = (
        m.simulate(1.0, 60, tolerance=1e-10, formulation=name) for name in ("independent", "reference")
    )
    np.testing.assert_allclose(independent.q, reference.q, atol=1e-5)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_long_steps_stay_on_the_branch_of_the_start(tolerance: float) -> None:
    m = held_plate()
    fine = m.simulate(2.0, 200, tolerance=1e-10, formulation="independent")
    coarse = m.simulate(2.0, 2, tolerance=tolerance, formulation="independent")
    plate = list(m.bodies).index("plate")
    np.testing.assert_allclose(
        coarse.q[-1, 3 * plate : 3 * plate + 3], fine.q[-1, 3 * plate : 3 * plate + 3], atol=1e-9
    )


def test_what_a_users_relation_raises_comes_out() -> None:
    """A function that fails in the midst of a run stops it with its own words."""

    def half(x: float, y: float, a: float) -> float:
        if -math.atan2(y, x) > 0.8:
            raise ValueError("too far")
        return a - 0.5 * math.atan2(y, x)

    m = Mechanism("fails", gravity=(0.0, 0.0))
    bar, other = m.bar("bar", 0.2, 1.0), m.body("other", 1.0, (0.0, 0.0), 0.01)
    m.revolute("O", m.ground.origin, bar.start)
    m.revolute("P", m.ground.at(0.5, 0), other.origin)
    m.constraint("half", bar.start, other.origin, half)
    m.start_near(bar=0, other=0)
    m.start_moving(bar=1.0)
    assert m.simulate(0.3, 5).stats.independent
    with pytest.raises(MechanismError, match="too far"):
        m.simulate(2.0, 5)


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
