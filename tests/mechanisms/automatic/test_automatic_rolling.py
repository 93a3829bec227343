"""Wheels on roads by themselves: the road passes under the wheel all the way and stays clear of it."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mbsd.model.plane_curves import curve_pieces
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.curves import curve_path
from mechanisms.stages.automatic.rolling.roads import Road
from mechanisms.stages.automatic.rolling.rounds import Round
from shared.shapes.outline import distances

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


def _made(m: Mechanism) -> tuple[Automatic, Round, np.ndarray]:
    made = Automatic(m, m.sweep(1.0, 200))
    features = made.layout.features
    [wheel] = [feature for feature in features if isinstance(feature, Round)]
    [road] = [feature for feature in features if isinstance(feature, Road)]
    assert road.rounds == [wheel]
    return made, wheel, road.path


@pytest.mark.parametrize("curve", [False, True])
def test_wheel_is_short_of_its_road_by_the_clearance(curve: bool) -> None:
    made, wheel, path = _made(_cart(curve))
    assert made.levels["wheel"] != made.levels["slider"]
    centre = made.layout.seen("wheel", wheel.at, "ground")
    away = distances(centre, path)
    scale = made.sizes.scale
    assert (away - wheel.built_radius).min() * scale > 0.05
    assert (away - wheel.built_radius).max() * scale < 0.2
    assert np.ptp(centre[:, 0]) * scale == pytest.approx(80.0, rel=0.05)  # 2 rad of 40 mm


def test_wheel_tyre_and_road_are_sound() -> None:
    made, wheel, path = _made(_cart(curve=True))
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
