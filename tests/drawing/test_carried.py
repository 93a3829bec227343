"""The moving skeleton is the one that is drawn at each moment; released joints are left out."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, SingularPoseError, Solution, constant_rate
from mbsd.drawing.carriers import Frames
from mbsd.drawing.moving_skeleton import Moving, drawn_at, moving, resampled
from mbsd.drawing.pose import pose_of, tracks_of
from mbsd.drawing.skeleton import measure
from mbsd.drawing.strokes import strokes_of
from tools.models import guided, linkages
from tools.random_mechanisms import linkages as random_linkages

SLACK = 0.02
"""How far two curves may be apart that count as one, in units of the symbols."""
TEETH = 0.15
"""The same of outlines of a body's own colour: teeth are sampled elsewhere in every pose."""


def alike(a: np.ndarray, b: np.ndarray, closed: bool, slack: float) -> bool:
    """Return True if no corner of one polyline (k, 2) is farther than ``slack`` (m) from the other."""
    if not len(a) or not len(b):
        return len(a) == len(b)
    if a.shape == b.shape and float(np.abs(a - b).max()) <= slack:
        return True
    if not closed:
        return False
    if max(np.abs(a.min(axis=0) - b.min(axis=0)).max(), np.abs(a.max(axis=0) - b.max(axis=0)).max()) > 2 * slack:
        return False
    return _far(a, b) <= slack and _far(b, a) <= slack


def _far(points: np.ndarray, outline: np.ndarray) -> float:
    """The largest distance of points (n, 2) from a closed outline (k, 2)."""
    ways = np.roll(outline, -1, axis=0) - outline
    off = points[:, None] - outline
    square = np.maximum((ways**2).sum(axis=1), 1e-300)
    part = np.clip((off * ways).sum(axis=2) / square, 0.0, 1.0)
    return float(np.sqrt(((off - part[..., None] * ways) ** 2).sum(axis=2).min(axis=1).max()))


def hung() -> Solution:
    m = Mechanism("hung")
    block = m.body("block", mass=1.0, inertia=0.01)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), block.at(0, 0, math.pi / 2))
    m.spring("spring", m.ground.at(0, 0.5), block.at(0, 0), stiffness=100.0, damping=1.0, free_length=0.5)
    return m.simulate(duration=1.0, steps=200)


def geared() -> Solution:
    m = Mechanism("geared")
    pinion, gear = m.body("one", mass=1.0, inertia=0.01), m.body("two", mass=1.0, inertia=0.01)
    m.revolute("A", m.ground.at(0, 0), pinion.at(0, 0))
    m.revolute("B", m.ground.at(0.15, 0), gear.at(0, 0))
    m.gear_pair("mesh", pinion.at(0, 0), gear.at(0, 0), teeth=(20, 40), module=0.005)
    m.drive_angle("motor", pinion, constant_rate(6.0))
    return m.sweep(duration=1.0, steps=300)


MADE: dict[str, Callable[[], Solution]] = {
    "four_bar": lambda: linkages.four_bar(0.12, 0.04, 0.12, 0.09).sweep(duration=1.0, steps=120),
    "slider_crank": lambda: linkages.slider_crank().sweep(duration=1.0, steps=120),
    "geneva": lambda: guided.geneva(4).sweep(duration=1.0, steps=120),
    "hung": hung,
    "geared": geared,
}


def check(solution: Solution, skeleton: Moving) -> None:
    """At poses that were not looked at, too, each carried stroke lies on the one that is drawn there."""
    m, tracks, steady = solution.mechanism, tracks_of(solution), skeleton.steady
    first = Frames(tracks, 0)
    for step in range(3, len(solution.t), 29):
        canvas = drawn_at(m, tracks, steady, step)
        assert len(canvas.strokes) == len(skeleton.strokes)
        for carried, drawn in zip(skeleton.strokes, canvas.strokes, strict=True):
            if carried.carrier.kind != "shapes":
                here = carried.carrier.moved(carried.stroke.points, first, Frames(tracks, step))
                slack = TEETH if drawn.ink.startswith("body:") else SLACK
                closed = drawn.closed or np.array_equal(here[0].round(9), here[-1].round(9))
                assert alike(here, drawn.points, closed, 1.5 * slack * steady.unit), (step, drawn.ink)


@pytest.mark.parametrize("name", MADE)
def test_each_stroke_is_carried_to_where_it_is_drawn(name: str) -> None:
    solution = MADE[name]()
    skeleton = moving(solution)
    check(solution, skeleton)
    kinds = Counter(stroke.carrier.kind for stroke in skeleton.strokes)
    assert kinds["body"] > 0
    assert kinds["ground"] > 0
    assert kinds["shapes"] == 0
    assert (kinds["line"] > 0) == (name == "hung")
    assert len(skeleton.names) == len({label.text for label, _ in skeleton.names})


@settings(max_examples=6, deadline=None)
@given(seed=st.integers(0, 500))
def test_random_linkages_are_carried(seed: int) -> None:
    m = random_linkages.driven_linkage(seed, 2)
    try:
        solution = m.sweep(duration=0.2, steps=40)
    except SingularPoseError:
        assume(False)
        raise
    check(solution, moving(solution))


@settings(max_examples=40, deadline=None)
@given(corners=st.integers(3, 40), start=st.integers(0, 39), factor=st.floats(0.1, 30))
def test_outlines_with_other_corners_are_alike_and_others_are_not(corners: int, start: int, factor: float) -> None:
    turn = np.linspace(0, 2 * np.pi, corners, endpoint=False)
    outline = factor * np.stack([np.cos(turn), 0.5 * np.sin(turn)], axis=1)
    between = (outline + np.roll(outline, -1, axis=0)) / 2
    finer = np.stack([outline, between], axis=1).reshape(-1, 2)
    assert alike(np.roll(outline, start, axis=0), finer, True, 1e-9 * factor)
    assert not alike(outline, finer * 1.2, True, 0.02 * factor)


def test_shapes_get_one_number_of_corners_and_what_is_not_drawn_is_a_point() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    made = resampled([square, square[:3], np.zeros((0, 2))], True)
    assert [len(shape) for shape in made] == [4, 4, 4]
    assert np.ptp(made[2], axis=0).max() == 0.0


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
