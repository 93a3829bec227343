"""Mechanisms taken apart into closed forms and blocks against Newton-Raphson of the whole."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import mbsd.kinematics.groups.parts
from mbsd import Mechanism, MechanismError, constant_rate
from mbsd.kinematics.groups.plan import describe
from mbsd.kinematics.march import march_along
from mbsd.kinematics.prepared import Prepared, prepare
from tools.models.assur_models import crank
from tools.random_mechanisms.shafts import RandomMachine


def both(ready: Prepared, times: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Positions, velocities and accelerations by parts and of the whole."""
    parts, whole = (march_along(route, times) for route in (ready, dataclasses.replace(ready, groups=None)))
    assert parts.closed
    assert not whole.closed
    return [parts.q, parts.v, parts.a], [whole.q, whole.v, whole.a]


def assert_same(ready: Prepared, times: np.ndarray, scale: float = 1.0) -> None:
    """Both routes agree to 1e-10, rates to the same part of the largest or, where poses are sensitive, of more."""
    parts, whole = both(ready, times)
    unit = np.array([scale, scale, 1.0])
    for order, (a, b) in enumerate(zip(parts, whole, strict=True)):
        a, b = (x.reshape(len(times), -1, 3) / unit for x in (a, b))
        assert np.abs(a - b).max() < 1e-10 * 10**order * max(1.0, np.abs(b).max())


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 100_000),
    kinds=st.lists(st.sampled_from(sorted(RandomMachine.KINDS)), min_size=1, max_size=5),
    scale=st.sampled_from([0.1, 1.0, 30.0]),
    duration=st.sampled_from([0.3, 1.05, 4.0]),
    steps=st.sampled_from([3, 17, 240]),
)
def test_random_machines(seed: int, kinds: list[str], scale: float, duration: float, steps: int) -> None:
    machine = RandomMachine(seed, scale)
    for kind in kinds:
        RandomMachine.KINDS[kind](machine)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(mbsd.kinematics.groups.parts, "WHOLE", math.inf)  # also where the whole would be solved faster
        ready = prepare(machine.m, 0.0, duration)
    assert ready.groups is not None
    times = np.linspace(0.0, duration, steps + 1)
    try:
        march_along(dataclasses.replace(ready, groups=None), times)
    except MechanismError as error:
        with pytest.raises(type(error)):
            march_along(ready, times)
        return
    assert_same(ready, times, scale)


def test_every_part_is_tried() -> None:
    """The random machines bring trains, blocks of one unknown and of more, and closed forms on them."""
    told = []
    for seed, kind in enumerate(RandomMachine.KINDS):
        machine = RandomMachine(seed)
        RandomMachine.KINDS[kind](machine)
        machine.dyad()
        ready = prepare(machine.m, 0.0, 1.0)
        if ready.groups is not None:
            told.append(describe(ready.groups, ready.blocks, ready.packed.body_names))
    assert any("train" in words and "RRR" in words for words in told)
    assert any("Newton-Raphson" in words and "RRR" in words for words in told)


def planetary(teeth: tuple[int, int], planets: int) -> Mechanism:
    """Sun and ring with planets between, the sun driven, and a four-bar on the carrier."""
    m = Mechanism("planetary")
    own, other = teeth
    sun, carrier = m.body("sun"), m.body("carrier")
    m.revolute("S", m.ground.at(0, 0), sun.origin)
    m.revolute("C", m.ground.at(0, 0), carrier.origin)
    reach = 0.001 * (own + other)
    for k in range(planets):
        planet, turn = m.body(f"planet{k}"), 2 * math.pi * k / planets
        m.revolute(f"P{k}", carrier.at(reach * math.cos(turn), reach * math.sin(turn)), planet.origin)
        m.gear_pair(f"sun{k}", sun.origin, planet.origin, teeth=teeth, module=0.002)
        ring = (own + 2 * other, other)
        m.gear_pair(f"ring{k}", m.ground.at(0, 0), planet.origin, teeth=ring, module=0.002, internal=True)
        m.start_near(**{planet.name: 0})
    m.drive_angle("motor", sun, constant_rate(2 * math.pi))
    coupler, rocker = m.bar("coupler", 3.5 * reach), m.bar("rocker", 3.0 * reach)
    m.revolute("A", carrier.at(reach, 0.0), coupler.start)
    m.revolute("B", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(4 * reach, 0), rocker.start)
    m.start_near(sun=0, carrier=0, coupler=50, rocker=90)
    return m


@pytest.mark.parametrize("planets", [1, 3])
def test_planetary_gear_with_a_four_bar_is_closed(planets: int) -> None:
    """Willis: the carrier goes z_s / (z_s + z_r) of the sun, all turns counted; further planets are proved to hold."""
    ready = prepare(planetary((18, 24), planets), 0.0, 7.3)
    assert ready.route.startswith("closed form")
    assert ready.proved
    times = np.linspace(0.0, 7.3, 50)
    assert_same(ready, times)
    march = march_along(ready, times)
    sun, carrier = (march.q[:, 3 * ready.packed.body_names.index(name) + 2] for name in ("sun", "carrier"))
    assert np.abs(carrier - carrier[0] - (sun - sun[0]) * 18 / (18 + 66)).max() < 1e-12


def test_planets_that_do_not_fit_are_refused() -> None:
    """Where teeth are given by radii that disagree, the second gear contradicts the first."""
    m = planetary((18, 24), 1)
    arm = m.bodies["carrier"]
    planet = m.body("odd")
    m.revolute("P odd", arm.at(0.0, 0.042), planet.origin)
    m.gear_pair("sun odd", m.bodies["sun"].origin, planet.origin, radius_i=0.018, radius_j=0.024)
    m.gear_pair("ring odd", m.ground.at(0, 0), planet.origin, radius_i=0.0661, radius_j=0.024, internal=True)
    m.start_near(odd=0)
    with pytest.raises(MechanismError):
        m.sweep(1.0)


def test_a_gear_off_its_pin_is_no_train() -> None:
    """An eccentric wheel turns by no constant ratio: its angle comes by Newton-Raphson."""
    m = Mechanism("eccentric")
    wheel = m.body("wheel")
    bar = crank(m)
    m.revolute("W", m.ground.at(0.5, 0), wheel.origin)
    m.gear_pair("gear", bar.start, wheel.at(0.01, 0.0), radius_i=0.2, radius_j=0.3)
    m.start_near(wheel=90)  # where they mesh
    ready = prepare(m, 0.0, 1.0)
    assert "Newton-Raphson wheel" in ready.route
    assert_same(ready, np.linspace(0.0, 1.0, 101))


def test_a_centre_that_is_at_a_pin_by_chance_is_no_train() -> None:
    """The slider stands where the sun's centre is at the start alone."""
    m = Mechanism("chance")
    bar, wheel, block = crank(m), m.body("wheel"), m.body("block")
    link = m.bar("link", 0.4)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), block.origin)
    m.drive_coordinate("lift", m.ground.at(0, 0, math.pi / 2), block.origin, constant_rate(0.1))
    m.revolute("L", block.origin, link.start)
    m.revolute("W", link.end, wheel.origin)
    m.pin_in_slot("slot", m.ground.at(0, 0), link.end)
    m.gear_pair("gear", bar.start, wheel.origin, radius_i=0.2, radius_j=0.2)
    m.start_near(wheel=0, link=0, block=0)
    ready = prepare(m, 0.0, 1.0)
    assert "train wheel" not in ready.route


def test_one_wheel_many_turns_a_step() -> None:
    """A pinion of 40 turns a turn, seen five times a turn, carries a crank-rocker: no turn of it is lost."""
    m = Mechanism("fast")
    bar, wheel = crank(m), m.body("wheel")
    m.revolute("W", m.ground.at(1.025, 0), wheel.origin)
    m.gear_pair("gear", bar.start, wheel.origin, radius_i=1.0, radius_j=0.025)
    coupler, rocker = m.bar("coupler", 0.35), m.bar("rocker", 0.30)
    m.revolute("A", wheel.at(0.1, 0), coupler.start)
    m.revolute("B", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(1.425, 0), rocker.start)
    m.start_near(wheel=0, coupler=50, rocker=90)
    ready = prepare(m, 0.0, 2.0)
    few, many = np.linspace(0.0, 2.0, 11), np.linspace(0.0, 2.0, 10_001)
    march = march_along(ready, few)
    assert march.closed
    assert np.abs(march.q - march_along(ready, many).q[::1000]).max() < 1e-10


def test_an_arm_that_cannot_follow_ends_as_before() -> None:
    """An arm that is out of its crank's reach: both routes say so in the same words."""
    m = Mechanism("rope")
    bar, arm = crank(m, 0.3), m.bar("arm", 0.2)
    m.revolute("P", m.ground.at(0.5, 0), arm.start)
    m.constraint("rope", bar.end, arm.end, lambda x, y, a: (x * x + y * y) ** 0.5 - 0.35 - 0.01 * np.sin(a))
    m.start_near(arm=120)
    ready = prepare(m, 0.0, 1.0)
    times = np.linspace(0.0, 1.0, 101)
    errors = []
    for route in (ready, dataclasses.replace(ready, groups=None)):
        with pytest.raises(MechanismError) as caught:
            march_along(route, times)
        errors.append(str(caught.value))
    assert errors[0] == errors[1]


def test_exceptions_of_a_users_relation_come_out() -> None:
    """A function that fails in the middle of a sweep stops it with its own words."""

    def half(x: float, y: float, a: float) -> float:
        if -math.atan2(y, x) > 0.8:
            raise ValueError("too far")
        return a - 0.5 * math.atan2(y, x)

    m = Mechanism("fails")
    bar, other = crank(m), m.body("other")
    m.revolute("P", m.ground.at(0.5, 0), other.origin)
    m.constraint("half", bar.start, other.origin, half)
    m.start_near(other=0)
    ready = prepare(m, 0.0, 1.0)
    assert "Newton-Raphson other" in ready.route
    assert_same(ready, np.linspace(0.0, 0.13, 14))
    with pytest.raises(MechanismError, match="too far"):
        march_along(ready, np.linspace(0.0, 1.0, 101))
