"""Rams: bodies that slide on ground and are driven in several planes, as those of presses."""

from __future__ import annotations

import math
import re

import pytest

from mbsd import Mechanism
from mechanisms.stages.automatic.automatic import Automatic
from shared.stage.errors import UserError
from tests.mechanisms.automatic.shafts.proofs import checked
from tools.models.shaft_machines import press


def refusal(m: Mechanism) -> str:
    with pytest.raises(UserError) as told:
        Automatic(m, m.sweep(steps=90)).solids()
    return str(told.value)


def test_a_press_is_built_and_nothing_touches() -> None:
    _, bodies = checked(press())
    on_ground = [solid.name for solid in bodies["ground"]]
    assert [name for name in on_ground if "ram" in name] == ["column_ram_1", "column_ram_2", "deck_ram"]
    assert [solid.name for solid in bodies["ram"]] == ["ram", "pin_ram", "pin_ram_2"]
    beam = bodies["ram"][0].shape.val().BoundingBox()
    for k, z in ((1, -30.0), (2, 30.0)):
        rod = bodies[f"rod_{k}"][0].shape.val().BoundingBox()
        assert (rod.zmin + rod.zmax) / 2 == pytest.approx(z, abs=1e-6)
        assert beam.zmin < rod.zmin < rod.zmax < beam.zmax
    assert (beam.zmin + beam.zmax) / 2 == pytest.approx(0.0, abs=1e-6)


def test_the_columns_hold_the_ram_at_its_nearest_and_at_its_farthest_place() -> None:
    m = press()
    solution = m.sweep(steps=90)
    along = Automatic(m, solution).along
    assert along is not None
    plan = along.rams["ram"]
    y = -1000 * solution.body("ram").y
    assert plan.ram.farthest - plan.ram.nearest == pytest.approx(80.0, abs=1e-2)
    assert plan.begin < y.min() + plan.low, "it begins before the beam"
    assert plan.deck[0] > y.max() + plan.high, "the deck is beyond the beam"


@pytest.mark.parametrize(
    ("places", "given"),
    [((-0.03, 0.03), {"rod_z": False}), ((-0.04, 0.0, 0.04), {"ram_z": 0.0}), ((-0.01, 0.01), {"rod_z": False})],
)
@pytest.mark.slow
def test_places_may_be_told_by_the_shaft_and_rods_stand_side_by_side(places: tuple, given: dict) -> None:
    _, bodies = checked(press(places, **given))
    for k, z in enumerate(places, start=1):
        rod = bodies[f"rod_{k}"][0].shape.val().BoundingBox()
        assert (rod.zmin + rod.zmax) / 2 == pytest.approx(1000 * z, abs=1e-6)
    pins = [solid for solid in bodies["ram"] if solid.name.startswith("pin")]
    assert len(pins) == (1 if places == (-0.01, 0.01) else len(places)), "cheeks that touch share a pin"


def with_rocker(link: float) -> Mechanism:
    """The ram moves a rocker, too, by a link in this direction (degrees)."""
    m = press((-0.03,))
    rod, rocker = m.bar("link", 0.12, z=0.03), m.bar("rocker", 0.16, z=0.06)
    m.revolute("eye", m.bodies["ram"].at(0.0, 0.03), rod.start)
    m.revolute("knee", rod.end, rocker.start)
    x, y = 0.03 + 0.12 * math.cos(math.radians(link)), -0.24 + 0.12 * math.sin(math.radians(link))
    side = math.copysign(1.0, link)
    m.revolute("post", m.ground.at(x + side * 0.16, y), rocker.end)
    m.start_near(link=link, rocker=0 if side > 0 else 180)
    return m


def test_a_ram_may_move_a_rocker_beside_it() -> None:
    _, bodies = checked(with_rocker(50))
    assert [solid.name for solid in bodies["ram"]] == ["ram", "pin_ram", "pin_ram_2"]


def test_a_link_that_goes_where_the_beam_is_is_named() -> None:
    said = refusal(with_rocker(-50))
    assert re.search(r"'link' and the (beam|deck) of 'ram' meet at t=", said)


def test_rods_without_room_for_a_cheek_are_named() -> None:
    said = refusal(press((-0.006, 0.006)))
    assert "'rod_1' and 'rod_2' drive 'ram' 12 mm apart along z" in said
    assert "the cheek between them needs" in said


def test_what_drives_a_ram_must_be_links() -> None:
    m = press((-0.03,))
    other = m.body("other", z=0.03)
    m.revolute("turns", m.bodies["ram"].at(0.0, 0.0), other.origin)
    m.prismatic("across", m.ground.at(0.0, 0.0, -math.pi / 2), other.origin)
    assert "'other' in 'turns' is no link" in refusal(m)
