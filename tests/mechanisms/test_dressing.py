"""What a machine works on is in its parts, and weighs nothing."""

from __future__ import annotations

import cadquery as cq
import pytest

from mechanisms.stages.parts.bodies import described_body
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.workpieces import CUP, TEA, block, crate, pen, prism, sheet, standing
from shared.stage.errors import UserError


def bar() -> Solid:
    return Solid("bar", cq.Workplane().box(60.0, 10.0, 5.0), "steel", 0)


def load() -> Solid:
    return Solid("load", block((0.0, 5.1, 20.0, 40.0), 0.0, 12.0), "steel", 0)


def test_a_load_is_a_piece_of_no_mass() -> None:
    plain, made = Bodies(arm=[bar()]), Bodies(arm=[bar()])
    made.dress("arm", load())
    alone, dressed = (described_body("m", "arm", bodies["arm"], {}, None) for bodies in (plain, made))
    assert dressed.mass == alone.mass
    assert dressed.pieces["load"].dressing
    assert not dressed.pieces["bar"].dressing
    assert dressed.pieces["load"].mass.mass > 0.05  # it is there: it is printed and listed with its own mass
    appended = described_body("m", "arm", [bar(), load()], {}, None)
    assert appended.mass.mass == pytest.approx(alone.mass.mass + dressed.pieces["load"].mass.mass)


def test_what_is_said_survives_a_union() -> None:
    made = Bodies(arm=[bar()])
    made.dress("arm", load())
    assert [solid.dressing for solid in (made | {"ground": [bar()]})["arm"]] == [False, True]


def test_a_load_is_no_main_piece() -> None:
    with pytest.raises(UserError, match=r"dress\('leg'\).*arm"):
        Bodies(arm=[bar()]).dress("leg", load())


def test_workpieces_are_sound() -> None:
    shapes = [
        ("block", block((0, 0, 30, 20), 0.0, 9.0), 0),
        ("crate", crate((0, 0, 120, 90), 1.0, 50.0), 0),
        ("sheet", sheet((0, 0, 80, 60), 0.0), 0),
        ("pen", pen(0.4, 20.0, 3.0), 0),
        ("prism", prism([(0, 0), (10, 0), (4, 8)], 0.0, 6.0, 0.5), 0),
        ("cup", standing(CUP, 5.0, 6.0, 30.0, 12.0), 0),
        ("tea", standing(TEA, 5.0, 6.0, 30.0, 12.0), 0),
    ]
    solids = [Solid(name, shape, "steel", holes) for name, shape, holes in shapes]
    described = described_body("m", "all", solids, {}, None)  # refuses what is not one closed solid of so many holes
    assert set(described.pieces) == {name for name, _, _ in shapes}


def test_a_cup_stands_up_in_the_plane_with_tea_inside() -> None:
    cup, tea = (standing(profile, 5.0, 6.0, 30.0, 12.0).val() for profile in (CUP, TEA))
    box = cup.BoundingBox()
    assert (box.ymin, box.ymax) == pytest.approx((6.0, 24.0), abs=1e-3)
    assert ((box.xmin + box.xmax) / 2, (box.zmin + box.zmax) / 2) == pytest.approx((5.0, 30.0), abs=1e-2)
    assert cup.intersect(tea).Volume() == pytest.approx(0.0, abs=1e-6)
