"""Stands by themselves: below all that moves, wide enough, in a turned world, of sound pieces that do not overlap."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, Solution, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.loading.wishes import wishing
from shared.contract import consistency
from shared.contract.materials import MATERIALS
from shared.contract.parts import Kind
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from tools.hunt_parts.case import meshed, overlapping, proven
from tools.models.shaft_machines import V_TWO, engine

STEPS, PIN = 90, 8.0


def crank_rocker(turn: float = 0.0, gravity: float = 9.81) -> Mechanism:
    """A four-bar whose crank goes below its back plate, all of it turned by ``turn`` (rad) with its gravity."""
    c, s = math.cos(turn), math.sin(turn)
    m = Mechanism("rocker", gravity=(gravity * s, -gravity * c))
    crank, coupler, rocker = m.bar("crank", 0.06), m.bar("coupler", 0.16), m.bar("rocker", 0.11)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.15 * c, 0.15 * s), rocker.start)
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=math.degrees(turn), coupler=math.degrees(turn) + 40, rocker=math.degrees(turn) + 90)
    return m


def pendulum() -> Mechanism:
    """A rod that swings to both sides of its pivot."""
    m = Mechanism("hanging")
    rod = m.bar("rod", 0.3)
    m.revolute("pivot", m.ground.at(0, 0), rod.start)
    m.drive_angle("motor", rod, lambda t: -math.pi / 2 + 1.2 * math.sin(2 * math.pi * t))
    m.start_near(rod=-90)
    return m


def stood(m: Mechanism, solution: Solution, kind: Kind | None = None, pin: float | None = PIN) -> Bodies:
    with wishing(kind):
        return Automatic(m, solution, pin).solids(engraved_too=False).on_stand()


def named(bodies: Bodies, name: str) -> Solid:
    return next(solid for solid in bodies["ground"] if solid.name == name)


def heights(bodies: Bodies, solution: Solution, up: tuple[float, float]) -> float:
    """How low the vertices of all that moves ever are (mm), from their meshes."""
    lowest = math.inf
    for piece in meshed(bodies):
        if piece.body == "ground":
            continue
        places = np.asarray(piece.triangles).reshape(-1, 3)[:, :2]
        pose = solution.body(piece.body)
        for x, y, theta in zip(1000 * pose.x, 1000 * pose.y, pose.theta, strict=True):
            c, s = math.cos(theta), math.sin(theta)
            seen = (places @ np.array([[c, s], [-s, c]]) + [x, y]) @ np.array(up)
            lowest = min(lowest, float(seen.min()))
    return lowest


@pytest.fixture(scope="module")
def standing() -> tuple[Mechanism, Solution, Bodies]:
    m = crank_rocker()
    solution = m.sweep(steps=STEPS)
    return m, solution, stood(m, solution)


def test_the_foot_is_below_all_that_moves_and_no_lower_than_it_needs(
    standing: tuple[Mechanism, Solution, Bodies],
) -> None:
    _, solution, bodies = standing
    foot = named(bodies, "stand_foot").shape.val().BoundingBox()
    lowest = heights(bodies, solution, (0.0, 1.0))
    assert 1.0 < lowest - foot.ymax < 30.0
    assert bodies.mount == ("stand", (0.0, 1.0, 0.0))


def test_its_pieces_are_sound_do_not_overlap_and_touch_nothing(standing: tuple[Mechanism, Solution, Bodies]) -> None:
    m, solution, bodies = standing
    pieces = meshed(bodies)
    assert not overlapping(pieces)
    assert "nearest" in proven(m, solution, bodies, pieces)
    names = {solid.name for solid in bodies["ground"]}
    assert {"stand_column", "stand_foot", "stand_screw_1", "stand_screw_4", "foot_screw_2", "stand_pad_4"} <= names
    assert not any(name.startswith(("corner_screw", "foot_1")) for name in names)


def tipping(bodies: Bodies, solution: Solution, up: tuple[float, float]) -> float:
    """The least tilt (rad), to any side and at any time, at which the machine falls over, by its solids' masses."""
    right = np.array([up[1], -up[0]])
    foot = named(bodies, "stand_foot").shape
    corners = np.array([vertex.toTuple() for vertex in foot.vertices().vals()])
    across, along = corners[:, :2] @ right, corners[:, 2]
    ground = float((corners[:, :2] @ np.array(up)).min())
    mass, moment = 0.0, np.zeros((len(solution.t), 3))
    for body, solids in bodies.items():
        for solid in solids:
            shape = solid.shape.val()
            weight, centre = MATERIALS[solid.material].density * shape.Volume(), shape.Center()
            if body == "ground":
                x, y = np.full(len(solution.t), centre.x), np.full(len(solution.t), centre.y)
            else:
                pose = solution.body(body)
                c, s = np.cos(pose.theta), np.sin(pose.theta)
                x = 1000 * pose.x + c * centre.x - s * centre.y
                y = 1000 * pose.y + s * centre.x + c * centre.y
            mass += weight
            moment += weight * np.column_stack([x, y, np.full(len(x), centre.z)])
    centres = moment / mass
    high, there = centres[:, :2] @ np.array(up) - ground, centres[:, :2] @ right
    sides = [there - across.min(), across.max() - there, centres[:, 2] - along.min(), along.max() - centres[:, 2]]
    return float(min(np.arctan2(side, high).min() for side in sides))


@pytest.mark.parametrize("m", [crank_rocker(), pendulum(), engine(V_TWO)], ids=lambda m: m.name)
def test_no_stand_tips_before_ten_degrees(m: Mechanism) -> None:
    solution = m.sweep(duration=1.0, steps=STEPS)
    assert tipping(stood(m, solution, pin=None), solution, (0.0, 1.0)) > math.radians(9.9)


@pytest.mark.parametrize("turn", [0.4, math.pi / 2, 2.5])
def test_in_a_turned_world_it_is_the_same_stand(standing: tuple[Mechanism, Solution, Bodies], turn: float) -> None:
    _, _, plain = standing
    m = crank_rocker(turn)
    bodies = stood(m, m.sweep(steps=STEPS))
    assert bodies.mount is not None
    assert bodies.mount[1] == pytest.approx((-math.sin(turn), math.cos(turn), 0.0))
    for name in ("stand_column", "stand_foot", "base_plate"):
        shape = named(bodies, name).shape.rotate((0, 0, 0), (0, 0, 1), -math.degrees(turn)).val()
        other = named(plain, name).shape.val()
        assert shape.Volume() == pytest.approx(other.Volume(), rel=1e-3)
        assert shape.Center().toTuple() == pytest.approx(other.Center().toTuple(), abs=0.1)


@pytest.mark.parametrize("kind", ["desk", "wall"])
def test_what_moves_weighs_the_same_however_it_stands(standing: tuple[Mechanism, Solution, Bodies], kind: Kind) -> None:
    m, solution, bodies = standing
    other = stood(m, solution, kind)
    assert other.mount is not None
    assert other.mount[0] == kind
    names = {solid.name for solid in other["ground"]}
    assert {"corner_screw_4", "foot_4"} <= names
    assert not any(name.startswith("stand") for name in names)
    for body in ("crank", "coupler", "rocker"):
        assert [solid.shape.val().Volume() for solid in other[body]] == [
            solid.shape.val().Volume() for solid in bodies[body]
        ]


def test_without_gravity_it_lies_and_what_an_author_adds_is_above_the_foot() -> None:
    m = crank_rocker(gravity=0.0)
    solution = m.sweep(steps=STEPS)
    assert Automatic(m, solution).solids(engraved_too=False).mount == ("desk", (0.0, 0.0, 1.0))
    m = crank_rocker()
    bodies = Automatic(m, m.sweep(steps=STEPS)).solids(engraved_too=False)
    crank = bodies["crank"][0]
    weight = Solid("weight", crank.shape.translate((100.0, 0.0, 0.0)), "steel", crank.through_holes)
    plain = named(bodies.on_stand(), "stand_foot").shape.val().BoundingBox().ymax
    bodies["crank"].append(weight)
    assert named(bodies.on_stand(), "stand_foot").shape.val().BoundingBox().ymax < plain - 90.0


def vehicle(gravity: float = -9.81) -> Mechanism:
    """A wheel that rolls along level ground."""
    m = Mechanism("roller", gravity=(0.0, gravity))
    wheel = m.body("wheel", 1.0, inertia=0.01)
    m.rolling_disc("rolls", m.ground.at(0, 0), wheel.origin, 0.1)
    m.drive_angle("motor", wheel, constant_rate(-2.0))
    m.start_near(wheel=(0.0, 0.1, 0.0))
    return m


def test_a_wheel_on_its_road_stands_on_the_ground_without_a_plate() -> None:
    m = vehicle()
    bodies = stood(m, m.sweep(duration=1.0, steps=STEPS))
    assert bodies.mount == ("ground", (0.0, 1.0, 0.0))
    names = {solid.name for solid in bodies["ground"]}
    assert "ground_slab" in names
    assert not any(name.startswith(("base_plate", "stand")) for name in names)
    road = next(solid for solid in bodies["ground"] if solid.name.startswith("road")).shape.val().BoundingBox()
    slab = named(bodies, "ground_slab").shape.val().BoundingBox()
    assert 0.0 < road.ymin - slab.ymax < 0.5
    assert slab.xmin < road.xmin < road.xmax < slab.xmax
    under = vehicle(9.81)  # held from below, against gravity: that is no road
    assert Automatic(under, under.sweep(duration=1.0, steps=STEPS)).mount.kind == "stand"


def test_parts_json_takes_what_stands(standing: tuple[Mechanism, Solution, Bodies]) -> None:
    m, solution, _ = standing
    for kind in (None, "wall", "desk", "ground"):
        with wishing(kind):
            consistency.refuse_wrong_mount(Automatic(m, solution).mount, "here")
