"""A joint that an event has released is drawn no more: pictures, skeletons, pages, animations."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.drawing.moving_skeleton import moving
from mbsd.drawing.pose import pose_of, tracks_of
from mbsd.drawing.skeleton import measure
from mbsd.drawing.strokes import strokes_of
from mbsd.results.solution import Solution

LENGTH = 0.5


@pytest.fixture(scope="module")
def thrown() -> Solution:
    """A stone on a sling without mass, which lets go after a turn and a half, and flies far."""
    m = Mechanism("sling", gravity=None)
    stone = m.body("stone", 0.2, inertia=1e-4)
    sling = m.distance("sling", m.ground.origin, stone.origin, length=LENGTH)
    m.event("lets go", lambda t, moment: t - 0.31, releases=[sling])
    m.start_near(stone=(LENGTH, 0.0, 0.0))
    m.start_moving(stone=(0.0, 12.0, 0.0))
    return m.simulate(2.0, steps=100)


def test_pictures_show_the_rod_until_it_is_released(thrown: Solution) -> None:
    early, late = strokes_of(thrown, [5, 95])
    assert len(late.strokes) < len(early.strokes)
    stone = np.array([thrown.body("stone").x[95], thrown.body("stone").y[95]])
    assert np.hypot(*stone) > 10.0
    for stroke in late.strokes:
        assert np.ptp(stroke.points, axis=0).max() < 5.0 * late.unit, "nothing reaches from ground to the stone"
    assert {label.text for label in early.labels} - {label.text for label in late.labels} == {"sling"}
    thrown.draw(step=95)


def test_the_moving_skeleton_takes_it_away(thrown: Solution) -> None:
    skeleton = moving(thrown)
    [rod] = [carried for carried in skeleton.strokes if carried.shapes and carried.stroke.width == 1.8]
    for time, shape in zip(skeleton.times, rod.shapes, strict=True):
        length = float(np.hypot(*np.ptp(shape, axis=0)))
        assert length == pytest.approx(LENGTH if time < 0.31 else 0.0, abs=1e-6)
    assert all(np.ptp(carried.shapes[-1], axis=0).max() == 0.0 for carried in skeleton.strokes if carried.shapes)


def test_a_guide_does_not_follow_what_has_left_it() -> None:
    m = Mechanism("shot", gravity=(0, -9.81))
    bolt = m.body("bolt", 0.1, inertia=1e-4)
    rail = m.prismatic("rail", m.ground.origin, bolt.origin)
    m.event("leaves", lambda t, moment: moment.body("bolt").x - 0.4, releases=[rail])
    m.start_near(bolt=(0.0, 0.0, 0.0))
    m.start_moving(bolt=(40.0, 0.0, 0.0))
    sol = m.simulate(2.0, steps=200)
    travel = tracks_of(sol).travel["rail"]
    assert travel.max() <= 0.4 + 1e-9
    early, late = (pose_of(sol, None, step) for step in (0, 200))
    assert not early.gone("rail")
    assert late.gone("rail")
    low, high, _ = measure(m, early)
    assert (high - low).max() < 1.0


def test_an_animation_keeps_its_names(thrown: Solution, tmp_path) -> None:  # type: ignore[no-untyped-def]
    thrown.animate(tmp_path / "sling.gif", fps=4, size=(160, 120), names=True)
    assert (tmp_path / "sling.gif").stat().st_size > 1000
