"""Closed forms of Assur groups against Newton-Raphson: every group, both ways round, chains of them, and doubts."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mbsd import Marker, Mechanism, MechanismError, constant_rate, function
from mbsd.kinematics.groups.carried import SIGN
from mbsd.kinematics.groups.groups import FIRST, K1, K2, NUMBERS
from mbsd.kinematics.groups.tables import KINDS, NAMES
from mbsd.kinematics.march import march_along
from mbsd.kinematics.prepared import Prepared, prepare
from tools.models.assur_models import MODELS, crank


def both_routes(m: Mechanism, duration: float = 1.05, steps: int = 240) -> tuple[Prepared, list, list]:
    """The closed form's positions, velocities and accelerations, and those of Newton-Raphson."""
    times = np.linspace(0.0, duration, steps + 1)
    ready = prepare(m, 0.0, duration)
    assert ready.groups is not None
    assert march_along(ready, times).closed
    return ready, motion_of(ready, times), motion_of(dataclasses.replace(ready, groups=None), times)


def motion_of(ready: Prepared, times: np.ndarray) -> list[np.ndarray]:
    """Positions, velocities and accelerations."""
    march = march_along(ready, times)
    return [march.q, march.v, march.a]


@pytest.mark.parametrize("name", MODELS)
def test_closed_forms_are_what_newton_finds(name: str) -> None:
    ready, closed, newton = both_routes(MODELS[name]())
    assert name.split()[0].removeprefix("welded") in ready.route
    assert np.abs(closed[0] - newton[0]).max() < 1e-12
    for direct, iterated in zip(closed[1:], newton[1:], strict=True):
        assert np.abs(direct - iterated).max() < 1e-11 * max(1.0, np.abs(iterated).max())


def test_every_group_is_tried() -> None:
    tried = " ".join(prepare(model(), 0.0, 1.0).route for model in MODELS.values())
    assert all(name in tried for name in NAMES)


@pytest.mark.parametrize("code", range(len(KINDS)))
def test_a_group_is_registered_under_its_code_and_fits_its_tables(code: int) -> None:
    kind = KINDS[code]
    assert kind.code == code
    assert bool(kind.one) == bool(kind.of_one)
    assert bool(kind.two) == bool(kind.of_two)
    assert len(kind.row(1.0 + 0.1 * np.arange(NUMBERS))) <= SIGN
    assert all(column < NUMBERS and leader in (FIRST, K1, K2) for _, column, leader in kind.follows)
    assert 0 <= kind.watched <= 1 + bool(kind.two)


def _add_group(m: Mechanism, k: int, kind: str, reach: Marker, random: np.random.Generator) -> Marker:
    """Hang one group between ``reach`` and ground; returns a point of it that moves."""
    x, y = 0.6 + 0.1 * k + random.uniform(-0.05, 0.05), random.uniform(-0.1, 0.1)
    long = m.bar(f"a{k}", random.uniform(0.6, 0.75), 1.0, com=(random.uniform(0, 0.3), 0.02), inertia=0.1)
    if kind == "RRR":
        other = m.bar(f"b{k}", random.uniform(0.5, 0.65), 1.0)
        m.revolute(f"A{k}", reach, long.start)
        m.revolute(f"B{k}", long.end, other.end)
        m.revolute(f"C{k}", m.ground.at(x, y), other.start)
        m.start_near(**{f"a{k}": 60.0, f"b{k}": 120.0})
        return other.at(0.15, 0.02)
    if kind == "RRP":
        block = m.body(f"b{k}", 1.0, com=(0.01, 0.02), inertia=0.1)
        m.revolute(f"A{k}", reach, long.start)
        m.revolute(f"B{k}", long.end, block.at(0.02, 0.01))
        m.prismatic(f"C{k}", m.ground.at(0, y - 0.05, 0.2), block.at(0, 0.01, 0.1))
        m.start_near(**{f"a{k}": 0.0})
        return block.at(0.05, 0.02)
    if kind == "RPR":
        block = m.body(f"b{k}", 1.0, com=(0.01, 0.02), inertia=0.1)
        m.revolute(f"A{k}", reach, block.at(0.01, 0.0))
        m.prismatic(f"B{k}", long.at(0.1, 0.02, 0.1), block.at(0.0, 0.01, 0.2))
        m.revolute(f"C{k}", m.ground.at(x, y), long.start)
        return long.at(0.2, 0.02)
    if kind == "rod":
        m.distance(f"A{k}", reach, long.at(0.45, 0.05), random.uniform(0.6, 0.7))
        m.revolute(f"C{k}", m.ground.at(x, y), long.start)
        m.start_near(**{f"a{k}": 100.0})
        return long.at(0.15, 0.02)
    m.prismatic(f"C{k}", m.ground.at(0, y - 0.05, 0.2), long.at(0, 0.01, 0.1))  # yoke
    m.pin_in_slot(f"A{k}", long.at(0.1, 0.0, 1.4), reach)
    return long.at(0.1, 0.02)


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    kinds=st.lists(st.sampled_from(["RRR", "RRP", "RPR", "rod", "yoke"]), min_size=1, max_size=4),
)
def test_random_chains_of_all_groups(seed: int, kinds: list[str]) -> None:
    """Where both routes solve the motion they agree to the conditioning of the pose; else they give the same error."""
    random = np.random.default_rng(seed)
    m = Mechanism("chain")
    reach = crank(m, 0.1).end
    for k, kind in enumerate(kinds):
        reach = _add_group(m, k, kind, reach, random)
    times = np.linspace(0.0, 1.05, 241)
    try:
        ready = prepare(m, 0.0, 1.05)
    except MechanismError:
        assume(False)
        raise
    assert ready.groups is not None
    for kind in kinds:
        assert kind in ready.route
    outcomes = []
    for route in (ready, dataclasses.replace(ready, groups=None)):
        try:
            outcomes.append(motion_of(route, times))
        except MechanismError as error:
            outcomes.append(str(error))
    if isinstance(outcomes[1], str):
        assert outcomes[0] == outcomes[1]
        return
    scale = max(1.0, float(np.abs(outcomes[1][1]).max()))
    assert np.abs(outcomes[0][0] - outcomes[1][0]).max() < 1e-12 * scale
    for direct, iterated in zip(outcomes[0][1:], outcomes[1][1:], strict=True):
        assert np.abs(direct - iterated).max() < 1e-10 * max(1.0, np.abs(iterated).max()) * scale


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
        march_along(ready, np.linspace(0.0, 1.0, 361))
    assert str(closed.value) == str(newton.value)


def driven_elbow() -> Mechanism:
    """A four-bar whose coupler's angle against its crank is driven: three bodies that are rigid only together."""
    m = Mechanism("elbow")
    bars = [m.bar(name, length, 1.0) for name, length in (("crank", 0.1), ("coupler", 0.38), ("rocker", 0.3))]
    m.revolute("O", m.ground.at(0, 0), bars[0].start)
    m.revolute("A", bars[0].end, bars[1].start)
    m.revolute("B", bars[1].end, bars[2].end)
    m.revolute("C", m.ground.at(0.4, 0), bars[2].start)
    m.drive_relative_angle("motor", bars[0], bars[1], constant_rate(0.5, 1.0))
    m.start_near(crank=0, coupler=57, rocker=90)
    return m


def test_three_bodies_that_only_together_are_rigid_are_solved_by_newton() -> None:
    assert driven_elbow().sweep(0.5).route == "Newton-Raphson"


@pytest.mark.parametrize("name", ["driven carried", "yoke", "driven slide", "rod driven"])
def test_a_law_that_jumps_is_refused_by_both_routes(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The check of laws before the march is left out: it finds this jump first."""
    monkeypatch.setattr("mbsd.kinematics.prepared.refuse_bad_laws", lambda *_: None)
    m = MODELS[name]()
    driver = next(iter(m.drivers.values()))
    law = driver.motion
    assert law is not None
    value = law(np.array([0.4]))[0, 0]
    jump = function(lambda t: value + (0.05 if t > 0.51 else 0.0), lambda t: 0.0, lambda t: 0.0)
    m.drivers[driver.name] = dataclasses.replace(driver, motion=jump)
    ready = prepare(m, 0.0, 1.0)
    assert ready.groups is not None
    messages = []
    for route in (ready, dataclasses.replace(ready, groups=None)):
        with pytest.raises(MechanismError) as error:
            march_along(route, np.linspace(0.0, 1.0, 41))
        messages.append(str(error.value))
    assert messages[0] == messages[1]


def test_slides_that_become_parallel_are_left_to_newton() -> None:
    """A guide on the lever that comes to lie along the slot of ground: the block runs away."""
    m = Mechanism("runaway")
    lever, block = m.bar("lever", 0.2, 1.0), m.body("block", 1.0, inertia=0.1)
    m.revolute("O", m.ground.at(0, 0), lever.start)
    m.drive_angle("motor", lever, constant_rate(1.0))
    m.prismatic("guide", lever.start, block.origin)
    m.pin_in_slot("slot", m.ground.at(0.3, 0, math.pi / 2), block.origin)
    ready = prepare(m, 0.0, 2.0)
    assert "PRP" in ready.route
    with pytest.raises(MechanismError) as closed:
        march_along(ready, np.linspace(0.0, 2.0, 201))
    with pytest.raises(MechanismError) as newton:
        march_along(dataclasses.replace(ready, groups=None), np.linspace(0.0, 2.0, 201))
    assert str(closed.value) == str(newton.value)
