"""Pins in straight and curved slots."""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial import KDTree

from mbsd import Mechanism, Solution, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.curves import continued, evenly, followed
from mechanisms.stages.automatic.layout.items import span, spans_meet
from mechanisms.stages.automatic.pins.welds import Weld
from mechanisms.stages.automatic.rolling import roads
from mechanisms.stages.automatic.rolling.roads import Road, along, banded, with_shared_roads
from mechanisms.stages.automatic.rolling.rounds import Round
from mechanisms.stages.automatic.slides.curved_slots import CurvedSlot
from mechanisms.stages.automatic.slides.slots import Slot
from shared.shapes.build import extruded
from shared.shapes.outline import band, distances, loop, rounded_rectangle, sharpest
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import meets
from tools.hunt_parts.case import parts_of
from tools.hunt_parts.outcome import BUILT
from tools.models.assur_models import six_bar_with_welds

# Automatic parts of slots on ground and along curves, of pins on ground, and of welds.


TURN = np.linspace(0.0, 1.0, 121)


def _crank(m: Mechanism, length: float = 0.1):
    crank = m.bar("crank", length)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0)
    return crank


def ground_slot() -> Mechanism:
    m = Mechanism("ground_slot")
    rod = m.bar("rod", 0.3)
    m.revolute("A", _crank(m).end, rod.start)
    m.pin_in_slot("slot", m.ground.at(0.2, -0.05, 0.1), rod.end)
    m.start_near(rod=-5)
    return m


def ground_pin() -> Mechanism:
    m = Mechanism("ground_pin")
    lever = m.body("lever")
    m.revolute("A", _crank(m).end, lever.origin)
    m.pin_in_slot("slot", lever.origin, m.ground.at(0.3, 0))
    m.start_near(lever=-5)
    return m


def egg(scale: float = 1.0, closed: bool = True) -> Mechanism:
    """A pin on an egg-shaped curve of ground, pulled round by a slide on the crank."""
    m = Mechanism("egg")
    crank, pin = _crank(m, 0.06 * scale), m.body("pin")
    angles = np.linspace(0, 2 * math.pi, 13)[:-1]
    points = [(0.1 * scale * (1 + 0.1 * math.cos(a)) * math.cos(a), 0.1 * scale * math.sin(a)) for a in angles]
    m.prismatic("slide", crank.origin, pin.origin)
    m.point_on_curve("curve", m.ground.origin, pin.origin, points, closed=closed)
    m.start_near(pin=(0.11 * scale, 0.0, 0.0))
    return m


@pytest.mark.parametrize("build", [ground_slot, ground_pin, egg, lambda: egg(30.0)])
def test_slots_get_an_order_of_layers(build: object) -> None:
    m = build()
    made = Automatic(m, m.sweep(times=TURN))
    assert not meets(made)
    (slot,) = made.layout.select(Slot)
    seen = made.layout.seen(slot.pin, slot.pin_at, slot.slot)
    if len(slot.path) == 2:
        (x0, y0), (x1, y1) = slot.path
        way = np.array([x1 - x0, y1 - y0]) / math.hypot(x1 - x0, y1 - y0)
        along = (seen - slot.path[0]) @ way
        assert along.min() > 0.5
        assert along.max() < math.hypot(x1 - x0, y1 - y0) - 0.5
    else:
        assert isinstance(slot, CurvedSlot)
        assert slot.closed
        apart = np.linalg.norm(seen[:, None] - slot.path[None], axis=2).min(axis=1)
        assert apart.max() < 1.5, "the pin runs in its slot"


def test_welded_plates_are_on_layers_of_their_own() -> None:
    m = six_bar_with_welds()
    made = Automatic(m, m.sweep(times=TURN))
    assert not meets(made)
    (weld,) = made.layout.select(Weld)
    assert set(weld.movers) == {"arm", "rocker"}
    assert made.levels["arm"] != made.levels["rocker"]
    first, second = (
        np.array([made.layout.seen(body, place, "ground")[0] for place in weld.bolts(body)]) for body in weld.movers
    )
    assert np.allclose(first, second, atol=1e-6)


def test_a_rail_and_a_pivot_do_not_stand_on_one_place() -> None:
    """The rail goes through where the lever's pedestal would be: the pivot hangs over it, from a bridge."""
    m = Mechanism("crossing")
    block, lever = m.body("block"), m.bar("lever", 0.1)
    m.prismatic("rail", m.ground.at(0, 0), block.origin)
    m.drive_coordinate("push", m.ground.at(0, 0), block.origin, lambda t: 0.1 * math.cos(2 * math.pi * t))
    m.revolute("D", m.ground.at(0.02, 0.01), lever.start)
    m.drive_angle("turn", lever, constant_rate(1.0))
    made = Automatic(m, m.sweep(times=TURN))
    assert made.decided["pin D"] == 1
    assert made.levels["lever"] > made.levels["block"]
    on_ground = {item.what: span(item.reach, made.decided) for item in made.layout.items if item.body == "ground"}
    assert not spans_meet(on_ground["the rail of rail"], on_ground["the pivot D on ground"])


def test_a_curve_that_bends_too_sharply_is_refused() -> None:
    m = egg()
    m.name = "sharp"
    made = Automatic(m, m.sweep(times=TURN), pin=120.0)
    with pytest.raises(UserError, match="the curve of joint 'curve' bends with a radius of"):
        _ = made.levels


@pytest.mark.parametrize("build", [six_bar_with_welds])
def test_solids_are_sound_and_touch_nothing(build: object) -> None:
    m = build()
    outcome = parts_of(m, m.sweep(times=np.linspace(0.0, 1.0, 241)))
    assert outcome.state == BUILT, outcome


def test_bands_follow_arcs() -> None:
    """Areas of a half ring and of a ring, and the radius of curvature of a circle."""
    angles = np.linspace(0.0, math.pi, 60)
    arc = 50.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    exact = math.pi * 50.0 * 12.0 + math.pi * 36.0
    assert extruded(band(arc, 6.0), 1.0).val().Volume() == pytest.approx(exact, rel=2e-4)
    angles = np.linspace(0.0, 2 * math.pi, 120)
    circle = 50.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for turned in (circle, circle[::-1]):
        ring = extruded(loop(turned, 6.0), 1.0).cut(extruded(loop(turned, -6.0), 1.0))
        assert isinstance(ring, cq.Workplane)
        assert ring.val().Volume() == pytest.approx(math.pi * (56.0**2 - 44.0**2), rel=2e-4)
    assert sharpest(circle) == pytest.approx(50.0, rel=5e-3)
    with pytest.raises(ValueError, match="bends as sharply"):
        band(arc, 55.0)


def test_long_slots_keep_their_walls_when_they_are_cut() -> None:
    """The kernel's cut approximates the edges of walls; those of one long wall strayed by more than the clearance."""
    turn, up = np.linspace(0.0, math.pi, 60)[1:-1], np.linspace(0.0, 800.0, 400)
    legs = []
    for x in (0.0, 64.0, 128.0, 192.0):
        over = np.stack([x + 16.0 * (1.0 - np.cos(turn)), 800.0 + 16.0 * np.sin(turn)], axis=1)
        under = np.stack([x + 32.0 + 16.0 * (1.0 - np.cos(turn)), -16.0 * np.sin(turn)], axis=1)
        there, back = (np.stack([np.full(400, at), way], axis=1) for at, way in ((x, up), (x + 32.0, up[::-1])))
        legs += [there, over, back, under]
    slot = band(evenly(np.vstack(legs[:-1]), 960), 6.6)
    plate = extruded(rounded_rectangle(-50.0, -50.0, 280.0, 850.0, 5.0), 7.0).cut(extruded(slot, 9.0, -1.0)).val()
    edges = [edge for edge in plate.Edges() if edge.geomType() == "BSPLINE" and edge.BoundingBox().zmax < 0.01]
    exact = _places([edge for edge in slot.Edges() if edge.geomType() == "BSPLINE"], 40_000)
    cut = _places(edges, 4_000)
    _, near = KDTree(exact).query(cut)
    away = [distances(place[None], exact[max(k - 1, 0) : k + 2])[0] for place, k in zip(cut, near, strict=True)]
    assert max(away) < 0.01


def _places(edges: list[cq.Edge], count: int) -> np.ndarray:
    places = []
    for curve in (edge._geomAdaptor() for edge in edges):
        parameters = np.linspace(curve.FirstParameter(), curve.LastParameter(), count // len(edges))
        places += [(p.X(), p.Y()) for p in map(curve.Value, parameters.tolist())]
    return np.array(places)


def test_a_long_spline_is_the_same_curve_in_several_edges() -> None:
    angles = np.linspace(0.0, 2 * math.pi, 601)
    ring = 500.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    around, along = loop(ring, 6.0), band(ring[:-30], 6.0)
    assert (len(around.Edges()), len(along.Edges())) == (5, 12)
    assert around.Length() == pytest.approx(2 * math.pi * 506.0, rel=1e-6)
    assert extruded(along, 1.0).val().isValid()


@pytest.mark.parametrize(("scale", "turn"), [(0.1, 0.3), (30.0, -2.0)])
def test_slots_on_ground_that_cross_are_refused_with_their_names(scale: float, turn: float) -> None:
    """Either roller would have to pass the plate of the other: only slides cross in one plate (rails.py)."""
    m = Mechanism("crossed")
    bar = m.bar("bar", 0.1 * scale)
    m.pin_in_slot("across", m.ground.at(0, 0, turn), bar.start)
    m.pin_in_slot("along", m.ground.at(0, 0, turn + math.pi / 2), bar.end)
    m.drive_angle("motor", bar, constant_rate(2 * math.pi))
    corner = 0.1 * scale * math.sqrt(0.5)
    m.start_near(bar=(corner * math.cos(turn), corner * math.sin(turn), math.degrees(turn) + 135.0))
    with pytest.raises(UserError, match=r"slotted plate of along meets the slotted plate of across.*prismatic"):
        _ = Automatic(m, m.sweep(steps=60)).levels


@pytest.mark.parametrize("scale", [0.1, 30.0])
def test_a_slotted_plate_reaches_beyond_the_slide_that_carries_its_pin(scale: float) -> None:
    """A wheel that drops from a cart follows a wavy slot on ground; near posts stand where the cart passes."""
    m = Mechanism("wave")
    cart, wheel = m.body("cart"), m.body("wheel")
    m.prismatic("rail", m.ground.at(0.0, scale), cart.origin)
    m.drive_coordinate("push", m.ground.origin, cart.origin, harmonic(1.0 * scale, 2.0))
    m.prismatic("drop", cart.at(0, 0, math.pi / 2), wheel.at(0, 0, math.pi / 2))
    points = [(0.25 * k * scale, 0.06 * (-1) ** k * scale) for k in range(-6, 7)]
    m.point_on_curve("curve", m.ground.origin, wheel.origin, points)
    m.start_near(cart=(0, scale, 0), wheel=(0, 0.06 * scale, 0))
    made = Automatic(m, m.sweep(times=np.linspace(0.0, math.pi, 121)))
    made.plan()
    assert made.layout.far_posts
    assert made.levels["cart"] < made.levels["wheel"]
    assert not meets(made)


# Automatic parts along open curves: slots and roads go on straight as the model does, keep out of their own way,
# and what would run through itself is refused before anything is built.


def _arc(half: float, count: int = 40) -> np.ndarray:
    """Points of a circle of 1 m about its lowest one, from left to right: what runs on its left is inside."""
    angles = np.linspace(-half, half, count)
    return np.column_stack([np.sin(angles), -np.cos(angles)])


def _loop(count: int = 50) -> np.ndarray:
    """Points of a curve that crosses itself."""
    angles = np.linspace(-2.4, 2.4, count)
    return np.column_stack([0.5 * np.sin(2 * angles), np.cos(angles)])


def _runs(points: np.ndarray, at: int, speed: float, radius: float, duration: float) -> tuple[Mechanism, Solution]:
    """A bead on a curve of ground, or with a radius a disc that rolls on it, from a point of the curve."""
    m = Mechanism("runs", gravity=(0.0, 0.0))
    way = points[at + 1] - points[at - 1]
    way /= np.hypot(*way)
    (x, y), bead = points[at] + radius * np.array([-way[1], way[0]]), m.body("bead", 1.0, inertia=0.01)
    if radius:
        m.rolling_on_curve("track", m.ground.origin, bead.origin, points.tolist(), radius)
    else:
        m.point_on_curve("track", m.ground.origin, bead.origin, points.tolist())
    m.start_near(bead=(float(x), float(y), 0.0))
    turn = -speed / radius if radius else 0.0
    m.start_moving(bead=(speed * float(way[0]), speed * float(way[1]), turn))
    return m, m.simulate(duration, steps=90)


def _road(made: Automatic) -> tuple[Road, Round, np.ndarray]:
    [road], [wheel] = made.layout.select(Road), made.layout.select(Round)
    return road, wheel, made.layout.seen("bead", wheel.at, "ground")


def test_a_slot_goes_on_along_the_tangent_of_its_curve() -> None:
    """Along the last chord it left the pin's way by more than the roller's clearance."""
    m, solution = _runs(_arc(1.2), 30, 5.0, 0.0, 0.7)
    made = Automatic(m, solution)
    [slot] = made.layout.select(CurvedSlot)
    seen = made.layout.seen("bead", slot.pin_at, "ground")
    assert np.hypot(*seen[-1]) > 1.5 * np.hypot(*seen[0]), "the pin goes far beyond the curve"
    count = len(slot.path)
    fine = CubicSpline(np.arange(count), slot.path)(np.linspace(0, count - 1, 30 * count))
    assert distances(seen, fine).max() < made.sizes.pivot.fit.running / 4


def test_a_slot_that_crosses_itself_is_refused() -> None:
    m, solution = _runs(_loop(), 8, 4.0, 0.0, 1.2)
    with pytest.raises(UserError, match=r"runs: the pin of joint 'track' crosses its own path.* near \(.*motion end"):
        _ = Automatic(m, solution).levels


@pytest.mark.parametrize("half", [1.0, 2.8])
def test_a_road_goes_on_under_its_wheel(half: float) -> None:
    """On the right of an arc that is run from its end to its begin: outside, and far along the straight line."""
    m, solution = _runs(_arc(half)[::-1], 35, 5.0, 0.04, 0.6)
    road, wheel, centres = _road(Automatic(m, solution))
    away = distances(centres, road.path)
    assert away == pytest.approx(wheel.radius, abs=0.03), "neither without a road nor through one"
    assert (road.band is not None) == (half > 2.0)
    sides = road.path[-1:], road.feet if road.band is None else road.band.back[::-1], road.path[:1]
    assert distances(centres, np.vstack(sides)).min() > wheel.built_radius
    solid = road.wall(0.0, 5.0).val()
    assert solid.isValid()


def test_a_road_that_its_own_wheel_would_run_through_is_refused() -> None:
    m, solution = _runs(_loop(), 8, 4.0, 0.03, 1.2)
    with pytest.raises(UserError, match=r"runs: joint 'track': at t=.* the disc of 'bead', 30 mm in radius, .* a wall"):
        _ = Automatic(m, solution).levels


def test_a_terrain_goes_on_as_far_as_it_is_touched() -> None:
    m = Mechanism("terrain")
    ball = m.body("bead", 1.0, inertia=0.001)
    points = [(0.1 * k - 0.4, 0.02 * math.cos(k)) for k in range(9)]
    m.rigid_terrain("land", m.ground.origin, ball.origin, points, radius=0.05)
    m.start_near(bead=(0.3, 0.10, 0.0))
    m.start_moving(bead=(2.0, 0.0, 0.0))
    made = Automatic(m, m.simulate(0.5, steps=90))
    road, part, centres = _road(made)
    scale = made.sizes.of_metres(1.0)
    assert centres[-1, 0] > 0.7 * scale, "the ball goes far beyond the last point"
    assert road.path[-1, 0] > centres[-1, 0]
    assert road.path[0, 0] == pytest.approx(-0.4 * scale), "at the other end the road is as long as the curve"
    assert distances(centres, road.path).min() > part.built_radius


def test_a_point_is_followed_through_a_crossing() -> None:
    """The nearest place of a path may be one of the other branch."""
    angles = np.linspace(0.0, 2 * math.pi, 801)
    eight = np.column_stack([np.sin(2 * angles), np.cos(angles)])
    numbers = np.concatenate([np.arange(150, 700), np.arange(700, 150, -1)])
    seen = eight[numbers] + 1e-3
    nearest = np.array([int(np.argmin(((eight - place) ** 2).sum(axis=1))) for place in seen])
    assert np.abs(nearest - numbers).max() > 300
    assert np.abs(followed(eight, seen, False) - numbers).max() < 3
    round_it = np.arange(100, 1500)
    assert np.abs(followed(eight, eight[round_it % 800], True) - round_it).max() < 3


def test_a_path_is_continued_on_both_sides() -> None:
    path = np.array([[0.0, 0.0], [1.0, 0.0]])
    whole, before = continued(path, np.array([[0.0, 1.0], [1.0, 0.0]]), 2.0, 1.0)
    assert whole[before : before + 2].tolist() == path.tolist()
    assert whole[0].tolist() == [0.0, before]
    assert whole[-1].tolist() == [1.0 + before, 0.0]


def test_a_band_that_comes_back_to_its_begin_has_a_hole() -> None:
    path = 100.0 * _arc(math.pi + 0.02, 200)
    ring = roads.band(path)
    assert ring is not None
    [hole] = ring.holes
    assert np.hypot(*hole.T) == pytest.approx(100.0, abs=0.1)
    assert np.hypot(*ring.border.T) == pytest.approx(110.0, abs=0.1)


def test_roads_on_one_surface_are_one_band_if_one_of_them_is() -> None:
    path = 100.0 * _arc(2.5, 100)
    whole = banded("a", [], path)
    assert whole is not None
    for features in ([whole, along("b", [], path[40:60])], [along("b", [], path[40:60]), whole]):
        [road] = with_shared_roads(features)
        assert isinstance(road, Road)
        assert road.band is not None
        assert len(road.path) == len(path)
    assert len(with_shared_roads([whole, along("c", [], path[40:60] + 30.0)])) == 2
