"""Gears, racks and belts that cannot be as they stand at the start are refused, with numbers and a remedy."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from mbsd import AssemblyError, Mechanism, ModelError, constant_rate
from mbsd.saving.document import build, document


def pair(distance: float, way: float = 0.4, **given: object) -> Mechanism:
    """Two gears, or pulleys, on ground."""
    m = Mechanism("train")
    first, second = m.body("first", 1.0, inertia=1e-3), m.body("second", 1.0, inertia=1e-3)
    m.revolute("A", m.ground.at(0.2, 0.1), first.origin)
    m.revolute("B", m.ground.at(0.2 + distance * math.cos(way), 0.1 + distance * math.sin(way)), second.origin)
    add = m.belt if "crossed" in given else m.gear_pair
    add("mesh", first.origin, second.origin, **given)  # pyright: ignore[reportArgumentType]
    m.drive_angle("motor", first, constant_rate(3.0))
    return m


def rack(height: float, turned: float = 0.0, radius: float = 0.02) -> Mechanism:
    m = Mechanism("rack")
    bar, pinion = m.body("bar", 1.0), m.body("pinion", 1.0, inertia=1e-4)
    m.prismatic("guide", m.ground.origin, bar.origin)
    m.revolute("shaft", m.ground.at(0.1, height), pinion.origin)
    m.rack_and_pinion("teeth", bar.at(0.0, 0.0, turned), pinion.origin, radius=radius)
    m.drive_angle("motor", pinion, constant_rate(3.0))
    m.start_near(bar=(0, 0, 0))
    return m


def planetary(reach: float) -> Mechanism:
    m = Mechanism("planetary")
    arm, planet = m.bar("arm", reach, 1.0), m.body("planet", 1.0, inertia=1e-4)
    m.revolute("A", m.ground.origin, arm.start)
    m.revolute("B", arm.end, planet.origin)
    m.gear_pair("outer", m.ground.origin, planet.origin, 0.08, 0.03, internal=True)
    m.drive_angle("motor", arm, constant_rate(3.0))
    return m


REFUSED: list[tuple[Callable[[], Mechanism], str]] = [
    (lambda: pair(0.12, radius_i=0.03, radius_j=0.06), r"'mesh': its centres are 0\.12 m apart, .* = 0\.09 m"),
    (lambda: pair(0.03, radius_i=0.06, radius_j=0.03), r"0\.06 \+ 0\.03 = 0\.09 m\..* internal=True"),
    (lambda: pair(0.03, radius_i=0.03, radius_j=0.06), r"internal=True, with the ring first"),
    (lambda: pair(0.09, radius_i=0.06, radius_j=0.03, internal=True), r"0\.06 - 0\.03 = 0\.03 m"),
    (lambda: pair(0.0902, radius_i=0.03, radius_j=0.06), r"radius_i=0\.0300667, radius_j=0\.0601333"),
    (lambda: pair(0.05, radius_i=0.03, radius_j=0.03, crossed=True), "strands cross only between pulleys"),
    (lambda: pair(0.02, radius_i=0.06, radius_j=0.03, crossed=False), r"neither is in the other: .* more than 0\.03 m"),
    (lambda: pair(0.02, teeth=(40, 20), pitch=0.01, crossed=False), r"more than 0\.0318"),
    (lambda: rack(-0.02), r"-0\.02 m above .* other side of the rack: turn the rack's marker by pi"),
    (lambda: rack(0.02, math.pi), "other side of the rack"),
    (lambda: rack(0.2), r"'teeth': the pinion's centre is 0\.2 m above the rack's x axis, .* its radius of 0\.02 m"),
    (lambda: planetary(0.06), r"'outer': its centres are 0\.06 m apart"),
]  # fmt: skip


@pytest.mark.parametrize(("make", "says"), REFUSED)
def test_wheels_that_cannot_mesh_are_refused_by_every_analysis(make: Callable[[], Mechanism], says: str) -> None:
    m = make()
    for solve in (m.sweep, lambda: m.simulate(0.1, steps=2), m.equilibrium, m.mobility):
        with pytest.raises(AssemblyError, match=says):
            solve()
    with pytest.raises(AssemblyError, match=says):
        build(document(m), Mechanism).sweep()


@pytest.mark.parametrize(
    "make",
    [
        lambda: pair(0.09, radius_i=0.03, radius_j=0.06),
        lambda: pair(0.09002, radius_i=0.03, radius_j=0.06),  # rounded by a person
        lambda: pair(0.03, radius_i=0.06, radius_j=0.03, internal=True),
        lambda: pair(0.061, radius_i=0.03, radius_j=0.03, crossed=True),
        lambda: pair(0.05, radius_i=0.06, radius_j=0.03, crossed=False),
        lambda: rack(0.02),
        lambda: rack(-0.02, math.pi),
        lambda: planetary(0.05),
    ],
)
def test_meshing_wheels_are_solved(make: Callable[[], Mechanism]) -> None:
    make().sweep(0.1, steps=2)


def test_a_change_that_parts_gears_is_refused_and_one_that_joins_them_is_not() -> None:
    m = pair(0.09, radius_i=0.03, radius_j=0.06)
    m.sweep(0.1, steps=2)
    m.change("mesh", radius_j=0.05)
    with pytest.raises(AssemblyError, match=r"0\.03 \+ 0\.05 = 0\.08"):
        m.sweep(0.1, steps=2)
    m.change("mesh", radius_i=0.04)
    m.sweep(0.1, steps=2)
    arm = planetary(0.05)
    arm.change("arm", length=0.055)
    with pytest.raises(AssemblyError, match=r"0\.055 m apart"):
        arm.sweep(0.1, steps=2)


def test_designs_of_a_batch_have_no_gears_that_could_part() -> None:
    m = planetary(0.05)
    with pytest.raises(ModelError, match="batch solves mechanisms of driven bodies and dyads"):
        m.batch(lengths={"arm": [0.05, 0.055]}, steps=4)
