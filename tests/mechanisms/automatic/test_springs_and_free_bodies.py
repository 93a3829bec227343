"""Springs with their studs, bodies without joints, and marks on rims."""

from __future__ import annotations

import math
from functools import cache
from itertools import combinations

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, four_stroke
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.planar import Rounded, least_gap
from mechanisms.stages.automatic.pins.free_bodies import BASE, TIP, WALL, FreeBody, RimMark, Stylus
from mechanisms.stages.automatic.pins.springs import Stretching, Stud
from mechanisms.stages.parts.meshes import mass_of
from shared.contract.materials import MATERIALS
from shared.shapes.screw import Collar, ball_stud
from tests.mechanisms.automatic.proofs import meets
from tools.hunt_parts.case import parts_of
from tools.hunt_parts.outcome import BUILT

# Springs with automatic parts: studs where their ends are, and a layer in which nothing meets them.


def crank_rocker(scale: float = 1.0, turn: float = 0.0) -> Mechanism:
    """With a spring on pins at both ends, another and a damper from one place of ground, and an actuator."""
    m = Mechanism("sprung", gravity=None)

    def ground(x: float, y: float):
        c, s = math.cos(turn), math.sin(turn)
        return m.ground.at(scale * (c * x - s * y), scale * (s * x + c * y))

    crank, coupler, rocker = (
        m.bar(name, scale * at) for name, at in (("crank", 0.1), ("coupler", 0.3), ("rocker", 0.25))
    )
    m.revolute("A", ground(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", ground(0.3, 0), rocker.start)
    m.spring("on_pins", ground(0.3, 0), coupler.start, 100.0, free_length=0.1)
    m.spring("return", ground(0.1, -0.12), rocker.at(scale * 0.12, 0), 100.0)
    m.spring_law("damper", ground(0.1, -0.12), rocker.at(scale * 0.06, 0), lambda length, rate: -rate)
    m.actuator("push", ground(0.5, 0.2), rocker.at(scale * 0.12, 0), 1.0)
    m.drive_angle("motor", crank, constant_rate(6.0))
    m.start_near(crank=60 + math.degrees(turn), coupler=20 + math.degrees(turn), rocker=100 + math.degrees(turn))
    return m


@cache
def planned(scale: float = 1.0, turn: float = 0.0) -> Automatic:
    m = crank_rocker(scale, turn)
    return Automatic(m, m.sweep())


def springs(made: Automatic) -> dict[str, Stretching]:
    return {feature.force: feature for feature in made.layout.select(Stretching)}


@pytest.mark.parametrize(("scale", "turn"), [(1.0, 0.0), (0.1, 1.0), (30.0, -2.0)])
def test_what_the_film_draws_of_a_spring_meets_no_plate_and_no_other_spring(scale: float, turn: float) -> None:
    made = planned(scale, turn)
    heights, poses = made.heights, made.layout.poses
    drawn = springs(made)
    assert set(drawn) == {"on_pins", "return", "damper", "push"}
    for spring in drawn.values():
        along = Rounded(spring.path[:, :, :], spring.outer)
        for body in made.layout.moving:
            low, high = heights.bottom(body), heights.top(body)
            if low > spring.z(heights) + spring.outer or high < spring.z(heights) - spring.outer:
                continue
            gap, _ = least_gap(along, made.layout.outline(body), (poses[spring.layer], poses[body]), 0.0)
            assert gap > 0, f"{spring.force} cuts {body}"
        for other in drawn.values():
            if other is not spring and abs(other.z(heights) - spring.z(heights)) < spring.outer + other.outer:
                gap, _ = least_gap(
                    along, Rounded(other.path, other.outer), (poses[spring.layer], poses[other.layer]), 0.0
                )
                assert gap > 0, f"{spring.force} cuts {other.force}"


def test_springs_lie_over_their_bodies_and_over_the_pins_that_hold_them() -> None:
    made = planned()
    for stud in made.layout.select(Stud):
        bodies = [b for b in (stud.pin.movers if stud.pin else [stud.body]) if b != "ground"]
        assert all(made.decided[spring.layer] > made.levels[body] for spring, _ in stud.ends for body in bodies)


def test_ends_on_one_place_share_a_stud() -> None:
    made = planned()
    studs = {frozenset((spring.force, end) for spring, end in f.ends) for f in made.layout.select(Stud)}
    assert frozenset({("return", 0), ("damper", 0)}) in studs
    assert frozenset({("return", 1), ("push", 1)}) in studs
    assert len(studs) == 6


def test_every_end_is_held_where_it_is() -> None:
    """The ball's middle is on the marker, at the height that the film is told."""
    made = planned()
    scale = made.sizes.scale
    held: dict[str, list[tuple[float, float]]] = {}
    for body, solids in made.solids(engraved_too=False).items():
        for solid in solids:
            for hold in solid.holds:
                low, high = solid.shape.val().BoundingBox().zmin, solid.shape.val().BoundingBox().zmax
                assert low < hold.z < high
                spring = springs(made)[hold.force]
                assert (hold.z, hold.radius) == pytest.approx((spring.z(made.heights) * scale, spring.radius * scale))
                ball = solid.shape.val().BoundingBox().center
                pose = made.layout.poses[body][0]
                c, s = math.cos(pose[2]), math.sin(pose[2])
                place = [pose[0] + (c * ball.x - s * ball.y) / scale, pose[1] + (s * ball.x + c * ball.y) / scale]
                assert np.linalg.norm(spring.path[0] - place, axis=1).min() < 1e-6
                held.setdefault(hold.force, []).append((place[0], place[1]))
    assert {force: len(set(places)) for force, places in held.items()} == dict.fromkeys(springs(made), 2)


def test_a_spring_that_shrinks_to_nothing_gets_no_studs() -> None:
    m = Mechanism("through")
    block = m.body("block", 1.0)
    m.prismatic("rail", m.ground.origin, block.origin)
    m.spring("spring", m.ground.origin, block.origin, 100.0)
    m.start_near(block=(0.1, 0, 0))
    made = Automatic(m, m.simulate(0.5))
    assert not springs(made)
    assert not [solid for solids in made.solids(engraved_too=False).values() for solid in solids if solid.holds]


def test_a_spring_without_room_is_left_out_and_told(capsys: pytest.CaptureFixture[str]) -> None:
    """From the crank's middle no stud goes up: the coupler passes over it."""
    m = crank_rocker()
    m.actuator("pull", m.bodies["crank"].at(0.05, 0.05), m.bodies["rocker"].at(0.12, 0), 1.0)
    made = Automatic(m, m.sweep())
    assert set(springs(made)) == {"on_pins", "return", "damper", "push"}
    assert "sprung: no order of layers leaves room for pull beside the others" in capsys.readouterr().err


GASES = {
    "gas": lambda m, i, j: m.gas("gas", i, j, 1e-3, 1.1e5, 0.2),
    "gas_cycle": lambda m, i, j: m.gas_cycle("gas", i, j, "block", four_stroke(3.0), 0.04, 0.0, stroke=0.3, top=0.05),
    "gas_strut": lambda m, i, j: m.gas_strut("gas", i, j, 30.0, 1.3, 0.25, 0.15, extension_damping=20.0),
    "hydraulic_cylinder": lambda m, i, j: m.hydraulic_cylinder(
        "gas", i, j, bore=0.02, rod=0.012, stroke=0.15, retracted=0.12, supply=2e6, valve=0.01, rated_flow=1e-4
    ),
}


@pytest.mark.parametrize(
    ("gas", "aside", "held"),
    [
        ("gas", 0.0, True),
        ("gas", 0.02, False),
        ("gas_cycle", 0.0, True),
        ("gas_cycle", 0.02, False),
        ("gas_strut", 0.02, True),
        ("hydraulic_cylinder", 0.02, True),
    ],
)
def test_gas_has_a_cylinder_where_its_piston_is_on_its_axis(gas: str, aside: float, held: bool) -> None:
    m = Mechanism("shock")
    block = m.body("block", 1.0)
    m.prismatic("rail", m.ground.at(0, 0, 0.4), block.at(0, 0, 0.4))
    GASES[gas](m, m.ground.at(-0.2 * math.cos(0.4), -0.2 * math.sin(0.4), 0.4), block.at(0, aside))
    m.start_near(block=(0.0, 0.0, 0.0))
    made = Automatic(m, m.simulate(0.2, 60))
    assert set(springs(made)) == ({"gas"} if held else set())
    if held:
        cylinder = springs(made)["gas"]
        assert cylinder.outer == pytest.approx(0.6 * cylinder.radius)


def test_a_moving_core_is_looked_at_pose_by_pose() -> None:
    """A line that grows from 1 to 5 touches a disc at 6 only at the end."""
    still = np.zeros((9, 3))
    ends = np.linspace(1.0, 5.0, 9)
    core = np.stack([np.zeros((9, 2)), np.column_stack([ends, 0 * ends])], axis=1)
    gap, at = least_gap(Rounded(core, 0.1), Rounded(np.array([[6.0, 0.0]]), 0.4), (still, still), 0.51)
    assert (gap, at) == (pytest.approx(0.5), 8)


@pytest.mark.parametrize("balls", [[20.0], [12.0, 20.0], [0.0, 20.0]])
def test_ball_studs_are_one_solid(balls: list[float]) -> None:
    shape = ball_stud(4.0, 0.0, 20.0, balls, 3.5, [Collar(4.5, 1.4, 4.5)])
    assert shape.val().isValid()
    box = shape.val().BoundingBox()
    assert box.xmax == pytest.approx(4.5)
    assert box.zmin == pytest.approx(0.0 if balls[0] else -3.5 * math.sqrt(1 - 0.35**2), abs=1e-6)


def test_a_stud_whose_balls_overlap_is_refused() -> None:
    with pytest.raises(ValueError, match="overlap between"):
        ball_stud(4.0, 0.0, 20.0, [18.0, 20.0], 3.5)


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
def test_a_ball_on_a_rope_has_room_for_the_collar_of_its_stud(scale: float) -> None:
    """The rope is thinner than a plate, so that it asks for no room beside its layer."""
    m = Mechanism("bob")
    mass = m.body("mass", mass=1.0, inertia=0.1 * scale**2)
    m.rope("rope", m.ground.at(0, 0), mass.origin, length=0.3 * scale)
    m.start_near(mass=(0.1 * scale, -0.25 * scale, 0))
    made = Automatic(m, m.simulate(0.2, steps=20))
    (stud,) = [solid for solid in made.solids(False)["mass"] if solid.name.startswith("stud_")]
    assert stud.shape.val().isValid()


# Bodies that no joint shapes: balls and discs whose size tells their mass; weights at the ends of bars.


def free(made: Automatic) -> dict[str, FreeBody]:
    return {feature.body: feature for feature in made.layout.select(FreeBody)}


def thrown(masses: dict[str, float], apart: float = 0.3, scale: float = 1.0) -> Automatic:
    """Bodies side by side that fly up, and one more that no mechanism is without: their scale."""
    m = Mechanism("thrown", gravity=(0.0, -9.81))
    for k, (name, mass) in enumerate(masses.items()):
        m.body(name, mass, inertia=1e-4)
        m.start_near(**{name: (scale * apart * k, 0, 0)})
        m.start_moving(**{name: (0, 1.0, 0)})
    return Automatic(m, m.simulate(0.2, 40))


@pytest.mark.parametrize("scale", [0.1, 1.0, 30.0])
def test_sizes_tell_masses_apart(scale: float) -> None:
    bodies = free(thrown({"light": 0.3, "heavy": 2.4}, scale=scale))
    assert all(body.is_ball for body in bodies.values())
    assert bodies["heavy"].radius == pytest.approx(2 * bodies["light"].radius)


def test_a_ball_that_may_weighs_what_is_given() -> None:
    made = thrown({"one": 0.1, "other": 0.08}, apart=0.2)
    assert 14 < made.layout.sizes.of_metres((3 * 0.1 / (4 * math.pi * 2700)) ** (1 / 3)) < 20
    for body, mass in (("one", 0.1), ("other", 0.08)):
        solid = made.solids(engraved_too=False)[body][0]
        weight = mass_of(solid.shape.solids().vals()[0], MATERIALS[solid.material].density)
        assert weight.mass == pytest.approx(mass, rel=1e-3)
        assert weight.com == pytest.approx((0.0, 0.0), abs=1e-6)


def test_balls_that_pass_close_are_smaller() -> None:
    made = thrown({"a": 1.0, "b": 1.0, "c": 1.0, "d": 1.0}, apart=0.02)
    bodies = free(made)
    for a, b in combinations(bodies.values(), 2):
        ways = [made.layout.seen(body.body, (body.x, body.y), "ground") for body in (a, b)]
        assert a.radius + b.radius < np.linalg.norm(ways[0] - ways[1], axis=1).min()
    assert set(made.levels.values()) == {0}


def test_what_springs_hold_is_a_disc_with_their_studs() -> None:
    m = Mechanism("hung", gravity=(0.0, -9.81))
    disc = m.body("disc", 0.3, inertia=1e-4)
    m.spring("left", m.ground.at(-0.1, 0.1), disc.at(-0.01, 0), 100.0, free_length=0.08)
    m.spring("right", m.ground.at(0.1, 0.1), disc.at(0.01, 0), 100.0, free_length=0.08)
    m.start_near(disc=(0, 0, 0))
    made = Automatic(m, m.simulate(0.5))
    body = free(made)["disc"]
    assert not body.is_ball
    pieces = made.solids(engraved_too=False)["disc"]
    assert [piece.name for piece in pieces] == ["disc", "stud_left_2", "stud_right_2"]
    box = pieces[0].shape.val().BoundingBox()
    assert box.ymax - box.ymin == pytest.approx(2 * body.radius * made.sizes.scale, rel=0.02)


def test_a_bob_has_its_weight_where_it_is_traced_too() -> None:
    m = Mechanism("bob", gravity=(0.0, -9.81))
    rod = m.bar("rod", 0.3, 0.5, com=(0.3, 0), inertia=0.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.trace("tip", rod.end)
    m.start_near(rod=-60)
    names = [piece.name for piece in Automatic(m, m.simulate(0.2)).solids(engraved_too=False)["rod"]]
    assert "weight_rod" in names
    assert not [name for name in names if name.startswith(("stylus", "point"))]


# Marks of traced points on rims: a pin within the rim, and a pointer over what the wheel runs on or meshes with.


def _wheel(out: float, radius: float = 0.05) -> Mechanism:
    """A wheel that rolls on a road, with a point at ``out`` radii: a trochoid."""
    m = Mechanism("cycloid")
    wheel = m.body("wheel")
    m.rolling_disc("road", m.ground.origin, wheel.origin, radius)
    m.drive_angle("motor", wheel, constant_rate(-2 * math.pi))
    m.trace("P", wheel.at(0, -radius * out))
    m.start_near(wheel=(0, radius, 0))
    return m


def _planet(out: float, internal: bool, fixed: float = 0.09, radius: float = 0.03) -> Mechanism:
    """A gear that rolls in a ring or round a wheel, with a point at ``out`` pitch radii."""
    m = Mechanism("hypocycloid")
    arm, planet = m.body("arm"), m.body("planet")
    m.revolute("O", m.ground.origin, arm.origin)
    m.revolute("A", arm.at(fixed - radius if internal else fixed + radius, 0), planet.origin)
    m.gear_pair("mesh", m.ground.origin, planet.origin, fixed, radius, internal=internal)
    m.drive_angle("motor", arm, constant_rate(2 * math.pi))
    m.trace("P", planet.at(radius * out, 0))
    m.start_near(arm=0, planet=0)
    return m


def _planned(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep(times=np.linspace(0, 1, 121)))


@pytest.mark.parametrize(
    "m",
    [
        _wheel(1.0),
        _wheel(0.95),
        _wheel(1.3),
        _planet(1.0, True),
        _planet(1.0, False),
        _planet(0.95, True),
        _planet(1.4, True),
    ],
    ids=["cycloid", "within", "prolate", "hypocycloid", "epicycloid", "within teeth", "beyond teeth"],
)
def test_a_point_on_a_rim_gets_a_pointer_from_within(m: Mechanism) -> None:
    """An eye there broke the teeth, or met the road."""
    made = _planned(m)
    assert not meets(made)
    (mark,) = made.layout.select(RimMark)
    assert mark.points
    marker = m.traces["P"]
    assert (mark.x, mark.y) == pytest.approx(made.layout.place(marker))
    (face,) = [
        face
        for feature in made.layout.features
        if (find := getattr(feature, "face_of", None)) and (face := find(mark.body, made.layout))
    ]
    reach = math.hypot(*mark.at) + mark.radius
    assert reach <= face.inner - WALL + 1e-9
    assert math.hypot(*mark.at) - mark.radius > made.sizes.hardware or mark.body == "wheel"
    assert all(math.hypot(a.x, a.y) <= face.inner for a in made.layout.anchors[mark.body])


@pytest.mark.parametrize("out", [0.72, 0.74, 0.76, 0.78, 0.8, 0.83])
def test_the_tip_of_a_pointer_is_never_under_its_collar(out: float) -> None:
    """A point just beyond the place of the pin: an outline round both has no sides."""
    m = _wheel(out)
    made = Automatic(m, m.sweep(times=np.linspace(0, 1, 61)), pin=16.0)
    for mark in (mark for mark in made.layout.select(RimMark) if mark.points):
        assert math.dist(mark.at, (mark.x, mark.y)) + TIP > mark.radius + BASE
    made.plan()


def test_a_point_well_within_a_wheel_keeps_its_stylus() -> None:
    made = Automatic(m := _wheel(0.5, 0.2), m.sweep(times=np.linspace(0, 1, 61)), pin=8.0)
    assert any(isinstance(feature, Stylus) for feature in made.layout.features)
    assert not any(isinstance(feature, RimMark) for feature in made.layout.features)


def test_a_wheel_too_small_for_a_mark_gets_none() -> None:
    made = Automatic(m := _planet(1.0, True), m.sweep(times=np.linspace(0, 1, 61)), pin=20.0)
    assert not any(isinstance(feature, Stylus | RimMark) for feature in made.layout.features)


def test_the_pointer_of_a_cycloid_is_built_and_clear_of_the_road() -> None:
    m = _wheel(1.0)
    outcome = parts_of(m, m.sweep(times=np.linspace(0, 1, 61)), engraved=False)
    assert outcome.state == BUILT, outcome.detail
