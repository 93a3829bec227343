"""Outlines as automatic parts: plates that carry each other, and posts of ground."""

from __future__ import annotations

import pytest

from mbsd import Mechanism, circle, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.outlines import OutlineSolid
from shared.stage.errors import UserError


def knocker(hole: bool = False) -> Mechanism:
    """A driven arm whose hammer, an outline at the end of its shaft, passes a round post of ground."""
    m = Mechanism("knocker")
    arm = m.body("arm")
    m.revolute("O", m.ground.at(0, 0), arm.origin)
    m.drive_angle("motor", arm, constant_rate(1.0))
    m.outline(arm, [(-0.015, -0.015), (0.06, -0.01), (0.06, 0.01), (-0.015, 0.015)], name="shaft")
    m.outline(arm, [(0.05, -0.02), (0.07, -0.02), (0.07, 0.02), (0.05, 0.02)], name="hammer")
    m.outline("ground", circle(0.008, (0.09, 0)), name="post")
    if hole:
        m.outline(arm, circle(0.004, (0.06, 0)), hole=True, name="eye")
    m.outline_contact("knock", "hammer", "post")
    return m


def test_what_overlaps_a_held_outline_needs_no_arm_and_posts_stand_on_the_base() -> None:
    m = knocker()
    made = Automatic(m, m.sweep(steps=24))
    solids = {solid.outline.name: solid for solid in made.layout.select(OutlineSolid)}
    assert solids["shaft"].is_held
    assert solids["hammer"].is_held
    assert not [anchor for name in ("shaft", "hammer") for anchor in solids[name].anchors(made.layout)]
    bodies = made.solids(engraved_too=False)
    [plate] = [solid for solid in bodies["arm"] if solid.name == "arm"]
    [post] = [solid for solid in bodies["ground"] if "post" in solid.name]
    boxes = [solid.shape.val().BoundingBox() for solid in (plate, post)]
    assert 39.0 < boxes[0].ylen < 40.0, "set back by half a clearance all round"
    assert 15.0 < boxes[1].xlen < 16.0
    assert boxes[1].zmin < boxes[0].zmin < boxes[1].zmax
    assert boxes[1].zmax == pytest.approx(boxes[0].zmax, abs=1e-6)
    assert boxes[1].center.x == pytest.approx(90.0)


def test_holes_are_refused() -> None:
    m = knocker(hole=True)
    with pytest.raises(UserError, match=r"'eye' is a hole.*parts"):
        _ = Automatic(m, m.sweep(steps=24)).layout
