"""A road reaches what base_under asks for, where gravity holds a wheel on it."""

from __future__ import annotations

import math

import pytest

from mbsd import Mechanism, constant_rate, curve
from mechanisms.automatic import automatic


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
