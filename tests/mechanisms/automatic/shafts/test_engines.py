"""Engines by hand: a shaft, pistons in liners, each at its place, and nothing touches."""

from __future__ import annotations

import math

import pytest

from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from mechanisms.stages.clearance import slide
from shared.stage.errors import UserError
from tests.mechanisms.automatic.shafts.proofs import box, plan, proven
from tools.models.shaft_machines import INLINE_TWO, THROW, engine


def along_of(made: Automatic) -> Along:
    assert made.along is not None
    return made.along


@pytest.mark.slow
def test_an_inline_four_is_built() -> None:
    """That nothing touches is proven of mechanisms/inline_four."""
    made = plan("INLINE_FOUR")
    bodies = made.solids()
    names = {name: [solid.name for solid in solids] for name, solids in bodies.items()}
    assert names["crank"] == ["crank"], "one piece"
    assert names["rod_1"] == ["rod_1", "cap_rod_1"]
    assert names["piston_2"] == ["piston_2", *(f"ring_piston_2_{k}" for k in (1, 2, 3)), "wrist_pin_piston_2"]
    assert {"liner_piston_1", "head_piston_1", "bearing_1", "bearing_2", "cap_2", "cap_4", "bearing_5"} <= set(
        names["ground"]
    )
    for k, z in ((1, -150.0), (3, 50.0)):
        for body in (f"rod_{k}", f"piston_{k}"):
            bounds = box(bodies[body][0])
            assert (bounds.zmin + bounds.zmax) / 2 == pytest.approx(z, abs=1e-6)
            assert made.span(body) == pytest.approx((bounds.zmin, bounds.zmax), abs=0.1)
    shaft = box(bodies["crank"][0])
    assert made.span("crank") == pytest.approx((shaft.zmin, shaft.zmax), abs=0.1)
    assert shaft.ymax > 1000 * THROW


@pytest.mark.slow
def test_a_v_two_is_built_and_nothing_touches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its pistons are proven in their liners along their lines: the search over the motion takes minutes for that."""
    seen: list[tuple[float, float] | None] = []
    gap_of = slide.slide_gap

    def counted(*args) -> tuple[float, float] | None:
        seen.append(gap_of(*args))
        return seen[-1]

    monkeypatch.setattr(slide, "slide_gap", counted)
    made, bodies = proven("V_TWO")
    own = along_of(made)
    (shaft,) = own.shafts
    assert [pin.links for pin in shaft.pins] == [("rod_1", "rod_2")], "side by side on one pin"
    assert len(shaft.journals) == 2
    assert len([gap for gap in seen if gap and gap[0] < 0.25]) == 2 * 4, "four pieces of each piston in its liner"
    assert len(bodies["crank"]) == 1


def test_a_v_four_has_two_rods_on_each_of_two_pins() -> None:
    own = along_of(plan("V_FOUR"))
    own.refuse()
    (shaft,) = own.shafts
    assert [pin.links for pin in shaft.pins] == [("rod_1", "rod_2"), ("rod_3", "rod_4")]
    assert len(shaft.journals) == 3


def test_an_inline_four_gets_a_bearing_between_all_throws() -> None:
    own = along_of(plan("INLINE_FOUR"))
    own.refuse()
    (shaft,) = own.shafts
    assert [pin.links for pin in shaft.pins] == [(f"rod_{k}",) for k in (1, 2, 3, 4)]
    assert len(shaft.journals) == len(own.bearers[0].journals) == 5
    for name, cylinder in own.cylinders.items():
        assert cylinder.outer * 2 < 100.0, name


@pytest.mark.parametrize("of", ["SINGLE", "INLINE_TWO", "INLINE_FOUR", "V_TWO", "V_FOUR"])
def test_pistons_stay_in_their_liners_and_clear_of_the_shaft(of: str) -> None:
    own = along_of(plan(of))
    (shaft,) = own.shafts
    for cylinder in own.cylinders.values():
        assert cylinder.highest - cylinder.lowest == pytest.approx(2000 * THROW, rel=1e-5)
        assert cylinder.highest + cylinder.crown < cylinder.top
        assert cylinder.low < cylinder.lowest
        assert shaft.counterweight < min(cylinder.low, cylinder.lowest - cylinder.skirt)
        assert shaft.swept < cylinder.low


def test_gas_tells_the_bore() -> None:
    m = engine(INLINE_TWO)
    area = math.pi / 4 * 0.07**2
    m.gas("gas", m.ground.at(0, 0, math.pi / 2), m.bodies["piston_1"].origin, area=area, pressure=2e5, at=0.105)
    own = along_of(Automatic(m, m.sweep(steps=90)))
    assert own.cylinders["piston_1"].bore == pytest.approx(70.0)
    m = engine([(0, 90, -0.03), (0, 270, 0.03)])
    m.gas("gas", m.ground.at(0, 0, math.pi / 2), m.bodies["piston_1"].origin, area=area, pressure=2e5, at=0.105)
    with pytest.raises(UserError, match="'piston_1' and 'piston_2' are 60 mm apart along z"):
        along_of(Automatic(m, m.sweep(steps=90))).refuse()


def test_a_flywheel_is_put_on_a_shaft_alone() -> None:
    made = plan("SINGLE")
    before = made.span("crank")[0]
    made.flywheel("crank")
    assert made.span("crank")[0] < before
    own = along_of(made)
    own.refuse()
    (shaft,), (cylinder,) = own.shafts, own.cylinders.values()
    assert own.flywheel(shaft) > cylinder.low, "it would reach the liner,"
    assert shaft.ends[0] < cylinder.piston.z - own.fins["piston_1"], "but turns below it"
    assert all(math.hypot(x, y) > own.flywheel(shaft) for x, y in own.bearers[0].places)
    with pytest.raises(UserError, match="'rod_1' becomes no shaft"):
        made.flywheel("rod_1")


def test_layers_are_not_asked_for_where_bodies_have_places() -> None:
    with pytest.raises(UserError, match="layers follow the places z"):
        plan("SINGLE").layer("rod_1", 2)
