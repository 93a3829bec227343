"""Discs and points that touch walls, roads and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mbsd.model.laws.curve import curve
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.cams import Cam
from mechanisms.stages.automatic.rolling.roads import Road
from mechanisms.stages.automatic.rolling.rounds import Round
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.facets import volume_of
from shared.shapes.outline import distances
from shared.stage.errors import UserError
from tools.hunt_parts import case
from tools.hunt_parts.outcome import BUILT


def _room(scale: float = 1.0, turn: float = 0.0, stiffness: float = 0.0) -> Mechanism:
    """A ball that falls aslant into a corner of floor and wall, all turned by ``turn`` (rad)."""
    c, s = math.cos(turn), math.sin(turn)
    m = Mechanism("room", gravity=(9.81 * scale * s, -9.81 * scale * c))
    ball = m.body("ball", mass=0.1, inertia=1e-5)
    for name, angle in (("floor", 0.0), ("left", -math.pi / 2)):
        wall = m.ground.at(0, 0, turn + angle)
        if stiffness:
            m.contact(name, wall, ball.origin, stiffness, radius=0.02 * scale)
        else:
            m.rigid_contact(name, wall, ball.origin, 0.02 * scale, restitution=0.6)
    x, y = 0.1 * scale, 0.15 * scale
    m.start_near(ball=(c * x - s * y, s * x + c * y, 0))
    m.start_moving(ball=(-c * scale, -s * scale, 0))
    return m


def _planned(m: Mechanism, duration: float = 0.5, steps: int = 300) -> tuple[Automatic, list[Round], list[Road]]:
    made = Automatic(m, m.simulate(duration, steps, event_rows=True))
    return made, made.layout.select(Round), made.layout.select(Road)


@pytest.mark.parametrize("stiffness", [0.0, 1e6])
def test_an_eye_in_a_point_that_touches_is_clear_of_its_wall(stiffness: float) -> None:
    """A stone on a sling lies in the trough of a trebuchet: the eye of its pin is larger than the stone."""
    m = Mechanism("trebuchet", gravity=(0, -9.81))
    arm, stone = m.bar("arm", 1.0, mass=2.0), m.body("stone", mass=0.5, inertia=1e-4)
    m.revolute("axle", m.ground.at(0, 0.8), arm.start)
    m.distance("sling", arm.end, stone.origin, length=0.9)
    if stiffness:
        m.contact("trough", m.ground.origin, stone.origin, stiffness)
    else:
        m.rigid_contact("trough", m.ground.origin, stone.origin, friction=0.3)
    m.torque("weight", arm, -40.0)
    tip = (-math.sqrt(1.0 - 0.6**2), 0.2)
    m.start_near(arm=(0, 0.8, math.atan2(tip[1] - 0.8, tip[0])), stone=(tip[0] + math.sqrt(0.77), 0, 0))
    solution = m.simulate(0.2, steps=40, event_rows=True)
    assert np.ptp(solution.body("stone").x) > 0.05
    outcome = case.parts_of(m, solution, engraved=False)
    assert outcome.state == BUILT, outcome.detail


@settings(max_examples=6, deadline=None)
@given(st.sampled_from([0.1, 1.0, 30.0]), st.floats(-math.pi, math.pi))
def test_one_ball_and_walls_that_meet_in_a_corner(scale: float, turn: float) -> None:
    made, (ball,), walls = _planned(_room(scale, turn))
    assert ball.look == "ball"
    assert [wall.name for wall in walls] == ["floor", "left"]
    np.testing.assert_allclose(walls[0].path[0], walls[1].path[1], atol=1e-6)  # in the corner
    np.testing.assert_allclose(walls[0].feet[1], walls[1].feet[0], atol=1e-6)  # and behind it
    places = made.layout.seen("ball", ball.at, "ground")
    for wall in walls:
        least = float((distances(places, wall.path) - ball.built_radius).min()) * made.sizes.scale
        assert 0.05 < least < 0.5  # mm


def test_what_presses_in_a_little_is_smaller_by_as_much_else_the_two_may_touch() -> None:
    for stiffness, visible in ((3e3, True), (3e8, False)):
        made, (ball,), (floor, _) = _planned(_room(stiffness=stiffness), steps=4000)
        places = made.layout.seen("ball", ball.at, "ground")
        pressed = ball.radius - float(distances(places, floor.path).min())
        assert pressed > 0
        clear = ball.short - (0.0 if visible else pressed)
        assert 0.05 < clear * made.sizes.scale < 0.5  # mm
        assert made.layout.yielding == ({frozenset(("ground", "ball"))} if visible else set())
        told = [(plan.outer[part], piece) for plan in [made.plan()] for part, _, piece in plan.pressing]
        assert told == ([("ball", "road_floor"), ("ball", "road_left")] if visible else [])


@pytest.mark.parametrize("stiffness", [0.0, 3000.0])
def test_ball_and_walls_are_sound(stiffness: float) -> None:
    made, _, walls = _planned(_room(stiffness=stiffness))
    plan = made.plan()
    (plate,) = plan.plates["ball"]
    shapes = [plate.shape, *(s.shape for s in plan.solids["ground"])]
    assert len(shapes) == 1 + len(walls)
    for shape in shapes:
        assert shape.val().isValid()
        assert shape.solids().size() == 1
    ball = plate.shape.val().BoundingBox()
    bottom = made.heights.bottom("ball")
    assert bottom + ball.zmin > 0
    assert max(s.shape.val().BoundingBox().zmax for s in plan.solids["ground"]) > bottom + (ball.zmin + ball.zmax) / 2


def test_friction_makes_a_wheel_and_a_point_gets_a_nose() -> None:
    m = Mechanism("hills", gravity=(0.0, -9.81))
    wheel, sledge = m.body("wheel", mass=0.2, inertia=4e-5), m.body("sledge", mass=0.3, inertia=1e-4)
    hills = [(x, 0.01 * math.cos(20 * x)) for x in np.linspace(-0.1, 0.5, 25)]
    m.rigid_terrain("hills", m.ground.origin, wheel.origin, hills, 0.03, friction=0.8)
    m.prismatic("rail", m.ground.at(0, 0.2), sledge.origin)
    m.contact("buffer", m.ground.at(0.3, 0.2, math.pi / 2), sledge.at(0.05, 0), 1e4, radius=0.0)
    m.start_near(wheel=(0, 0.045, 0), sledge=(0, 0.2, 0))
    m.start_moving(wheel=(0.6, 0, 0), sledge=(0.8, 0, 0))
    made, rounds, roads = _planned(m)
    looks = {part.body: part.look for part in rounds}
    assert looks == {"wheel": "wheel", "sledge": "disc"}
    nose = next(part for part in rounds if part.body == "sledge")
    buffer = next(road for road in roads if road.name == "buffer")
    model = made.sizes.of_metres(0.3)
    assert buffer.path[0, 0] - model == pytest.approx(nose.radius)  # both set back by the nose
    assert made.levels["wheel"] >= 0


def test_a_wheel_whose_road_would_reach_its_hub_is_refused() -> None:
    """Else the road would go through hub and rim."""
    m = Mechanism("car", gravity=(0.0, -9.81))
    wheel = m.body("wheel", mass=20.0, inertia=1.0)
    m.tyre("tyre", m.ground.origin, wheel.origin, 0.3, 50.0, damping=5.0)
    m.start_near(wheel=(0.0, 0.3, 0.0))
    made = Automatic(m, m.simulate(0.5, steps=60))
    with pytest.raises(
        UserError, match=r"car: 'tyre' lets the wheel of wheel be pressed .* mm .* make the contact stiffer"
    ):
        made.solids(engraved_too=False)


def test_profiles_of_tyres_reach_as_far_as_the_wheel() -> None:
    m = Mechanism("kerb", gravity=(0.0, -9.81))
    wheel = m.body("wheel", mass=10.0, inertia=0.4)
    bump = curve([0.5, 0.7, 0.9], [0.0, 0.05, 0.0])
    m.tyre("tyre", m.ground.origin, wheel.origin, 0.3, 5e4, damping=200.0, profile=bump)
    m.start_near(wheel=(0, 0.299, 0))
    m.start_moving(wheel=(4.0, 0, -4.0 / 0.3))
    made, (part,), (road,) = _planned(m)
    places = made.layout.seen("wheel", part.at, "ground")
    assert part.look == "wheel"
    assert road.path[0, 0] < places[:, 0].min() - part.radius
    assert road.path[-1, 0] > places[:, 0].max() + part.radius
    assert made.layout.yielding == {frozenset(("ground", "wheel"))}
    solids = made.solids(engraved_too=False)
    assert (solids.touching, solids.pieces_touching) == (set(), {("road_tyre", "tyre_tyre")})


def test_planks_of_a_bowl_end_where_they_meet() -> None:
    m = Mechanism("bowl", gravity=(0.0, -9.81))
    wheel = m.body("wheel", mass=0.2, inertia=4e-5)
    angles, places = np.radians([-40.0, -20.0, 0.0, 20.0, 40.0]), [np.zeros(2)]
    for k, angle in enumerate(angles):
        m.rigid_contact(f"plank{k}", m.ground.at(*places[-1], angle), wheel.origin, 0.03, friction=0.9)
        places.append(places[-1] + 0.15 * np.array([math.cos(angle), math.sin(angle)]))
    m.start_near(wheel=(0.06, 0.06, 0))
    made, (part,), planks = _planned(m, 1.0)
    assert part.look == "wheel"
    for k in (1, 2, 3):
        corners = planks[k].path / made.sizes.of_metres(1.0)
        np.testing.assert_allclose(corners, places[k : k + 2], atol=1e-9)
        np.testing.assert_allclose(planks[k].feet[0], planks[k + 1].feet[1], atol=1e-6)


def _valve(size: float = 1.0, roller: float = 0.012) -> Mechanism:
    """An eccentric disc of 60 mm that pushes a roller on a valve; ``size`` and ``roller`` (m) make others of it."""
    m = Mechanism("valve")
    disc, valve = m.body("disc", mass=0.2, inertia=1e-4), m.body("valve", mass=0.1, inertia=1e-5)
    m.revolute("shaft", m.ground.origin, disc.origin)
    m.prismatic("guide", m.ground.at(0, 0.12 * size, math.pi / 2), valve.at(0, 0.075 * size, math.pi / 2))
    angle = np.linspace(0, -2 * math.pi, 60, endpoint=False)
    eccentric = [(0.03 * size * math.cos(a), size * (0.006 + 0.03 * math.sin(a))) for a in angle]
    m.rigid_terrain("push", disc.origin, valve.origin, eccentric, roller * size, closed=True)
    m.spring("spring", m.ground.at(0, 0.2 * size), valve.at(0, 0.1 * size), 2000.0, free_length=0.1 * size)
    m.drive_angle("motor", disc, constant_rate(20.0))
    m.start_near(valve=(0, (0.036 + roller) * size, 0))
    return m


@pytest.mark.parametrize(("roller", "turns"), [(0.41, False), (0.5, False), (0.62, True), (1.0, True)])
def test_rollers_of_clockwork_are_sound(roller: float, turns: bool) -> None:
    """Clearances do not shrink below 0.16 mm: in a roller of 1 mm they left a wall that crossed itself."""
    made, _, _ = _planned(_valve(0.1, roller / 1e3 / 0.1), 0.4)
    (piece,) = [solid for solid in made.plan().solids["valve"] if solid.name == "roller_push"]
    shape = only_solid(piece.shape, "roller")
    check_mesh(read_mesh(stl_bytes(shape)), volume_of(shape), 1, "roller")
    assert (piece.rolls is not None) == turns


def test_a_roller_that_a_pin_fills_is_refused() -> None:
    m = _valve(0.1, 0.0003 / 0.1)
    with pytest.raises(UserError, match=r"roller of 'push' is 0\.408 mm in diameter, and on a pin of 0\.5 mm"):
        _planned(m, 0.4)[0].plan()


def test_a_closed_curve_that_pushes_is_a_cam_with_a_roller() -> None:
    made, _, _ = _planned(_valve(), 0.4)
    (cam,) = made.layout.select(Cam)
    scale = made.sizes.of_metres(1.0)
    assert cam.roller == pytest.approx(0.012 * scale - cam.clear)
    assert cam.base == pytest.approx(0.024 * scale, rel=1e-3)
    assert made.levels["disc"] != made.levels["valve"]
    names = {solid.name for solid in made.plan().solids["valve"]}
    assert {"roller_push", "pin_push"} <= names


def test_balls_that_meet_share_a_layer_and_never_touch() -> None:
    m = Mechanism("billiards", gravity=None)
    cue, ball = (m.body(name, mass=0.2, inertia=1e-5) for name in ("cue", "ball"))
    m.rigid_discs("hit", cue.origin, ball.origin, 0.02, 0.03, restitution=0.9)
    m.start_near(cue=(-0.2, 0, 0), ball=(0, 0.01, 0))
    m.start_moving(cue=(1.0, 0, 0))
    made, rounds, _ = _planned(m, 0.4)
    assert [part.look for part in rounds] == ["ball", "ball"]
    assert made.levels["cue"] == made.levels["ball"]
    apart = np.linalg.norm(made.layout.seen("cue", (0, 0), "ball"), axis=1).min()
    assert 0.05 < (apart - sum(part.built_radius for part in rounds)) * made.sizes.scale < 1.0  # mm
    assert set(made.solids(engraved_too=False)) == {"ground", "cue", "ball"}


def test_a_cradle_of_bars_with_discs_has_one_layer() -> None:
    m = Mechanism("cradle")
    bars = [m.bar(f"bar{k}", 0.15, mass=0.1) for k in range(3)]
    for k, bar in enumerate(bars):
        m.revolute(f"pin{k}", m.ground.at(0.05 * k, 0), bar.start)
        m.start_near(**{bar.name: -120 if k == 0 else -90})
    for k in (0, 1):
        m.rigid_discs(f"hit{k}", bars[k].end, bars[k + 1].end, 0.025, 0.025, restitution=1.0)
    made, rounds, _ = _planned(m, 0.5)
    assert [part.look for part in rounds] == ["disc"] * 3
    assert len({made.levels[bar.name] for bar in bars}) == 1
    assert all(solid.shape.val().isValid() for solids in made.solids(engraved_too=False).values() for solid in solids)


def test_a_box_on_two_feet_is_one_solid_without_tyres() -> None:
    m = Mechanism("box", gravity=(0.0, -9.81))
    box = m.body("box", mass=0.5, inertia=5e-4)
    for number, x in enumerate((-0.04, 0.04)):
        m.rigid_contact(f"foot{number}", m.ground.origin, box.at(x, -0.02), 0.006, friction=0.3)
    m.start_near(box=(0, 0.03, 0))
    made, rounds, _ = _planned(m)
    assert [part.look for part in rounds] == ["disc", "disc"]
    plate = made.solids(engraved_too=False)["box"][0]
    assert only_solid(plate.shape, "box").isValid()
