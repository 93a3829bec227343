"""Several wheels on one surface of ground: one road under them all."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate, curve
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.rolling.roads import Road, along, with_shared_roads
from shared.shapes.outline import distances
from tests.mechanisms.automatic.layouts import meets
from tests.shared.shape_checks import checked

HILLS = [(-0.6 + 0.2 * k, 0.006 * (-1) ** k) for k in range(9)]
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
            m.rolling_on_curve(on, ground, wheel.origin, HILLS, 0.04)
        elif surface == "wall":
            m.rigid_contact(on, ground, wheel.origin, 0.04, friction=0.5)
        elif surface == "terrain":
            m.rigid_terrain(on, ground, wheel.origin, HILLS, 0.04, friction=0.5)
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
    return [feature for feature in made.layout.features if isinstance(feature, Road)]


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
