"""Joints at rest that share their friction with more than one freedom: linkages beside each other, and a five-bar."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.results.solution import Solution
from tools.models.sticking import stuck_five_bar, two_slider_cranks

STEPS = 24


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
    both = two_slider_cranks(1.0).simulate(0.6, steps=STEPS)
    own = two_slider_cranks(1.0, names=name).simulate(0.6, steps=STEPS)
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
    sol = bars.simulate(0.5, steps=STEPS, event_rows=True)
    assert [name for name, what in told(sol) if what == "slides"] == [f"rub {pin}" for pin in "ABCE"]
    bend = float(sol.body("c").theta[0] - sol.body("d").theta[0])
    welded = stuck_five_bar(order="ABCE", bend=bend)
    welded.start_moving(a=0.0)
    four = welded.simulate(0.5, steps=STEPS, event_rows=True)
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
    sol, other = stuck_five_bar().simulate(0.6, steps=STEPS), stuck_five_bar(**change).simulate(0.6, steps=STEPS)
    assert at_rest(sol).sum() > 5
    np.testing.assert_allclose(carried(sol, names), carried(other, names), atol=1e-7)
    assert sorted(told(sol)) == sorted(told(other))
    turn = complex(math.cos(change.get("turned", 0.0)), math.sin(change.get("turned", 0.0)))
    force, turned = (each.joint("C").fx + 1j * each.joint("C").fy for each in (sol, other))
    np.testing.assert_allclose(force * turn, turned, atol=1e-6)
