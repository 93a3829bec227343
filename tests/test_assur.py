"""Closed forms of Assur groups against Newton-Raphson: every group, both ways round, chains of them, and doubts."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mbsd import AssemblyError, Mechanism, MechanismError, constant_rate
from mbsd.assur.groups import NAMES
from mbsd.prepared import Prepared, prepare


def crank(m: Mechanism, length: float = 0.1, start: float = 0.0):
    """A driven crank about the origin; returns it."""
    body = m.bar("crank", length, mass=1.0, com=(0.03, 0.01))
    m.revolute("O", m.ground.at(0, 0), body.start)
    m.drive_angle("motor", body, constant_rate(6.0, start))
    m.start_near(crank=10)
    return body


def four_bar() -> Mechanism:
    m = Mechanism("four-bar")
    coupler, rocker = m.bar("coupler", 0.38, 1.0, com=(0.1, 0.05)), m.bar("rocker", 0.30, 1.0)
    m.revolute("A", crank(m).end, coupler.start)
    m.revolute("B", coupler.end, rocker.end)
    m.revolute("C", m.ground.at(0.4, 0), rocker.start)
    m.start_near(coupler=45, rocker=90)
    return m


def slider_crank(turned_round: bool) -> Mechanism:
    m = Mechanism("slider-crank")
    rod, slider = m.bar("rod", 0.3, 1.0), m.body("slider", 1.0, com=(0.02, 0.01), inertia=0.1)
    m.revolute("A", crank(m).end, rod.start)
    m.revolute("B", rod.end, slider.at(0.01, 0.03))
    ends = m.ground.at(0.4, -0.05, 0.1), slider.at(0, 0.02, 0.2)
    m.prismatic("rail", *(reversed(ends) if turned_round else ends))
    m.start_near(rod=-5)
    return m


def slotted_rod() -> Mechanism:
    m = Mechanism("slotted rod")
    rod = m.bar("rod", 0.3, 1.0)
    m.revolute("A", crank(m).end, rod.start)
    m.pin_in_slot("rail", m.ground.at(0.2, -0.05, 0.1), rod.end)
    m.start_near(rod=-5)
    return m


def inverted(turned_round: bool) -> Mechanism:
    m = Mechanism("inverted")
    guide, block = m.body("guide", 1.0, com=(0.1, 0.02), inertia=0.2), m.body("block", 0.5, (0.01, 0.02), 0.1)
    m.revolute("A", m.ground.at(-0.3, 0.05), guide.at(0.01, 0.0))
    m.revolute("B", crank(m).end, block.at(0.02, 0.01))
    ends = guide.at(0.05, 0.01, 0.1), block.at(0.01, 0.02, 0.3)
    m.prismatic("slide", *(reversed(ends) if turned_round else ends))
    m.start_near(guide=8)
    return m


def slotted_guide() -> Mechanism:
    m = Mechanism("slotted guide")
    guide = m.body("guide", 1.0, com=(0.1, 0.02), inertia=0.2)
    m.revolute("A", m.ground.at(-0.3, 0.05), guide.at(0.01, 0.0))
    m.pin_in_slot("slot", guide.at(0, 0.03, 0.1), crank(m).end)
    m.start_near(guide=8)
    return m


def yoke(turned_round: bool) -> Mechanism:
    m = Mechanism("yoke")
    body = m.body("yoke", 1.0, com=(0.1, 0.02), inertia=0.2)
    ends = m.ground.at(0.3, 0.1, 0.1), body.at(0.02, 0.01, 0.2)
    m.prismatic("rail", *(reversed(ends) if turned_round else ends))
    m.pin_in_slot("slot", body.at(0, 0.03, 1.3), crank(m).end)
    return m


def six_bar_with_welds() -> Mechanism:
    m = four_bar()
    arm, rod, slider = m.bar("arm", 0.2, 0.3), m.bar("rod", 0.5, 0.4), m.body("slider", 0.2, inertia=0.1)
    m.weld("brazed", arm.at(0.02, 0.0, 0.4), m.bodies["rocker"].at(0.1, 0.05))
    m.revolute("D", arm.end, rod.start)
    m.revolute("E", rod.end, slider.origin)
    m.prismatic("rail", m.ground.at(0, -0.2), slider.origin)
    m.start_near(rod=-30)
    return m


def crank_on_a_turning_base() -> Mechanism:
    m = Mechanism("carried")
    base, arm = m.bar("base", 0.2, 1.0), m.bar("arm", 0.1, 1.0)
    m.revolute("O", m.ground.at(0, 0), base.start)
    m.revolute("A", base.end, arm.start)
    m.drive_angle("motor", base, constant_rate(2.0))
    m.drive_relative_angle("wrist", base, arm, constant_rate(5.0, 0.3))
    m.start_near(base=0, arm=0)
    return m


MODELS = {
    "RRR": four_bar,
    "RRP": lambda: slider_crank(False),
    "RRP round": lambda: slider_crank(True),
    "RRP slot": slotted_rod,
    "RPR": lambda: inverted(False),
    "RPR round": lambda: inverted(True),
    "RPR slot": slotted_guide,
    "yoke": lambda: yoke(False),
    "yoke round": lambda: yoke(True),
    "welded six-bar": six_bar_with_welds,
    "driven carried": crank_on_a_turning_base,
}


def both_routes(m: Mechanism, duration: float = 1.05, steps: int = 240) -> tuple[Prepared, list, list]:
    """The closed form's positions, velocities and accelerations, and those of Newton-Raphson."""
    times = np.linspace(0.0, duration, steps + 1)
    ready = prepare(m, 0.0, duration)
    assert ready.groups is not None
    drives = ready.packed.drives(times)
    closed = ready._closed_form(ready.groups, times, drives)
    assert closed is not None
    return ready, list(closed), list(dataclasses.replace(ready, groups=None).march(times)[:3])


@pytest.mark.parametrize("name", MODELS)
def test_closed_forms_are_what_newton_finds(name: str) -> None:
    ready, closed, newton = both_routes(MODELS[name]())
    assert name.split()[0].removeprefix("welded") in ready.route
    assert np.abs(closed[0] - newton[0]).max() < 1e-12
    for one, other in zip(closed[1:], newton[1:], strict=True):
        assert np.abs(one - other).max() < 1e-11 * max(1.0, np.abs(other).max())


def test_every_group_is_tried() -> None:
    tried = " ".join(prepare(model(), 0.0, 1.0).route for model in MODELS.values())
    assert all(name in tried for name in NAMES)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), chain=st.integers(1, 3))
def test_random_chains_of_dyads(seed: int, chain: int) -> None:
    """Each dyad hangs between a point of an earlier body and one of ground."""
    random = np.random.default_rng(seed)
    m = Mechanism("chain")
    last = crank(m, 0.1)
    reach = last.end
    for k in range(chain):
        first, second = m.bar(f"a{k}", random.uniform(0.4, 0.7), 1.0), m.bar(f"b{k}", random.uniform(0.4, 0.7), 1.0)
        m.revolute(f"A{k}", reach, first.start)
        m.revolute(f"B{k}", first.end, second.end)
        m.revolute(f"C{k}", m.ground.at(0.5 + 0.4 * k, random.uniform(-0.1, 0.1)), second.start)
        m.start_near(**{f"a{k}": 60.0, f"b{k}": 120.0})
        reach = second.at(0.1, 0.02)
    try:
        ready, closed, newton = both_routes(m)
    except (MechanismError, AssertionError):
        assume(False)
        raise
    assert ready.route.count("RRR") == chain
    assert np.abs(closed[0] - newton[0]).max() < 1e-11


def test_coarse_steps_are_left_to_newton() -> None:
    m = four_bar()
    times = np.linspace(0.0, 1.05, 8)
    fine = m.sweep(times=np.linspace(0.0, 1.05, 8 * 70 - 69))
    coarse = m.sweep(times=times)
    np.testing.assert_allclose(coarse.body("rocker").theta, fine.body("rocker").theta[::70], atol=1e-10)


def test_links_that_cannot_close_give_the_same_error() -> None:
    m = Mechanism("toggle")
    coupler, rocker = m.bar("coupler", 0.2, 1.0), m.bar("rocker", 0.25, 1.0)
    m.revolute("A", crank(m).end, coupler.start)
    m.revolute("B", coupler.end, rocker.end)
    m.revolute("C", m.ground.at(0.4, 0), rocker.start)
    m.start_near(coupler=30, rocker=140)
    with pytest.raises(MechanismError) as closed:
        m.sweep(1.0)
    ready = dataclasses.replace(prepare(m, 0.0, 1.0), groups=None)
    with pytest.raises(MechanismError) as newton:
        ready.march(np.linspace(0.0, 1.0, 361))
    assert str(closed.value) == str(newton.value)


def test_parallelogram_keeps_to_the_smooth_branch_or_is_refused() -> None:
    m = Mechanism("parallelogram")
    coupler, rocker = m.bar("coupler", 0.4, 1.0), m.bar("rocker", 0.1, 1.0)
    m.revolute("A", crank(m, 0.1, 0.3).end, coupler.start)
    m.revolute("B", coupler.end, rocker.end)
    m.revolute("C", m.ground.at(0.4, 0), rocker.start)
    m.start_near(coupler=0, rocker=17)
    sol = m.sweep(times=np.linspace(0.0, 1.0, 357))
    crank_angle = sol.body("crank").theta
    follows = np.abs(sol.body("rocker").theta - crank_angle).max()
    assert follows < 1e-6, "cranks of a parallelogram turn together through its flat poses"


def test_a_joint_without_closed_form_is_solved_by_newton() -> None:
    m = Mechanism("rod")
    rocker = m.bar("rocker", 0.3, 1.0)
    m.revolute("C", m.ground.at(0.4, 0), rocker.start)
    m.distance("rod", crank(m).end, rocker.end, 0.38)
    m.start_near(rocker=90)
    sol = m.sweep(1.05)
    assert sol.route == "Newton-Raphson"
    np.testing.assert_allclose(sol.body("rocker").theta, four_bar().sweep(1.05).body("rocker").theta, atol=1e-10)


def test_the_route_is_told() -> None:
    assert four_bar().sweep(1.0).route.startswith("closed form: driven")


def test_open_links_are_refused_at_the_start() -> None:
    short = Mechanism("short")
    coupler, rocker = short.bar("coupler", 0.1, 1.0), short.bar("rocker", 0.1, 1.0)
    short.revolute("A", crank(short).end, coupler.start)
    short.revolute("B", coupler.end, rocker.end)
    short.revolute("C", short.ground.at(math.pi, 0), rocker.start)
    with pytest.raises(AssemblyError):
        short.sweep(1.0)
