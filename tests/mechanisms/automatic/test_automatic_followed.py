"""Automatic parts along open curves: slots and roads go on straight as the model does, keep out of their own way,
and what would run through itself is refused before anything is built.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from mbsd import Mechanism, Solution
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.curves import continued, followed
from mechanisms.stages.automatic.rolling.roads import Road, along, band, banded, with_shared_roads
from mechanisms.stages.automatic.rolling.rounds import Round
from mechanisms.stages.automatic.slides.curved_slots import CurvedSlot
from shared.shapes.outline import distances
from shared.stage.errors import UserError


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
    features = made.layout.features
    [road] = [feature for feature in features if isinstance(feature, Road)]
    [wheel] = [feature for feature in features if isinstance(feature, Round)]
    return road, wheel, made.layout.seen("bead", wheel.at, "ground")


def test_a_slot_goes_on_along_the_tangent_of_its_curve() -> None:
    """Along the last chord it left the pin's way by more than the roller's clearance."""
    m, solution = _runs(_arc(1.2), 30, 5.0, 0.0, 0.7)
    made = Automatic(m, solution)
    [slot] = [feature for feature in made.layout.features if isinstance(feature, CurvedSlot)]
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
    solid = road._wall(0.0, 5.0).val()
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
    ring = band(path)
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
