"""A pin that runs in several slots at once: one pin with a roller in each."""

from __future__ import annotations

import math
from collections.abc import Callable
from math import pi, sin

import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from shared.stage.errors import UserError
from tests.mechanisms.automatic.layouts import meets
from tests.shared.shape_checks import checked


def sine_and_cosine(turn: float) -> Mechanism:
    """Two Scotch yokes at right angles on one crank pin."""
    m = Mechanism("sine_and_cosine")
    crank = m.bar("crank", 0.05)
    m.revolute("O", m.ground.origin, crank.start)
    for name, angle in (("cosine", turn), ("sine", turn + pi / 2)):
        yoke = m.body(name)
        m.pin_in_slot(f"slot_{name}", yoke.at(0, 0, pi / 2), crank.end)
        m.prismatic(f"guide_{name}", m.ground.at(0, 0, angle), yoke.at(0.14, 0))
        m.start_near(**{name: (0.03 * math.cos(angle), 0.03 * math.sin(angle), math.degrees(angle))})
    m.drive_angle("motor", crank, constant_rate(1.0, turn + 0.5))
    return m


def two_levers(turn: float) -> Mechanism:
    """Two levers swing about pivots on ground, and one crank pin runs in both."""
    m = Mechanism("two_levers")
    crank = m.bar("crank", 0.05)
    m.revolute("O", m.ground.origin, crank.start)
    for name, angle in (("first", turn), ("second", turn + pi / 2)):
        lever = m.bar(name, 0.2)
        m.revolute(f"P_{name}", m.ground.at(-0.1 * math.cos(angle), -0.1 * math.sin(angle)), lever.start)
        m.pin_in_slot(f"slot_{name}", lever.start, crank.end)
        m.start_near(**{name: math.degrees(angle)})
    m.drive_angle("motor", crank, constant_rate(1.0, turn))
    return m


def two_genevas(turn: float) -> Mechanism:
    """A crank pin indexes a wheel on its right and one on its left."""
    m = Mechanism("two_genevas")
    crank = m.body("crank")
    m.revolute("O", m.ground.origin, crank.origin)
    for name, side in (("right", turn), ("left", turn + pi)):
        wheel = m.body(name)
        m.revolute(f"W_{name}", m.ground.at(0.08 * math.cos(side), 0.08 * math.sin(side)), wheel.origin)
        m.geneva(f"index_{name}", crank.origin, wheel.origin, slots=4, radius=0.08 * sin(pi / 4))
        m.start_near(**{name: math.degrees(turn) + 45})
    m.drive_angle("motor", crank, constant_rate(1.0, turn))
    return m


@pytest.mark.parametrize("turn", [0.0, 0.9])
@pytest.mark.parametrize("build", [sine_and_cosine, two_levers, two_genevas])
def test_one_pin_with_a_roller_in_each_slot(build: Callable[[float], Mechanism], turn: float) -> None:
    m = build(turn)
    made = Automatic(m, m.sweep(2 * pi, steps=180))
    assert not meets(made)
    plan = made.plan()
    here = plan.solids["crank"]
    pins = [solid for solid in here if solid.name.startswith("pin_")]
    assert len(pins) == 1
    assert sum(solid.name.startswith("roller_") for solid in here) == 2
    box = pins[0].shape.val().BoundingBox()
    for body in made.levels:
        low, high = made.heights.bottom(body), made.heights.top(body)
        assert box.zmin < low + 0.5
        assert box.zmax > high - 0.5
    for solid in here:
        checked(solid.shape, solid.through_holes)
    [crank] = [solid for solid in made.solids(engraved_too=False)["crank"] if solid.name == "crank"]
    checked(crank.shape, crank.through_holes)


def test_pin_of_a_slot_where_a_rod_has_its_pin_is_refused() -> None:
    m = sine_and_cosine(0.0)
    rod, block = m.bar("rod", 0.2), m.body("block")
    m.revolute("A", m.bodies["crank"].at(0.05, 0), rod.start)
    m.revolute("B", rod.end, block.origin)
    m.prismatic("way", m.ground.at(0, 0, pi), block.at(0, 0, pi))
    m.start_near(rod=180, block=(-0.16, 0, 0))
    with pytest.raises(UserError, match="pin of joint 'slot_cosine' is where crank has that of joint 'A'"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).layout
