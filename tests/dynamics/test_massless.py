"""Bodies without mass and inertia: held by others they move as these do; loose they are refused by name."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from mbsd import Mechanism, MobilityError, constant_rate


def on_a_pin() -> Mechanism:
    m = Mechanism("m")
    m.revolute("A", m.ground.origin, m.bar("rod", 0.5).start)
    return m


def free() -> Mechanism:
    m = Mechanism("m")
    m.body("rod")
    return m


def beside_a_heavy_one() -> Mechanism:
    m = on_a_pin()
    m.revolute("B", m.ground.at(1, 0), m.bar("heavy", 0.5, 1.0).start)
    return m


def at_a_point_mass() -> Mechanism:
    m = Mechanism("m")
    ball = m.body("ball", 1.0)
    m.revolute("A", ball.origin, m.bar("rod", 0.5).start)
    return m


def spring_between() -> Mechanism:
    """At rest at first, so that no load shows it."""
    m = Mechanism("m", gravity=None)
    rod = m.body("rod")
    m.prismatic("guide", m.ground.origin, rod.origin)
    m.spring("spring", m.ground.origin, rod.at(0.1, 0.0), 10.0, free_length=0.1)
    m.start_near(rod=(0, 0, 0))
    return m


@pytest.mark.parametrize("make", [on_a_pin, free, beside_a_heavy_one, at_a_point_mass, spring_between])
@pytest.mark.parametrize("formulation", ["auto", "reference"])
def test_a_loose_one_is_refused(make: Callable[[], Mechanism], formulation: str) -> None:
    with pytest.raises(
        MobilityError, match=r"m: 'rod' has neither mass nor inertia, .* m\.change\('rod', mass=\.\.\.\)"
    ):
        make().simulate(0.1, steps=2, formulation=formulation)
    with pytest.raises(MobilityError, match="'rod'"):
        make().linearise(at="start")
    m = make()
    m.change("rod", mass=1.0, inertia=0.1)
    m.simulate(0.1, steps=2)


def carried() -> Mechanism:
    """A rod without mass between the ground and a point mass."""
    m = on_a_pin()
    m.revolute("B", m.bodies["rod"].end, m.body("ball", 1.0).origin)
    return m


def driven() -> Mechanism:
    m = on_a_pin()
    m.drive_angle("motor", m.bodies["rod"], constant_rate(2.0))
    return m


def a_point_mass() -> Mechanism:
    m = Mechanism("m")
    m.body("ball", 1.0)
    return m


def held() -> Mechanism:
    m = a_point_mass()
    m.weld("W", m.ground.origin, m.bar("rod", 0.5).start)
    return m


@pytest.mark.parametrize("make", [carried, driven, a_point_mass, held])
def test_others_move(make: Callable[[], Mechanism]) -> None:
    make().simulate(0.1, steps=2)
