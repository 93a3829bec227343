"""Slides on rails: common rails, rails that cross, and yokes."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.body_shapes import ARM, PlacedEye, yoke_shape
from mechanisms.stages.automatic.slides.rails import Crossing
from mechanisms.stages.automatic.slides.slides import HALF_LENGTH, RAIL, Slide
from mechanisms.trammel import mechanism as trammel
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import meets
from tests.shared.shape_checks import checked

# Blocks along one line: on one rail where they never meet, on rails one above the other where they pass.


def masses(count: int = 2, apart: float = 0.2, turn: float = 0.0, backwards: bool = False) -> Mechanism:
    """Coupled oscillators on a track; of each second one the rail's marker may point the other way."""
    m = Mechanism("masses", gravity=None)
    c, s = math.cos(turn), math.sin(turn)
    before = m.ground.at(0, 0, turn)
    for k in range(count):
        block = m.body(f"mass_{k}", mass=1.0, inertia=1e-3)
        flip = math.pi if backwards and k % 2 else 0.0
        m.prismatic(f"rail_{k}", m.ground.at(0, 0, turn + flip), block.at(0, 0, flip))
        m.spring(f"spring_{k}", before, block.origin, stiffness=100.0, free_length=apart, damping=0.2)
        before = block.origin
        at = apart * (k + 1) + (0.2 * apart if k == 0 else 0.0)
        m.start_near(**{f"mass_{k}": (c * at, s * at, math.degrees(turn))})
    return m


def carts(second: float, phase: float, limits: tuple[float, float] | None = None) -> Mechanism:
    """Two carts that drivers move along one line."""
    m = Mechanism("carts")
    for name, centre, begin in (("first", -second, 0.0), ("second", second, phase)):
        cart = m.body(name)
        m.prismatic(f"rail_{name}", m.ground.origin, cart.origin, limits=limits if name == "first" else None)
        m.drive_coordinate(f"drive_{name}", m.ground.origin, cart.origin, harmonic(0.1, 2 * math.pi, begin, centre))
    return m


def beads() -> Mechanism:
    """Three beads that follow each other to and fro on a rod that turns."""
    m = Mechanism("beads")
    rod = m.bar("rod", 0.5)
    m.revolute("O", m.ground.origin, rod.at(0.25, 0))
    for k in range(3):
        bead = m.body(f"bead_{k}")
        m.prismatic(f"on_{k}", rod.at(0.25, 0), bead.origin)
        m.drive_coordinate(f"drive_{k}", rod.at(0.25, 0), bead.origin, harmonic(0.1, 12.0, 0.0, 0.12 * (k - 1)))
    m.drive_angle("drive", rod, constant_rate(6.0))
    return m


def slides(made: Automatic) -> list[Slide]:
    return made.layout.select(Slide)


def rails(made: Automatic) -> list[str]:
    """Names of the rails that are built, which are sound."""
    built = [solid for solids in made.plan().solids.values() for solid in solids if solid.name.startswith("rail_")]
    for solid in built:
        checked(solid.shape, solid.through_holes)
    return [solid.name for solid in built]


@settings(max_examples=10, deadline=None)
@given(st.integers(2, 4), st.floats(0.05, 0.5), st.floats(-3.0, 3.0), st.booleans())
def test_coupled_masses_have_room_and_rails_that_do_not_overlap(
    count: int, apart: float, turn: float, backwards: bool
) -> None:
    m = masses(count, apart, turn, backwards)
    solution = m.simulate(1.0, steps=60)
    made = Automatic(m, solution)
    assert len({made.levels[f"mass_{k}"] for k in range(count)}) == 1
    assert not meets(made)
    by_name = {slide.name: slide for slide in slides(made)}
    own = [slide for slide in by_name.values() if not slide.host]
    assert rails(made) == [f"rail_{slide.name}" for slide in own]
    way = np.array([math.cos(turn), math.sin(turn)])
    spans = {slide.name: sorted(np.array(slide.rail_ends()) @ way) for slide in own}
    for k in range(count):
        low, high = spans[by_name[f"rail_{k}"].host or f"rail_{k}"]
        along = made.layout.seen(f"mass_{k}", (0.0, 0.0), "ground") @ way
        assert low - 1e-6 <= along.min() - HALF_LENGTH
        assert along.max() + HALF_LENGTH <= high + 1e-6
    ends = sorted(spans.values())
    assert all(high + RAIL < low for (_, high), (low, _) in pairwise(ends))


def test_a_rod_that_turns_has_one_rail_for_its_beads() -> None:
    m = beads()
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert not meets(made)
    host, *guests = slides(made)
    assert [guest.name for guest in host.guests] == [guest.name for guest in guests] == ["on_1", "on_2"]
    assert len({made.levels[f"bead_{k}"] for k in range(3)}) == 1
    assert rails(made) == ["rail_on_0"]


def test_carts_that_pass_each_other_run_on_rails_one_above_the_other() -> None:
    m = carts(0.05, math.pi)
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert made.levels["first"] != made.levels["second"]
    assert not meets(made)
    assert rails(made) == ["rail_rail_first", "rail_rail_second"]
    (a, b), (c, d) = (sorted(x for x, _ in slide.rail_ends()) for slide in slides(made))
    assert c < a < b < d, "posts of the higher rail stand beyond the lower one"


def test_carts_that_follow_each_other_share_a_rail_unless_a_stop_is_on_it() -> None:
    """Their ways overlap, but they are never in one place."""
    m = carts(0.06, 0.3)
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert [slide.host for slide in slides(made)] == ["", "rail_first"]
    assert made.levels["first"] == made.levels["second"]
    m = carts(0.06, 0.3, limits=(-0.2, 0.1))
    stopped = Automatic(m, m.sweep(1.0, steps=120))
    assert [slide.host for slide in slides(stopped)] == ["", ""]
    assert stopped.levels["first"] != stopped.levels["second"]
    assert not meets(stopped)


@settings(max_examples=40, deadline=None)
@given(st.floats(0.06, 0.6))
def test_carts_that_never_meet_are_never_one_above_the_other(second: float) -> None:
    m = carts(second, 0.0)
    made = Automatic(m, m.sweep(1.0, steps=20))
    assert made.levels["first"] == made.levels["second"]
    left, right = slides(made)
    if not right.host:
        (_, b), (c, _) = (sorted(x for x, _ in slide.rail_ends()) for slide in (left, right))
        assert b + RAIL < c


@pytest.mark.parametrize("second", [0.3, 1.0])
def test_carts_far_from_each_other_have_rails_of_their_own(second: float) -> None:
    m = carts(second, 0.0)
    made = Automatic(m, m.sweep(1.0, steps=120))
    assert not meets(made)
    assert rails(made) == ["rail_rail_first", "rail_rail_second"]
    (_, b), (c, _) = (sorted(x for x, _ in slide.rail_ends()) for slide in slides(made))
    assert b < c


# Slides on ground that cross: a plate with grooves, and shuttles that pass each other in it; the trammel.


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
    [crossing] = made.layout.select(Crossing)
    assert crossing.middle == pytest.approx([made.sizes.of_metres(c * scale) for c in (0.3, 0.2)])
    assert made.levels == {"first": 0, "second": 0, "rod": 1}
    assert not meets(made)


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


# Plates of bodies with a slot and little else: a T within the outline that the order of layers is found with.


WALL, EYE = Eye(13.5, 0.0), Eye(13.0, 8.0)


def placed(points: list[tuple[float, float, Eye]], turn: float, x: float, y: float) -> list[PlacedEye]:
    c, s = math.cos(turn), math.sin(turn)
    return [(x + c * u - s * v, y + s * u + c * v, eye) for u, v, eye in points]


def slot_along_y(half: float, *others: tuple[float, float, Eye]) -> list[tuple[float, float, Eye]]:
    return [(0.0, -half, WALL), (0.0, half, WALL), *others]


@pytest.mark.parametrize(
    ("half", "others", "turn"),
    [
        (33.0, [(102.0, 0.0, EYE), (122.0, 0.0, EYE)], 0.0),
        (33.0, [(-80.0, 7.0, EYE)], 2.1),
        (21.0, [(60.0, -10.0, Eye(12.5, 8.0, above=3.0))], -0.7),
    ],
)
def test_it_is_one_lighter_piece_within_the_plate_round_all_its_eyes(
    half: float, others: list[tuple[float, float, Eye]], turn: float
):
    eyes = placed(slot_along_y(half, *others), turn, 5.0, -9.0)
    shape = yoke_shape(eyes, [eye[:2] for eye in eyes[:2]], 7.0)
    assert shape is not None
    [solid] = shape.solids().vals()
    assert solid.isValid()
    corners = [(x, y, eye.radius) for x, y, eye in eyes[:3]]
    middle = np.mean([corner[:2] for corner in corners], axis=0)
    corners.sort(key=lambda corner: math.atan2(corner[1] - middle[1], corner[0] - middle[0]))
    hull = extruded(outline.hull(corners), 12.0, -1.0)
    if len(others) == 2:
        hull = hull.union(extruded(outline.hull([(x, y, eye.radius) for x, y, eye in eyes[2:]]), 12.0, -1.0))
    outside = shape.cut(hull)
    assert sum(piece.Volume() for piece in outside.solids().vals()) < 1e-6 * solid.Volume()
    plate = 7.0 * extruded(outline.hull(corners), 1.0).val().Volume()
    assert solid.Volume() < 0.85 * plate
    box = [extruded(outline.circle(x, y, 0.9 * eye.radius), 5.0, 1.0) for x, y, eye in eyes if not eye.bore]
    for disc in box:  # the wall round the slot's ends is whole
        assert sum(piece.Volume() for piece in disc.cut(shape).solids().vals()) < 1e-6


@pytest.mark.parametrize(
    "others",
    [
        [],
        [(20.0, 0.0, EYE)],  # too near for an arm
        [(90.0, 30.0, EYE)],  # past the slot's end
        [(90.0, 0.0, EYE), (90.0, 20.0, EYE), (120.0, 0.0, EYE)],
        [(0.0, 80.0, EYE)],  # in line with the slot: a lever
        [(90.0, 0.0, EYE), (-90.0, 0.0, EYE)],  # on both sides
    ],
)
def test_where_a_t_is_no_better_a_plate_is_made(others: list[tuple[float, float, Eye]]):
    eyes = placed(slot_along_y(33.0, *others), 0.4, 0.0, 0.0)
    assert yoke_shape(eyes, [eye[:2] for eye in eyes[:2]], 7.0) is None
    assert 0.5 < ARM < 1.0
