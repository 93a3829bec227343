"""Slides on ground that cross: a plate with grooves, and shuttles that pass each other in it; the trammel."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.slides.rails import Crossing
from mechanisms.stages.automatic.slides.slides import Slide
from mechanisms.trammel import mechanism as trammel
from shared.stage.errors import UserError
from tests.mechanisms.automatic.layouts import meets
from tools.hunt_parts.case import parts_of


def test_every_point_of_the_rod_draws_an_ellipse() -> None:
    """x = b cos a, y = (a + b) sin a of the pen b beyond the pins a apart, with both derivatives."""
    p = trammel.Params()
    m = trammel.build(p)
    m.trace("middle", m.bodies["rod"].at(p.pins / 2, 0))
    sol = m.sweep()
    angle, w, half = p.speed * sol.t, p.speed, (p.beyond, p.pins + p.beyond)
    pen, middle = sol.point("pen"), sol.point("middle")
    np.testing.assert_allclose(pen.x, half[0] * np.cos(angle), atol=1e-15)
    np.testing.assert_allclose(pen.y, half[1] * np.sin(angle), atol=1e-15)
    np.testing.assert_allclose(pen.vx, -half[0] * w * np.sin(angle), atol=1e-14)
    np.testing.assert_allclose(pen.ay, -half[1] * w**2 * np.sin(angle), atol=1e-13)
    np.testing.assert_allclose(np.hypot(middle.x, middle.y), p.pins / 2, rtol=1e-13)


def test_grooves_at_another_angle_draw_an_ellipse_too() -> None:
    """Its pen is an affine image of a circle: (x, y) = M (cos, sin)."""
    p = trammel.Params(angle=math.pi / 3)
    sol = trammel.build(p).sweep()
    pen, turn = sol.point("pen"), p.speed * sol.t
    circle = np.stack([np.cos(turn), np.sin(turn)])
    second = p.pins / math.tan(p.angle)
    image = np.array([[p.beyond, second], [0.0, p.pins + p.beyond]]) @ circle
    np.testing.assert_allclose(np.stack([pen.x, pen.y]), image, atol=1e-14)


def turned(scale: float, turn: float, angle: float = math.pi / 2) -> Mechanism:
    m = Mechanism("turned", gravity=None)
    first, second, rod = m.body("first"), m.body("second"), m.bar("rod", 0.15 * scale)
    m.prismatic("X", m.ground.at(0.3 * scale, 0.2 * scale, turn), first.origin)
    m.prismatic("Y", m.ground.at(0.3 * scale, 0.2 * scale, turn + angle), second.origin)
    m.revolute("A", first.origin, rod.start)
    m.revolute("B", second.origin, rod.at(0.08 * scale, 0))
    m.drive_angle("motor", rod, constant_rate(1.0, turn))
    c, s = math.cos(turn), math.sin(turn)
    at = (scale * (0.3 - 0.08 * c), scale * (0.2 - 0.08 * s))
    m.start_near(
        first=(*at, math.degrees(turn)),
        second=(0.3 * scale, 0.2 * scale, math.degrees(turn + angle)),
        rod=(*at, math.degrees(turn)),
    )
    return m


@pytest.mark.parametrize(("scale", "turn", "angle"), [(0.1, 1.0, 1.4), (30.0, -2.0, 1.0)])
def test_turned_and_scaled_the_layout_stays(scale: float, turn: float, angle: float) -> None:
    m = turned(scale, turn, angle)
    made = Automatic(m, m.sweep())
    [crossing] = [feature for feature in made.layout.features if isinstance(feature, Crossing)]
    assert crossing.middle == pytest.approx([made.sizes.of_metres(c * scale) for c in (0.3, 0.2)])
    assert made.levels == {"first": 0, "second": 0, "rod": 1}
    assert not meets(made)


def test_no_part_of_the_trammel_touches_another() -> None:
    m = trammel.build(trammel.Params())
    outcome = parts_of(m, m.sweep(times=np.linspace(0.0, 4.0, 121)))
    assert outcome.state == "built", outcome
    assert outcome.detail.startswith("2 layers")


def test_a_tongue_is_longer_than_the_groove_that_it_passes() -> None:
    made = Automatic(trammel.build(trammel.Params()), trammel.build(trammel.Params()).sweep())
    scale, solids = made.sizes.scale, made.solids(engraved_too=False)
    for body, name in (("first", "tongue_X"), ("second", "tongue_Y")):
        box = next(solid for solid in solids[body] if solid.name == name).shape.val().BoundingBox()
        long, wide = sorted((box.xlen, box.ylen), reverse=True)
        assert long > 3.9 * wide > 0
    plate = next(solid for solid in solids["ground"] if solid.name == "grooves_X_Y").shape.val()
    assert plate.isValid()
    assert plate.BoundingBox().zmax < made.span("first")[0] <= plate.BoundingBox().zmax + scale


@pytest.mark.parametrize("aside", [0.05, 0.4])
def test_rails_beside_each_other_stay_rails(aside: float) -> None:
    """Parallel ones, however near."""
    m = Mechanism("beside", gravity=None)
    for k, name in enumerate(("low", "high")):
        block = m.body(name)
        m.prismatic(f"rail{k}", m.ground.at(0.0, k * aside), block.origin)
        m.drive_coordinate(f"push{k}", m.ground.at(0.0, k * aside), block.origin, lambda t: 0.1 * math.sin(t))
        m.start_near(**{name: (0.0, k * aside, 0)})
    made = Automatic(m, m.sweep(6.0))
    assert sum(isinstance(feature, Slide) for feature in made.layout.features) == 2


def test_shuttles_that_meet_where_their_grooves_cross_are_refused() -> None:
    """Both are at the crossing at the same time."""
    m = Mechanism("meeting", gravity=None)
    for k, name in enumerate(("first", "second")):
        at = m.ground.at(0.0, 0.0, k * math.pi / 2)
        block = m.body(name)
        m.prismatic(f"rail{k}", at, block.origin)
        m.drive_coordinate(f"push{k}", at, block.origin, lambda t: 0.1 * math.sin(t))
        m.start_near(**{name: (0.0, 0.0, 90.0 * k)})
    made = Automatic(m, m.sweep(6.0))
    with pytest.raises(UserError, match="no order of layers lets first and second pass each other"):
        _ = made.levels


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
@pytest.mark.parametrize(("aside", "rails"), [(0.0, 1), (0.4, 2)])
def test_two_guides_along_one_line_get_one_rail(scale: float, aside: float, rails: int) -> None:
    """A block that is guided twice; guides beside each other get a rail each."""
    m, c, s = Mechanism("twice"), math.cos(0.2), math.sin(0.2)
    block = m.body("block", mass=1.0, inertia=0.01)
    x, y = scale * (0.1 * c - aside * s), scale * (0.1 * s + aside * c)
    m.prismatic("guide", m.ground.at(0, 0, 0.2), block.origin)
    m.prismatic("second", m.ground.at(x, y, 0.2), block.at(0.3 * scale, aside * scale))
    m.start_near(block=(0, 0, math.degrees(0.2)))
    m.start_moving(block=(0.5 * scale * c, 0.5 * scale * s, 0))
    made = Automatic(m, m.simulate(0.4, steps=20))
    made.plan()
    assert sum(isinstance(feature, Slide) for feature in made.layout.features) == rails
