"""Rings and discs about closed curves, and roads of moving bodies: what runs there stays clear by the clearance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, harmonic
from mbsd.results.solution import Solution
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.rolling.tracks import Track, circle, turns_left
from mechanisms.stages.automatic.rolling.tracks import closed_normals as normals
from shared.shapes.outline import distances
from shared.stage.errors import UserError
from tests.mechanisms.automatic.layouts import meets
from tools.hunt_parts.case import parts_of


def curve(radius: float, count: int, left: bool = True, long: float = 1.0) -> list[tuple[float, float]]:
    angle = np.linspace(0.0, 2 * math.pi if left else -2 * math.pi, count, endpoint=False)
    return [(long * radius * math.cos(a), radius * math.sin(a)) for a in angle]


def in_a_bowl(scale: float = 1.0) -> Solution:
    m = Mechanism("bowl")
    wheel = m.body("wheel", mass=1.0, inertia=1e-3 * scale**2)
    points = [(scale * x, scale * y) for x, y in curve(0.2, 24, long=1.3)]
    m.rolling_on_curve("ring", m.ground.origin, wheel.origin, points, 0.04 * scale, closed=True)
    m.start_near(wheel=(0.21 * scale, 0.0, 0))
    return m.simulate(0.6 * math.sqrt(scale), 60)


def round_a_disc() -> Solution:
    m = Mechanism("round", gravity=None)
    arm, wheel = m.bar("arm", 0.14), m.body("wheel")
    m.revolute("O", m.ground.origin, arm.start)
    m.revolute("P", arm.end, wheel.origin)
    m.rolling_on_curve("disc", m.ground.origin, wheel.origin, curve(0.1, 60, left=False), 0.04, closed=True)
    m.drive_angle("motor", arm, constant_rate(2.0))
    m.start_near(arm=0, wheel=(0.14, 0, 0))
    return m.sweep(steps=120)


def in_a_ring(moving: bool) -> Solution:
    m = Mechanism("ring")
    ring, ball = m.ground, m.body("ball", mass=0.1, inertia=1e-5)
    if moving:
        ring = m.body("cup", mass=1.0, inertia=1e-2)
        m.revolute("O", m.ground.origin, ring.origin)
        m.drive_angle("motor", ring, harmonic(0.5, 6.0))
        m.start_near(cup=0)
    m.rigid_discs("in", ring.origin, ball.origin, 0.1, 0.02, inside=True, restitution=0.6)
    m.start_near(ball=(0.05, -0.03, 0))
    return m.simulate(0.2, 40, event_rows=True)


def on_a_peg() -> Solution:
    m = Mechanism("peg")
    ball = m.body("ball", mass=0.1, inertia=1e-5)
    m.rigid_discs("peg", ball.origin, m.ground.origin, 0.02, 0.03, restitution=0.6)
    m.start_near(ball=(0.01, 0.1, 0))
    return m.simulate(0.25, 60, event_rows=True)


def on_a_tray() -> Solution:
    m = Mechanism("tilt")
    tray, ball = m.bar("tray", 0.4, mass=1.0), m.body("ball", mass=0.1, inertia=1e-5)
    m.revolute("O", m.ground.origin, tray.start)
    m.rigid_contact("on", tray.at(0, 0.05), ball.origin, radius=0.02, restitution=0.3)
    m.drive_angle("motor", tray, harmonic(0.15, 6.0))
    m.start_near(tray=0, ball=(0.2, 0.09, 0))
    return m.simulate(0.25, 50, event_rows=True)


def on_a_table() -> Solution:
    m = Mechanism("rolling", gravity=None)
    table, wheel, arm = m.bar("table", 0.4), m.body("wheel"), m.bar("arm", 0.25)
    m.revolute("O", m.ground.origin, table.start)
    m.rolling_disc("on", table.at(0, 0.03), wheel.origin, 0.04)
    m.revolute("A", m.ground.at(0.2, 0.3), arm.start)
    m.revolute("W", arm.end, wheel.origin)
    m.drive_angle("motor", table, harmonic(0.1, 2.0))
    m.start_near(table=0, arm=-80, wheel=(0.23, 0.07, 0))
    return m.sweep(3.2, steps=100)


ALL = {
    "bowl": (in_a_bowl, True),
    "round": (round_a_disc, False),
    "hollow": (lambda: in_a_ring(False), True),
    "cup": (lambda: in_a_ring(True), True),
    "peg": (on_a_peg, False),
    "tray": (on_a_tray, False),
    "table": (on_a_table, False),
}


def made_of(solution: Solution) -> tuple[Automatic, Track]:
    made = Automatic(solution.mechanism, solution)
    [track] = [feature for feature in made.layout.features if isinstance(feature, Track)]
    return made, track


@pytest.mark.parametrize("name", ALL)
def test_what_runs_on_a_track_is_clear_of_it_by_the_clearance(name: str) -> None:
    build, inside = ALL[name]
    made, track = made_of(build())
    assert track.inside == inside
    part = track.carried
    away = distances(made.layout.seen(part.body, part.at, track.body), track.path)
    assert 0.05 < (away.min() - part.built_radius) * made.sizes.scale < 1.5
    assert not meets(made)


@pytest.mark.parametrize("name", ["cup", "tray"])
def test_none_of_its_parts_touch(name: str) -> None:
    solution = ALL[name][0]()
    outcome = parts_of(solution.mechanism, solution)
    assert outcome.state == "built", outcome


@pytest.mark.parametrize("name", ["bowl", "round", "peg", "table"])
def test_tracks_are_sound_solids(name: str) -> None:
    made, track = made_of(ALL[name][0]())
    solids = made.solids(engraved_too=False)
    [wall] = [solid for solid in solids[track.body] if solid.name == f"track_{track.name}"]
    assert wall.through_holes == int(track.inside) + (name == "round")  # for the pivot of its arm
    for body in {track.body, track.carried.body} - {"ground"}:
        assert solids[body][0].shape.val().isValid()
    box, other = wall.shape.val().BoundingBox(), solids[track.carried.body][0].shape.val().BoundingBox()
    assert wall.shape.val().isValid()
    middle = (other.zmin + other.zmax) / 2
    assert box.zmin < middle < box.zmax


@pytest.mark.parametrize("scale", [0.1, 30.0])
def test_rings_grow_with_the_mechanism(scale: float) -> None:
    made, track = made_of(in_a_bowl(scale))
    assert np.ptp(track.path[:, 0]) == pytest.approx(made.sizes.of_metres(0.52 * scale), rel=1e-3)
    assert not meets(made)


def test_a_circle_has_what_it_carries_on_its_left() -> None:
    for inside in (True, False):
        path = circle((3.0, -2.0), 50.0, inside)
        assert turns_left(path) == inside
        out = ((path - [3.0, -2.0]) * normals(path)).sum(axis=1) / 50.0
        assert out == pytest.approx(np.full(len(path), -1.0 if inside else 1.0))


def test_a_disc_that_stands_on_ground_is_refused() -> None:
    m = Mechanism("plank", gravity=None)
    plank = m.bar("plank", 0.4)
    m.rolling_disc("on", plank.at(0, 0.03), m.ground.origin, 0.04)
    m.drive_angle("motor", plank, harmonic(0.1, 2.0))
    m.start_near(plank=(-0.2, -0.07, 0))
    with pytest.raises(UserError, match="'on' is a rolling disc whose disc is on ground"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).levels
