"""body.at_world: markers given in the world at the start."""

from __future__ import annotations

import copy
import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, ModelError, ModelWarning, constant_rate
from mbsd.model.body import Body
from tools.models import four_bars

A, B, C, D = (0.0, 0.0), (0.03, 0.04), (0.15, 0.10), (0.12, 0.0)
"""Pins of a four-bar as drawn (m)."""


def drawn(frames: dict[str, tuple[float, float, float]]) -> Mechanism:
    """The four-bar from its drawing; frames of its bodies anywhere (m, m, degrees), the same solids in the world."""
    m = Mechanism("drawn")
    middles = {"crank": (A, B, 0.1), "coupler": (B, C, 0.3), "rocker": (C, D, 0.2)}
    for name, (first, second, mass) in middles.items():
        x, y, degrees = frames[name]
        middle = 0.5 * (first[0] + second[0]) - x, 0.5 * (first[1] + second[1]) - y
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        com = c * middle[0] + s * middle[1], c * middle[1] - s * middle[0]
        m.body(name, mass, com, mass * math.dist(first, second) ** 2 / 12)
    m.start_near(**frames)
    crank, coupler, rocker = (m.bodies[name] for name in middles)
    m.revolute("A", m.ground.at_world(*A), crank.at_world(*A))
    m.revolute("B", crank.at_world(*B), coupler.at_world(*B))
    m.revolute("C", coupler.at_world(*C), rocker.at_world(*C))
    m.revolute("D", m.ground.at_world(*D), rocker.at_world(*D))
    m.trace("P", coupler.at_world(0.1, 0.12, 0.3))
    start = math.radians(frames["crank"][2])
    m.drive_angle("motor", crank, constant_rate(10.0, start))
    return m


@pytest.mark.filterwarnings("error::mbsd.ModelWarning")
def test_a_mechanism_drawn_in_the_world_does_not_depend_on_where_frames_are(tmp_path: Path) -> None:
    sols = []
    m = None
    for seed in range(3):
        random = np.random.default_rng(seed)
        frames = {
            name: (0.0, 0.0, 0.0) if seed == 0 else (*(0.1 * random.normal(size=2)), 90.0 * random.normal())
            for name in ("crank", "coupler", "rocker")
        }
        m = drawn(frames)
        sols.append(m.sweep(2 * math.pi / 10 / 4, steps=20))
        assert m.check() == []
        for name, place in (("A", A), ("B", B), ("C", C), ("D", D)):
            view = sols[-1].joint(name)
            np.testing.assert_allclose([view.x[0], view.y[0]], place, atol=1e-12)
        point = sols[-1].point("P")
        np.testing.assert_allclose([point.x[0], point.y[0]], [0.1, 0.12], atol=1e-12)
        assert math.remainder(point.theta[0] - 0.3, 2 * math.pi) == pytest.approx(0, abs=1e-12)
        for name in "ABCD":
            np.testing.assert_allclose(sols[-1].joint(name).reaction, sols[0].joint(name).reaction, atol=1e-9)
        np.testing.assert_allclose(point.x, sols[0].point("P").x, atol=1e-12)
    assert m is not None
    m.save(tmp_path / "drawn.json")
    loaded = Mechanism.load(tmp_path / "drawn.json")
    np.testing.assert_array_equal(loaded.sweep(0.1, steps=5).q, m.sweep(0.1, steps=5).q)


def test_a_frame_that_is_the_worlds_gives_the_numbers_themselves() -> None:
    m = Mechanism("plain")
    body = m.body("body", com=(0.2, 0.1))
    m.start_near(body=(0, 0, 0))
    for marker in (body.at_world(0.3, -0.7, 0.4), m.ground.at_world(0.3, -0.7, 0.4)):
        assert (marker.x, marker.y, marker.angle) == (0.3, -0.7, 0.4)


@pytest.mark.filterwarnings("error::mbsd.ModelWarning")
def test_rough_starts_are_closed_first() -> None:
    """A four-bar by lengths: the coupler and rocker are 5 and 8 degrees off, the point is where the links close."""
    m = four_bars.model((4.0, 1.0, 3.5, 3.0), 2.0)
    sol = m.sweep(0.1, steps=2)
    there = sol.joint("C").x[0], sol.joint("C").y[0]
    angles = {name: math.degrees(sol.body(name).theta[0]) for name in ("coupler", "rocker")}
    m.start_near(coupler=angles["coupler"] + 5, rocker=angles["rocker"] - 8)
    rocker, coupler = m.bodies["rocker"], m.bodies["coupler"]
    for body, end in ((coupler, coupler.end), (rocker, m.joints["C"].j)):
        marker = body.at_world(*there)
        np.testing.assert_allclose([marker.x, marker.y], [end.x, end.y], atol=1e-9)
    m.trace("P", coupler.at_world(2.0, 3.0, 0.1))
    again = m.sweep(0.1, steps=2)
    assert (again.point("P").x[0], again.point("P").y[0]) == pytest.approx((2.0, 3.0), abs=1e-9)
    m.spring("spring", m.ground.at(1.0, 5.0), rocker.at_world(1.0, 4.0), 3.0)
    spring = m.simulate(0.1, steps=2).force("spring")
    assert spring.length[0] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.filterwarnings("error::mbsd.ModelWarning")
def test_undriven_bodies_start_as_start_near_says() -> None:
    m = Mechanism("pendulum")
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", m.ground.at(0.2, 0), rod.start)
    m.start_near(rod=-60)
    marker = rod.at_world(0.7, -0.5 * math.sqrt(3), -math.pi / 3)
    np.testing.assert_allclose([marker.x, marker.y, marker.angle], [1.0, 0.0, 0.0], atol=1e-15)
    slide = m.body("slide", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, -1, 0.1), slide.origin)
    m.start_near(slide=(0.4, -0.9, 3))  # somewhat off the rail, whose angle is 5.7 degrees
    marker = slide.at_world(0.5, -0.9)
    m.spring("spring", rod.at_world(0.7, -0.8), marker, 1.0)
    sol = m.simulate(0.1, steps=2)
    view = sol.force("spring")
    np.testing.assert_allclose([view.x[0], view.y[0]], [0.5, -0.9], atol=1e-9)
    np.testing.assert_allclose([view.on("rod").x[0], view.on("rod").y[0]], [0.7, -0.8], atol=1e-9)


def test_gears_and_closed_loops_stay_meshed() -> None:
    m = Mechanism("train")
    first, second = m.body("first", 1.0, inertia=1.0), m.body("second", 1.0, inertia=1.0)
    m.start_near(first=(0, 0, 30), second=(0.06, 0, -50))
    m.revolute("A", m.ground.origin, first.at_world(0, 0))
    m.revolute("B", m.ground.at(0.06, 0), second.at_world(0.06, 0))
    m.gear_pair("gears", first.at_world(0, 0), second.at_world(0.06, 0), teeth=(20, 40), module=0.002)
    m.drive_angle("motor", first, constant_rate(1.0, math.radians(30)))
    m.trace("P", second.at_world(0.1, 0.02))
    sol = m.sweep(1.0, steps=4)
    assert (sol.point("P").x[0], sol.point("P").y[0]) == pytest.approx((0.1, 0.02))
    assert sol.body("second").theta[0] == pytest.approx(math.radians(-50))


def test_a_pose_that_is_not_known_is_refused() -> None:
    m = Mechanism("loose")
    rod, slide, load = m.bar("rod", 1.0), m.body("slide"), m.body("load")
    with pytest.raises(
        ModelError, match=r"loose: rod\.at_world: .*its place and angle are free\. .*=\(x, y, degrees\)"
    ):
        rod.at_world(0, 0)
    m.revolute("A", m.ground.origin, rod.start)
    m.prismatic("rail", m.ground.origin, slide.origin)
    m.revolute("B", rod.end, load.origin)
    with pytest.raises(ModelError, match=r"start of 'rod' is not known yet: its angle is free\. .*rod=degrees\)"):
        rod.at_world(0, 0)
    with pytest.raises(ModelError, match=r"'slide' .*its place is free\. .* start_near\(slide=\(x, y, degrees\)\)"):
        slide.at_world(0, 0)
    m.start_near(rod=90, load=0)
    assert (rod.at_world(0.3, 1.0).x, rod.at_world(0.3, 1.0).y) == pytest.approx((1.0, -0.3))
    assert (load.at_world(0.3, 1.0).x, load.at_world(0.3, 1.0).y) == pytest.approx((0.3, 0.0))
    m.drive_coordinate("hand", m.ground.origin, slide.origin, lambda t: 0.25 + t)
    assert slide.at_world(1.0, 0.0).x == pytest.approx(0.75)
    with pytest.raises(ModelError, match=r"loose: rod\.at_world: x is nan"):
        rod.at_world(math.nan, 0)
    with pytest.raises(ModelError, match="'stray' belongs to no mechanism"):
        Body("stray", "loose").at_world(0, 0)
    m.distance("far", m.ground.at(0, 9), rod.end, 0.1)
    with pytest.raises(AssemblyError, match="far"):
        rod.at_world(0, 0)


def test_a_start_that_came_later_is_told_once() -> None:
    m = Mechanism("late")
    rod = m.bar("rod", 1.0, mass=1.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.start_near(rod=0)
    unused = rod.at_world(0.5, 0.5)
    m.spring("spring", m.ground.at(0, 1), rod.at_world(1.0, 0.0), 5.0)
    assert unused.y == 0.5
    assert m.check() == []
    m.start_near(rod=90)
    says = r"late: rod: the marker of at_world\(1, 0, 0\) is at \(.*, 1\) m at the start\. Call at_world after"
    with pytest.warns(ModelWarning, match=says) as told:
        m.simulate(0.1, steps=2)
    assert len(told) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        m.simulate(0.1, steps=2)


def test_copies_have_their_own_bodies() -> None:
    m = Mechanism("copied")
    rod = m.bar("rod", 1.0, mass=1.0)
    m.start_near(rod=(0, 0, 0))
    other = copy.deepcopy(m)
    other.start_near(rod=(1.0, 0, 0))
    assert rod.at_world(1.0, 0.0).x == 1.0
    assert other.bodies["rod"].at_world(1.0, 0.0).x == 0.0
