"""Contacts that stick, stops and joints at rest hold each other until statics lets nothing hold any more."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import numpy as np
import pytest

from mbsd import Mechanism, polynomial
from mbsd.results.solution import Solution
from tools.models.rough import pusher
from tools.random_mechanisms.rough import five_bar_with_stops, level_chain, shaken_box, striker

WEIGHT, STATIC, KINETIC = 10.0, (0.5, 0.7), 0.3
HALF, BELOW = 0.1, 0.05
STEPS = 40
Machines = Callable[[Random], tuple[Mechanism, str]]


def pulled_box(height: float, static: tuple[float, float]) -> Mechanism:
    """A box on two feet under a pull of 1 N/s at a height above its centre of mass (m)."""
    m = Mechanism("box", gravity=(0, -10))
    box = m.body("box", WEIGHT / 10, inertia=0.02)
    for name, x, mu in (("rear", -HALF, static[0]), ("front", HALF, static[1])):
        m.rigid_contact(name, m.ground.at(0, 0), box.at(x, -BELOW), friction=KINETIC, static_friction=mu)
    m.force("pull", box.at(0, height), polynomial(0.0, 1.0))
    m.start_near(box=(0, BELOW, 0))
    return m


@pytest.mark.parametrize("height", [0.0, -0.05, 0.03])
@pytest.mark.parametrize("static", [(STATIC[0], STATIC[0]), STATIC])
def test_a_box_on_two_feet_breaks_away_once_neither_foot_can_hold_more(
    height: float, static: tuple[float, float]
) -> None:
    """By moments the pull P takes P (height + BELOW) / (2 HALF) off the rear foot and puts it on the front one."""
    sol = pulled_box(height, static).simulate(8.0, steps=80)
    moved = (height + BELOW) / (2 * HALF)
    pull = 0.5 * WEIGHT * sum(static) / (1.0 - (static[1] - static[0]) * moved)
    breaks = [(event.time, event.name) for event in sol.events if event.what == "slides"]
    assert {name for _, name in breaks} == {"rear", "front"}
    assert [time for time, _ in breaks] == pytest.approx([pull, pull], rel=1e-9)
    late = sol.t > pull
    np.testing.assert_allclose(sol.body("box").ax[late], sol.t[late] - KINETIC * WEIGHT, atol=1e-9)
    assert_coulomb(sol)


def assert_coulomb(sol: Solution) -> None:
    """Contacts push only, and nothing that is at rest carries more than its static friction."""
    for joint in sol.packed.joints:
        if "static_friction" in joint.params:
            view = sol.contact(joint.name)
            largest = float(np.abs(view.normal).max(initial=0.0)) + 1e-9
            assert (view.normal >= -1e-7 * largest).all()
            assert (np.abs(view.friction) <= joint.params["static_friction"] * view.normal + 1e-7 * largest).all()


@pytest.mark.parametrize(
    ("machines", "count"), [(five_bar_with_stops, 6), (striker, 24), (shaken_box, 16), (level_chain, 8)]
)
def test_random_machines_that_hold_each_other_go_on(machines: Machines, count: int) -> None:
    check(machines, range(count))


@pytest.mark.slow
@pytest.mark.parametrize("machines", [five_bar_with_stops, striker, shaken_box, level_chain])
def test_many_random_machines_that_hold_each_other_go_on(machines: Machines) -> None:
    check(machines, range(24, 84))


def check(machines: Machines, seeds: range) -> None:
    for seed in seeds:
        m, _ = machines(Random(seed))
        sol = m.simulate(0.8, steps=STEPS, tolerance=1e-8)
        assert sol.t[-1] == pytest.approx(0.8)
        assert_coulomb(sol)
        assert all(event.energy <= 1e-9 for event in sol.events if event.what == "impact")


def test_a_block_at_rest_on_both_feet_gives_way_once() -> None:
    """Its rows are those of one foot, on which it would tilt: the other pushes only where loads are divided."""
    feet = dict.fromkeys(("rear", "front"), (0.5111247677857788, 0.5111247677857788))
    m = pusher(True, "OAB", 21.6322488607124, (0.5111247677857788, 0.5111247677857788), feet, (2.41, 7.92), 20.0)
    sol = m.simulate(0.2, steps=20, tolerance=1e-8)
    assert sol.t[-1] == pytest.approx(0.2)
    assert_coulomb(sol)
    assert len({event.time for event in sol.events if event.what in ("slides", "sticks")}) < 10


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow), pytest.param(2, marks=pytest.mark.slow)])
def test_a_five_bar_at_its_stops_moves_as_with_friction_by_the_rate(seed: int) -> None:
    """Friction by the rate has no events, no rows that hold and nothing to divide, but creeps as fast as it may."""
    sticking = five_bar_with_stops(Random(seed), plain=True)[0].simulate(0.8, steps=STEPS, tolerance=1e-8)
    apart = []
    for speed in (1e-5, 2e-6):
        creeping = five_bar_with_stops(Random(seed), speed, plain=True)[0]
        beside = creeping.simulate(0.8, steps=STEPS, tolerance=1e-7, method="radau")
        apart.append(max(np.abs(sticking.body(name).theta - beside.body(name).theta).max() for name in "abcd"))
    assert apart[1] < 1e-3
    assert apart[1] < 0.5 * apart[0]
