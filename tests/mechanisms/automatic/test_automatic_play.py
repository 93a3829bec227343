"""Pins and gears with play as solids: bushings bored wider by what the journal moves, teeth with their backlash."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.wheels.wheels import Wheel
from shared.stage.errors import UserError


def loose_crank(clearance: float, **joint: Any) -> Mechanism:
    """A slider-crank with play at the slider's pin."""
    m = Mechanism("loose_crank", gravity=None)
    crank, rod = m.bar("crank", 0.05, mass=0.3), m.bar("rod", 0.12, mass=0.2)
    slider = m.body("slider", mass=0.1, inertia=1e-4)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.clearance_joint("B", rod.end, slider.origin, clearance, 0.01, **({"stiffness": 1e9} | joint))
    m.drive_angle("motor", crank, constant_rate(20.0))
    m.start_near(crank=40, rod=-15)
    return m


def made(m: Mechanism, duration: float = math.pi / 10) -> Automatic:
    return Automatic(m, m.simulate(duration, 200, event_rows=True))


def test_a_pin_with_play_has_bushings_bored_as_much_wider() -> None:
    m = loose_crank(0.5e-3)
    parts = made(m)
    [pin] = [feature for feature in parts.layout.features if isinstance(feature, Pin) and feature.play]
    moved = -m.simulate(math.pi / 10, 200, event_rows=True).force("B").gap.min() + 0.5e-3
    assert pin.name == "B"
    assert 1e3 * moved <= pin.play * parts.sizes.scale < 1.05e3 * moved  # it sees more poses than the outputs
    pieces = {piece.name: piece for body in parts.solids(engraved_too=False).values() for piece in body}
    plain = parts.sizes.pivot.bored()
    for name, bored in (("A", plain), ("B", plain + 2.0 * pin.play)):
        edges = pieces[f"bushing_{name}_low"].shape.edges("%CIRCLE").vals()
        assert 2.0 * min(edge.radius() for edge in edges) == pytest.approx(bored * parts.sizes.scale, abs=1e-6)


def test_too_much_play_and_a_shared_place_are_refused() -> None:
    with pytest.raises(UserError, match=r"clearance joint 'B' moves .* mm to a side, and bushings of"):
        _ = made(loose_crank(4e-3)).layout
    m = loose_crank(0.5e-3)
    extra = m.bar("extra", 0.1, mass=0.1)
    m.revolute("C", m.bodies["slider"].origin, extra.start)
    with pytest.raises(UserError, match="'B' and 'C' are at one place of 'slider'"):
        _ = made(m).layout


def test_teeth_of_gears_with_play_have_their_backlash() -> None:
    def gears(backlash: float) -> list[Wheel]:
        m = Mechanism("gears", gravity=None)
        a, b = m.body("a", mass=1.0, inertia=2e-3), m.body("b", mass=1.0, inertia=1e-3)
        m.revolute("A", m.ground.at(0, 0), a.origin)
        m.revolute("B", m.ground.at(0.09, 0), b.origin)
        m.gear_mesh("mesh", a.origin, b.origin, 1e7, teeth=(40, 20), module=3e-3, backlash=backlash)
        m.start_moving(a=5.0)
        parts = made(m)
        wheels = [feature for feature in parts.layout.features if isinstance(feature, Wheel)]
        for wheel in wheels:
            wheel.play *= parts.sizes.scale
        return wheels

    tight, loose = gears(0.0), gears(0.4e-3)
    assert sorted(wheel.teeth for wheel in loose) == [20, 40]
    assert [wheel.play for wheel in loose] == pytest.approx([wheel.play + 0.4 for wheel in tight], abs=1e-9)
    assert np.isfinite([wheel.phase for wheel in loose]).all()
