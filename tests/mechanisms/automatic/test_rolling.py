"""Wheels that roll: roads, roads that several share, and tracks on moving bodies."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate, curve, harmonic
from mbsd.model.plane_curves import curve_pieces
from mbsd.results.solution import Solution
from mechanisms.automatic import automatic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.curves import curve_path, turns_left
from mechanisms.stages.automatic.rolling.roads import Road, along, with_shared_roads
from mechanisms.stages.automatic.rolling.rounds import Round
from mechanisms.stages.automatic.rolling.tracks import Track, circle
from mechanisms.stages.automatic.rolling.tracks import closed_normals as normals
from shared.shapes.outline import distances
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import meets
from tests.shared.shape_checks import checked
from tools.hunt_parts.case import parts_of

# Wheels on roads by themselves: the road passes under the wheel all the way and stays clear of it.


HILLS = [(-0.2, 0.0), (-0.1, 0.01), (0.0, 0.0), (0.1, -0.01), (0.2, 0.0), (0.3, 0.01), (0.4, 0.0)]


def _cart(curve: bool) -> Mechanism:
    """A wheel of 40 mm radius that a driver turns by 2 rad; a body on its axle stays level."""
    m = Mechanism("cart")
    wheel, slider = m.body("wheel"), m.body("slider")
    m.revolute("axle", wheel.origin, slider.at(0, 0))
    if curve:
        m.rolling_on_curve("road", m.ground.origin, wheel.origin, HILLS, 0.04)
    else:
        m.rolling_disc("road", m.ground.origin, wheel.origin, 0.04)
    m.angle_lock("level", m.ground.origin, slider.origin)
    m.drive_angle("motor", wheel, constant_rate(-2.0))
    m.start_near(wheel=(0, 0.04, 0), slider=(0, 0.04, 0))
    return m


def _planned(m: Mechanism) -> tuple[Automatic, Round, np.ndarray]:
    made = Automatic(m, m.sweep(1.0, 200))
    [wheel], [road] = made.layout.select(Round), made.layout.select(Road)
    assert road.rounds == [wheel]
    return made, wheel, road.path


@pytest.mark.parametrize("curve", [False, True])
def test_wheel_is_short_of_its_road_by_the_clearance(curve: bool) -> None:
    made, wheel, path = _planned(_cart(curve))
    assert made.levels["wheel"] != made.levels["slider"]
    centre = made.layout.seen("wheel", wheel.at, "ground")
    away = distances(centre, path)
    scale = made.sizes.scale
    assert (away - wheel.built_radius).min() * scale > 0.05
    assert (away - wheel.built_radius).max() * scale < 0.2
    assert np.ptp(centre[:, 0]) * scale == pytest.approx(80.0, rel=0.05)  # 2 rad of 40 mm


def test_wheel_tyre_and_road_are_sound() -> None:
    made, wheel, path = _planned(_cart(curve=True))
    plan = made.plan()
    (plate,) = plan.plates["wheel"]
    named = {solid.name: solid for solids in plan.solids.values() for solid in solids}
    road, tyre = named["road_road"], named["tyre_road"]
    for solid in (plate.shape, road.shape, tyre.shape):
        assert solid.val().isValid()
        assert solid.solids().size() == 1
    box = road.shape.val().BoundingBox()
    assert box.zmax == pytest.approx(made.heights.top("wheel"))
    assert box.xlen > np.ptp(path[:, 0]) - 1e-6
    outer = 0.5 * tyre.shape.val().BoundingBox().xlen
    assert outer == pytest.approx(wheel.built_radius, abs=0.05)


@pytest.mark.parametrize("size", [0.01, 1.0, 100.0])
def test_chords_of_a_curve_stay_with_the_curve(size: float) -> None:
    points = [[size * x, size * y] for x, y in ((-2, 0.0), (-1, -0.25), (0, 0.17), (1, -0.26), (2, 0.14))]
    path = curve_path(points, False)
    breaks, pieces = curve_pieces(np.array(points), False)
    middles = (pieces * (0.5 * np.diff(breaks)[:, None, None]) ** np.arange(6)).sum(axis=2)
    assert distances(middles, path).max() < 3e-5 * 4 * size
    assert path[0] == pytest.approx(points[0])
    assert path[-1] == pytest.approx(points[-1])


# A road reaches what base_under asks for, where gravity holds a wheel on it.


def car(turn: float = 0.0) -> Mechanism:
    """A wheel that is driven half a metre over a step; the world turned."""
    c, s = math.cos(turn), math.sin(turn)
    m = Mechanism("car", gravity=(9.81 * s, -9.81 * c))
    body, wheel = m.body("body", 1.0, inertia=0.01), m.body("wheel", 0.5, inertia=0.001)
    start = m.ground.at(0, 0, turn)
    m.angle_lock("level", start, body.origin)
    m.revolute("hub", body.origin, wheel.origin)
    m.drive_coordinate("engine", start, body.origin, constant_rate(0.5))
    m.tyre("tyre", start, wheel.origin, 0.1, 1e4, 50.0, profile=curve([0.0, 0.2, 0.3], [0.0, 0.0, 0.02]))
    at = (-0.1 * s, 0.1 * c)
    m.start_near(body=(*at, turn), wheel=(*at, turn))
    m.start_moving(body=(0.5 * c, 0.5 * s, 0.0), wheel=(0.5 * c, 0.5 * s, 0.0))
    return m


@pytest.mark.parametrize("turn", [0.0, 0.6, -2.0])
def test_a_road_goes_on_as_far_as_the_base(turn: float) -> None:
    m = car(turn)
    sol = m.simulate(1.0, steps=60)
    c, s = math.cos(turn), math.sin(turn)
    made = automatic(m, solution=sol)
    made.base_under((c * -400.0, s * -400.0), (c * 1500.0, s * 1500.0))
    road = next(solid for solid in made.solids(engraved_too=False)["ground"] if solid.name == "road_tyre")
    along = road.shape.rotate((0, 0, 0), (0, 0, 1), -math.degrees(turn)).val().BoundingBox()
    assert along.xmin == pytest.approx(-400.0, abs=1.0)
    assert along.xmax >= 1500.0 - 1.0
    assert road.material == "concrete"


# Several wheels on one surface of ground: one road under them all.


HILLS_OF_SHARED_ROADS = [(-0.6 + 0.2 * k, 0.006 * (-1) ** k) for k in range(9)]
SURFACES = ("line", "curve", "wall", "terrain", "tyre")


def vehicle(surface: str, turn: float = 0.0, apart: float = 0.2) -> Mechanism:
    """A frame on two wheels of 40 mm radius, pushed along the surface."""
    c, s = math.cos(turn), math.sin(turn)
    m = Mechanism("vehicle", gravity=(9.81 * s + 1.0 * c, -9.81 * c + 1.0 * s))
    frame = m.body("frame", mass=1.0, inertia=0.01)
    ground = m.ground.at(0, 0, turn)
    bumps = curve([0.05 * k - 0.5 for k in range(25)], [0.003 * math.sin(0.9 * k) for k in range(25)])
    for name, x in (("rear", 0.0), ("front", apart)):
        wheel = m.body(name, mass=0.2, inertia=1e-4)
        m.revolute(f"axle_{name}", frame.at(x, 0), wheel.origin)
        on = f"{name}_road"
        if surface == "line":
            m.rolling_disc(on, ground, wheel.origin, 0.04)
        elif surface == "curve":
            m.rolling_on_curve(on, ground, wheel.origin, HILLS_OF_SHARED_ROADS, 0.04)
        elif surface == "wall":
            m.rigid_contact(on, ground, wheel.origin, 0.04, friction=0.5)
        elif surface == "terrain":
            m.rigid_terrain(on, ground, wheel.origin, HILLS_OF_SHARED_ROADS, 0.04, friction=0.5)
        else:
            m.tyre(on, ground, wheel.origin, 0.04, stiffness=40000.0, damping=100.0, profile=bumps)
        m.start_near(**{name: (c * x - s * 0.048, s * x + c * 0.048, 0.0)})
        if surface not in ("line", "curve"):
            m.start_moving(**{name: (0.1 * c, 0.1 * s, -2.5)})
    m.start_near(frame=(-s * 0.048, c * 0.048, math.degrees(turn)))
    if surface not in ("line", "curve"):
        m.start_moving(frame=(0.1 * c, 0.1 * s, 0.0))
    return m


def roads(made: Automatic) -> list[Road]:
    return made.layout.select(Road)


@pytest.mark.parametrize("turn", [0.0, 1.1])
@pytest.mark.parametrize("surface", SURFACES)
def test_two_wheels_run_on_one_road(surface: str, turn: float) -> None:
    m = vehicle(surface, turn)
    made = Automatic(m, m.simulate(0.5, steps=60))
    assert not meets(made)
    [road] = roads(made)
    assert road.name == "rear_road"
    assert [part.body for part in road.rounds] == ["rear", "front"]
    assert made.levels["rear"] == made.levels["front"] != made.levels["frame"]
    for part in road.rounds:
        away = distances(made.layout.seen(part.body, part.at, "ground"), road.path) - part.built_radius
        assert away.min() > (-1.0 if surface == "tyre" else 0.0)
    plan = made.plan()
    [solid] = [piece for piece in plan.solids["ground"] if piece.name == "road_rear_road"]
    checked(solid.shape, solid.through_holes)


def test_lines_that_are_not_one_stay_two_roads() -> None:
    """A wheel on a line that lies higher, and that another wheel never reaches."""
    m = vehicle("line")
    step = m.body("step", mass=0.2, inertia=1e-4)
    m.revolute("axle_step", m.bodies["frame"].at(0.4, 0.02), step.origin)
    m.rolling_disc("high", m.ground.at(0, 0.02), step.origin, 0.04)
    m.start_near(step=(0.4, 0.06, 0.0))
    m.drive_angle("drive", m.bodies["rear"], constant_rate(-0.3))
    made = Automatic(m, m.sweep(0.5, steps=20))
    assert [road.name for road in roads(made)] == ["rear_road", "high"]


def test_corners_of_walls_stay_mitred() -> None:
    """A ball in a box: walls that meet are no road of another one, though two of them are parallel."""
    m = Mechanism("box")
    ball = m.body("ball", mass=0.1, inertia=1e-5)
    for name, x, y, angle in (
        ("low", 0, 0, 0.0),
        ("right", 0.3, 0, 90.0),
        ("high", 0, 0.2, 180.0),
        ("left", 0, 0, -90),
    ):
        m.rigid_contact(name, m.ground.at(x, y, math.radians(angle)), ball.origin, 0.02, restitution=0.8)
    m.start_near(ball=(0.1, 0.1, 0))
    m.start_moving(ball=(0.7, 0.4, 0))
    made = Automatic(m, m.simulate(1.0, steps=60))
    assert sorted(road.name for road in roads(made)) == ["high", "left", "low", "right"]


@given(
    st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=40),
    st.floats(0.1, 0.8),
    st.floats(-0.3, 0.3),
    st.floats(-3.1, 3.1),
    st.booleans(),
)
def test_pieces_of_a_path_are_the_path(
    heights: list[float], cut: float, over: float, turn: float, backwards: bool
) -> None:
    """Two roads along a path, from its start and to its end: one if they overlap, and two if there is a gap."""
    path = np.column_stack([10.0 * np.arange(len(heights)), heights])
    way = path[-1] - path[0]
    path = path if abs(way[1]) < way[0] else path * [1.0, 0.0]
    c, s = math.cos(turn), math.sin(turn)
    path = path @ np.array([[c, s], [-s, c]])
    first = max(2, round(cut * len(path)))
    second = min(max(0, first - 1 - round(over * len(path))), len(path) - 2)
    parts: list[Any] = [along("a", [], path[:first]), along("b", [], path[second:])]
    merged = with_shared_roads(parts[::-1] if backwards else parts)
    if second > first - 1:
        both_straight = first == len(path) - second == 2  # these may be one line, and one road over the gap
        assert len(merged) == 2 or both_straight
        return
    if len(merged) == 1:
        [road] = merged
        assert isinstance(road, Road)
        assert np.allclose(road.path, path, atol=1e-9)


# Rings and discs about closed curves, and roads of moving bodies: what runs there stays clear by the clearance.


def curve_tracks(radius: float, count: int, left: bool = True, long: float = 1.0) -> list[tuple[float, float]]:
    angle = np.linspace(0.0, 2 * math.pi if left else -2 * math.pi, count, endpoint=False)
    return [(long * radius * math.cos(a), radius * math.sin(a)) for a in angle]


def in_a_bowl(scale: float = 1.0) -> Solution:
    m = Mechanism("bowl")
    wheel = m.body("wheel", mass=1.0, inertia=1e-3 * scale**2)
    points = [(scale * x, scale * y) for x, y in curve_tracks(0.2, 24, long=1.3)]
    m.rolling_on_curve("ring", m.ground.origin, wheel.origin, points, 0.04 * scale, closed=True)
    m.start_near(wheel=(0.21 * scale, 0.0, 0))
    return m.simulate(0.6 * math.sqrt(scale), 60)


def round_a_disc() -> Solution:
    m = Mechanism("round", gravity=None)
    arm, wheel = m.bar("arm", 0.14), m.body("wheel")
    m.revolute("O", m.ground.origin, arm.start)
    m.revolute("P", arm.end, wheel.origin)
    m.rolling_on_curve("disc", m.ground.origin, wheel.origin, curve_tracks(0.1, 60, left=False), 0.04, closed=True)
    m.drive_angle("motor", arm, constant_rate(2.0))
    m.start_near(arm=0, wheel=(0.14, 0, 0))
    return m.sweep(steps=120)


def in_a_ring(moving: bool) -> Solution:
    m = Mechanism("ring")
    ring, ball = m.ground, m.body("ball", mass=0.1, inertia=1e-5)
    if moving:
        ring = m.body("cup", mass=1.0, inertia=1e-2)
        m.revolute("O", m.ground.origin, ring.origin)
        m.drive_angle("motor", ring, harmonic(0.5, 6.0))
        m.start_near(cup=0)
    m.rigid_discs("in", ring.origin, ball.origin, 0.1, 0.02, inside=True, restitution=0.6)
    m.start_near(ball=(0.05, -0.03, 0))
    return m.simulate(0.2, 40, event_rows=True)


def on_a_peg() -> Solution:
    m = Mechanism("peg")
    ball = m.body("ball", mass=0.1, inertia=1e-5)
    m.rigid_discs("peg", ball.origin, m.ground.origin, 0.02, 0.03, restitution=0.6)
    m.start_near(ball=(0.01, 0.1, 0))
    return m.simulate(0.25, 60, event_rows=True)


def on_a_tray() -> Solution:
    m = Mechanism("tilt")
    tray, ball = m.bar("tray", 0.4, mass=1.0), m.body("ball", mass=0.1, inertia=1e-5)
    m.revolute("O", m.ground.origin, tray.start)
    m.rigid_contact("on", tray.at(0, 0.05), ball.origin, radius=0.02, restitution=0.3)
    m.drive_angle("motor", tray, harmonic(0.15, 6.0))
    m.start_near(tray=0, ball=(0.2, 0.09, 0))
    return m.simulate(0.25, 50, event_rows=True)


def on_a_table() -> Solution:
    m = Mechanism("rolling", gravity=None)
    table, wheel, arm = m.bar("table", 0.4), m.body("wheel"), m.bar("arm", 0.25)
    m.revolute("O", m.ground.origin, table.start)
    m.rolling_disc("on", table.at(0, 0.03), wheel.origin, 0.04)
    m.revolute("A", m.ground.at(0.2, 0.3), arm.start)
    m.revolute("W", arm.end, wheel.origin)
    m.drive_angle("motor", table, harmonic(0.1, 2.0))
    m.start_near(table=0, arm=-80, wheel=(0.23, 0.07, 0))
    return m.sweep(3.2, steps=100)


ALL = {
    "bowl": (in_a_bowl, True),
    "round": (round_a_disc, False),
    "hollow": (lambda: in_a_ring(False), True),
    "cup": (lambda: in_a_ring(True), True),
    "peg": (on_a_peg, False),
    "tray": (on_a_tray, False),
    "table": (on_a_table, False),
}


def made_of(solution: Solution) -> tuple[Automatic, Track]:
    made = Automatic(solution.mechanism, solution)
    [track] = made.layout.select(Track)
    return made, track


@pytest.mark.parametrize("name", ALL)
def test_what_runs_on_a_track_is_clear_of_it_by_the_clearance(name: str) -> None:
    build, inside = ALL[name]
    made, track = made_of(build())
    assert track.inside == inside
    part = track.carried
    away = distances(made.layout.seen(part.body, part.at, track.body), track.path)
    assert 0.05 < (away.min() - part.built_radius) * made.sizes.scale < 1.5
    assert not meets(made)


@pytest.mark.parametrize("name", ["cup", "tray"])
def test_none_of_its_parts_touch(name: str) -> None:
    solution = ALL[name][0]()
    outcome = parts_of(solution.mechanism, solution)
    assert outcome.state == "built", outcome


@pytest.mark.parametrize("name", ["bowl", "round", "peg", "table"])
def test_tracks_are_sound_solids(name: str) -> None:
    made, track = made_of(ALL[name][0]())
    solids = made.solids(engraved_too=False)
    [wall] = [solid for solid in solids[track.body] if solid.name == f"track_{track.name}"]
    assert wall.through_holes == int(track.inside) + (name == "round")  # for the pivot of its arm
    for body in {track.body, track.carried.body} - {"ground"}:
        assert solids[body][0].shape.val().isValid()
    box, other = wall.shape.val().BoundingBox(), solids[track.carried.body][0].shape.val().BoundingBox()
    assert wall.shape.val().isValid()
    middle = (other.zmin + other.zmax) / 2
    assert box.zmin < middle < box.zmax


@pytest.mark.parametrize("scale", [0.1, 30.0])
def test_rings_grow_with_the_mechanism(scale: float) -> None:
    made, track = made_of(in_a_bowl(scale))
    assert np.ptp(track.path[:, 0]) == pytest.approx(made.sizes.of_metres(0.52 * scale), rel=1e-3)
    assert not meets(made)


def test_a_circle_has_what_it_carries_on_its_left() -> None:
    for inside in (True, False):
        path = circle((3.0, -2.0), 50.0, inside)
        assert turns_left(path) == inside
        out = ((path - [3.0, -2.0]) * normals(path)).sum(axis=1) / 50.0
        assert out == pytest.approx(np.full(len(path), -1.0 if inside else 1.0))


def test_a_disc_that_stands_on_ground_is_refused() -> None:
    m = Mechanism("plank", gravity=None)
    plank = m.bar("plank", 0.4)
    m.rolling_disc("on", plank.at(0, 0.03), m.ground.origin, 0.04)
    m.drive_angle("motor", plank, harmonic(0.1, 2.0))
    m.start_near(plank=(-0.2, -0.07, 0))
    with pytest.raises(UserError, match="'on' is a rolling disc whose disc is on ground"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).levels
