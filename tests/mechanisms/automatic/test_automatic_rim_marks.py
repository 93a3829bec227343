"""Marks of traced points on rims: a pin within the rim, and a pointer over what the wheel runs on or meshes with."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.pins.free_bodies import BASE, TIP, WALL, RimMark, Stylus
from tests.mechanisms.automatic.layouts import meets
from tools.hunt_parts.case import parts_of
from tools.hunt_parts.outcome import BUILT


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


def _made(m: Mechanism) -> Automatic:
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
    made = _made(m)
    assert not meets(made)
    (mark,) = [feature for feature in made.layout.features if isinstance(feature, RimMark)]
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
    for mark in (feature for feature in made.layout.features if isinstance(feature, RimMark) and feature.points):
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
