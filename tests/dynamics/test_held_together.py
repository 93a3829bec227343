"""Contacts that stick, stops and joints at rest hold each other until statics lets nothing hold any more."""

from __future__ import annotations

import math
from collections.abc import Callable
from random import Random

import numpy as np
import pytest

from mbsd import Mechanism, polynomial
from mbsd.dynamics.events.driver import EventSteps
from mbsd.dynamics.integrators.dop853.loop import DOP853
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import TIME, WORK
from mbsd.equations.joint_friction import SENSE
from mbsd.results.solution import Solution
from tools.models.rough import pusher
from tools.models.sticking import stuck_five_bar, two_slider_cranks
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


FEW_SEEDS = {five_bar_with_stops: 6, striker: 24, shaken_box: 16, level_chain: 8}


@pytest.mark.parametrize(
    ("machines", "seeds"),
    [
        *((machines, range(count)) for machines, count in FEW_SEEDS.items()),
        *(pytest.param(machines, range(24, 84), marks=pytest.mark.slow) for machines in FEW_SEEDS),
    ],
)
def test_random_machines_that_hold_each_other_go_on(machines: Machines, seeds: range) -> None:
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


FEW = 24


def told(sol: Solution) -> list[tuple[str, str]]:
    return [(event.name, event.what) for event in sol.events]


def carried(sol: Solution, names: list[str]) -> np.ndarray:
    """(T, n) friction."""
    return np.stack([sol.friction(name).force for name in names], axis=1)


def at_rest(sol: Solution) -> np.ndarray:
    """(T,) where all joints rest."""
    times = [event.time for event in sol.events if event.what in ("sticks", "slides")]
    rests, breaks = max(t for t, e in zip(times, sol.events, strict=True) if e.what == "sticks"), times[-1]
    return (sol.t > rests) & (sol.t < breaks)


@pytest.mark.parametrize("name", ["a", "b"])
def test_a_linkage_shares_as_if_the_other_were_not_there(name: str) -> None:
    joints = [f"rub {joint}{name}" for joint in "OAB"]
    both = two_slider_cranks(1.0).simulate(0.6, steps=FEW)
    own = two_slider_cranks(1.0, names=name).simulate(0.6, steps=FEW)
    np.testing.assert_allclose(both.body(f"crank {name}").theta, own.body(f"crank {name}").theta, atol=1e-9)
    assert at_rest(both).sum() > 5
    np.testing.assert_allclose(carried(both, joints), carried(own, joints), atol=1e-9)
    ours = [event for event in both.events if event.name in joints]
    assert [(event.name, event.what) for event in ours] == told(own)
    np.testing.assert_allclose([event.time for event in ours], [event.time for event in own.events], atol=1e-9)
    for joint in (f"O{name}", f"B{name}"):
        np.testing.assert_allclose(both.joint(joint).fx, own.joint(joint).fx, atol=1e-7)


def test_no_joint_of_a_five_bar_is_at_its_limit_before_they_give_way() -> None:
    names = [f"rub {pin}" for pin in "ABCDE"]
    sol = stuck_five_bar().simulate(0.6, steps=120, event_rows=True)
    assert {name for name, what in told(sol) if what == "sticks"} == set(names)
    resting = at_rest(sol)
    normal = np.stack([sol.friction(name).normal for name in names], axis=1)
    part = np.abs(carried(sol, names)) / (0.4 * 0.06 * (normal + 100.0 + 10.0 * np.arange(5)))
    assert resting.sum() > 50
    assert part[resting].max() < 1.0
    first, second = np.sort(part[resting], axis=1)[:, [-1, 0]].T
    assert (first > second + 1e-6).all(), "one joint rests in the motion that gives way first"
    np.testing.assert_allclose(np.sort(part[resting], axis=1)[:, 1], first, rtol=1e-9)
    slides = [name for name, what in told(sol) if what == "slides"]
    assert slides == [f"rub {pin}" for pin in "ABCE"]
    before = int(np.flatnonzero(sol.t == sol.events[-1].time)[0])
    np.testing.assert_allclose(part[before, [0, 1, 2, 4]], 1.0, rtol=1e-7)
    assert part[before, 3] < 0.9


def test_a_five_bar_breaks_away_as_the_four_bar_that_a_weld_makes_of_it() -> None:
    """One freedom is left where the joint that rests is welded."""
    bars = stuck_five_bar()
    bars.start_moving(a=0.0)
    sol = bars.simulate(0.5, steps=FEW, event_rows=True)
    assert [name for name, what in told(sol) if what == "slides"] == [f"rub {pin}" for pin in "ABCE"]
    bend = float(sol.body("c").theta[0] - sol.body("d").theta[0])
    welded = stuck_five_bar(order="ABCE", bend=bend)
    welded.start_moving(a=0.0)
    four = welded.simulate(0.5, steps=FEW, event_rows=True)
    assert [event.time for event in four.events if event.what == "slides"] == pytest.approx(
        [event.time for event in sol.events if event.what == "slides"], rel=1e-9
    )
    slides = sol.events[-1].time
    for pin in "ABCE":  # before, another motion is the one that would give way first
        force, own = (
            each.friction(f"rub {pin}").force[(each.t > 0.4 * slides) & (each.t < slides - 1e-6)]
            for each in (sol, four)
        )
        np.testing.assert_allclose(force, own, atol=1e-8)


@pytest.mark.parametrize("change", [{"order": "DBEAC"}, {"turned": 2.0}])
def test_neither_the_order_of_joints_nor_a_turned_world_changes_a_share(change) -> None:
    names = [f"rub {pin}" for pin in "ABCDE"]
    sol, other = stuck_five_bar().simulate(0.6, steps=FEW), stuck_five_bar(**change).simulate(0.6, steps=FEW)
    assert at_rest(sol).sum() > 5
    np.testing.assert_allclose(carried(sol, names), carried(other, names), atol=1e-7)
    assert sorted(told(sol)) == sorted(told(other))
    turn = complex(math.cos(change.get("turned", 0.0)), math.sin(change.get("turned", 0.0)))
    force, turned = (each.joint("C").fx + 1j * each.joint("C").fy for each in (sol, other))
    np.testing.assert_allclose(force * turn, turned, atol=1e-6)


def bouncer() -> Mechanism:
    """A disc that bounces, slides and rolls on a floor, beside a pendulum whose pin sticks."""
    m = Mechanism("bouncer")
    ball = m.body("ball", 1.0, inertia=0.01)
    m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.1, restitution=0.5, friction=0.3)
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(3.0, 1.0), rod.start)
    m.friction("rub", "A", 0.6, radius=0.1, sticks=True)
    m.event("half", lambda t, moment: moment.t - 0.3)
    m.start_near(ball=(0.0, 0.4, 0.0), rod=-60)
    m.start_moving(ball=(1.0, 0.0, 0.0))
    return m


def begun(times: np.ndarray) -> tuple[EventSteps, list[bytes]]:
    ready = prepare_dynamics(bouncer(), 0.0, float(times[-1]), contacts=True)
    state, out = ready.begun(times)
    run = Run(ready, DOP853, 1e-8, 1e-3, float(times[-1]), {})
    met = EventSteps(ready, run, state, out, list(bouncer().events.values()))
    met.begin()
    return met, _constants(met)


def _constants(met: EventSteps) -> list[bytes]:
    """Arrays of the mechanism that are no part of the record: they must not change."""
    dynamics, packed = met.dynamics, met.packed
    arrays = [*packed.system, dynamics.inertia, dynamics.inverse, dynamics.metric, dynamics.weight, *dynamics.laws]
    arrays += [
        dynamics.loads.friction,
        np.delete(dynamics.loads.friction_number, SENSE, axis=1),
        dynamics.loads.number,
        dynamics.loads.term,
    ]
    return [np.asarray(array).tobytes() for array in arrays]


def test_each_point_to_go_on_from_leads_to_the_same_end() -> None:
    times = np.linspace(0.0, 2.0, 21)
    met, constants = begun(times)
    met.to(2.0)
    happened = [(happening.name, happening.what) for happening in met.happenings]
    assert {"impact", "sticks"} <= {what for _, what in happened}
    assert ("half", "event") in happened
    assert _constants(met) == constants
    assert len(met.snapshots) > 5
    for snapshot in met.snapshots:
        again, _ = begun(times[times >= snapshot.time])
        again.state.y[...], again.state.clock[TIME] = snapshot.y, snapshot.time
        again.resume(snapshot, snapshot.work)
        again.to(2.0)
        np.testing.assert_allclose(again.state.y, met.state.y, atol=1e-12)  # the first step is chosen anew
        assert again.state.clock[WORK] == pytest.approx(met.state.clock[WORK], abs=1e-12)
        later = [happening for happening in met.happenings if happening.time > snapshot.time]
        assert [(each.name, each.what) for each in again.happenings] == [(each.name, each.what) for each in later]


def test_a_snapshot_does_not_follow() -> None:
    met, _ = begun(np.array([0.0, 1.0]))
    snapshot = met.snapshots[-1]
    kept = [part.copy() for part in snapshot.held]
    met.to(1.0)
    for part, before in zip(snapshot.held, kept, strict=True):
        np.testing.assert_array_equal(part, before)
