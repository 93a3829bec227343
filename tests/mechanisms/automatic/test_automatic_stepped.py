"""Rings that turn and stepped gears by themselves: each toothed rim in its layer, carried by its body's plate."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.wheels.wheels import TUBE, Wheel
from tests.mechanisms.automatic.layouts import meets
from tests.shared.shape_checks import checked
from tools.models.outlines import gap


def ring_drive(teeth: tuple[int, int], turn: float = 0.0, module: float = 1e-3) -> Mechanism:
    """A pinion on ground drives a ring on ground around it."""
    m = Mechanism("ring_drive")
    ring, pinion = m.body("ring"), m.body("pinion")
    apart = module * (teeth[0] - teeth[1]) / 2
    m.revolute("R", m.ground.at(0, 0), ring.origin)
    m.revolute("P", m.ground.at(apart * math.cos(turn), apart * math.sin(turn)), pinion.origin)
    m.gear_pair("mesh", ring.origin, pinion.origin, teeth=teeth, module=module, internal=True)
    m.drive_angle("motor", pinion, constant_rate(1.0, turn))
    m.start_near(ring=20, pinion=math.degrees(turn))
    return m


def two_stages(teeth: tuple[int, int, int, int], bend: float = 0.0, module: float = 1e-3) -> Mechanism:
    """Wheel 1 drives 2, 3 is one with 2 and drives 4; at ``bend`` = pi the last turns about the first one's axis."""
    m = Mechanism("two_stages")
    first, middle, last = m.body("first"), m.body("middle"), m.body("last")
    a, b = (module * (teeth[k] + teeth[k + 1]) / 2 for k in (0, 2))
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(a, 0), middle.origin)
    m.revolute("C", m.ground.at(a + b * math.cos(bend), b * math.sin(bend)), last.origin)
    m.gear_pair("one", first.origin, middle.origin, teeth=teeth[:2], module=module)
    m.gear_pair("two", middle.origin, last.origin, teeth=teeth[2:], module=module)
    m.drive_angle("motor", first, constant_rate(1.0))
    return m


def wheels(made: Automatic) -> list[Wheel]:
    return [feature for feature in made.layout.features if isinstance(feature, Wheel)]


def between(meshes: list[Any]) -> float:
    """The height (mm) between two pieces, one above the other."""
    low, high = sorted(meshes, key=lambda mesh: mesh.vertices[:, 2].min())
    return float(high.vertices[:, 2].min() - low.vertices[:, 2].max())


@settings(max_examples=6, deadline=None)
@given(st.integers(12, 24), st.integers(20, 40), st.floats(-3.0, 3.0))
def test_teeth_of_a_ring_that_turns_pass_its_pinion(pinion: int, more: int, turn: float) -> None:
    m = ring_drive((pinion + more, pinion), turn)
    made = Automatic(m, m.sweep(1.0, steps=20))
    ring, small = wheels(made)
    assert ring.ring
    assert made.decided[ring.layer] == made.decided["pinion"] != made.decided["ring"]
    count = len(made.layout.times)
    assert min(gap(made, ring, small, at) for at in range(0, count, count // 6)) > 0.06


def test_cup_is_rim_and_bottom() -> None:
    m = ring_drive((60, 18))
    made = Automatic(m, m.sweep(1.0, steps=20))
    solids = {solid.name: solid for solid in made.solids(engraved_too=False)["ring"]}
    rim, bottom = solids["ring_mesh"], solids["ring"]
    meshes = [checked(solid.shape, solid.through_holes)[1] for solid in (rim, bottom)]
    assert bottom.through_holes == 6  # windows and the bore
    assert 0 < between(meshes) < 0.1
    assert np.ptp(meshes[0].vertices[:, 0]) == pytest.approx(np.ptp(meshes[1].vertices[:, 0]), rel=1e-3)


@settings(max_examples=6, deadline=None)
@given(st.integers(18, 30), st.integers(36, 60), st.floats(-1.8, 1.8))
def test_stepped_wheels_mesh_in_two_layers(small: int, large: int, bend: float) -> None:
    m = two_stages((small, large, small, large), bend)
    made = Automatic(m, m.sweep(1.0, steps=20))
    pairs = [(wheel, mate) for wheel in wheels(made) for mate in wheel.mates if isinstance(mate, Wheel)]
    assert len(pairs) == 4
    count = len(made.layout.times)
    for wheel, mate in pairs:
        assert min(gap(made, wheel, mate, at) for at in range(0, count, count // 4)) > 0.06
        assert made.decided[wheel.layer] == made.decided[mate.layer]
    assert made.decided["first"] != made.decided["last"]


@pytest.mark.parametrize("order", [(18, 54, 18, 54), (54, 18, 54, 18)])
@pytest.mark.slow
def test_second_wheel_stands_on_a_tube_that_leaves_the_pin_free(order: tuple[int, int, int, int]) -> None:
    m = two_stages(order)
    made = Automatic(m, m.sweep(1.0, steps=20))
    solids = {solid.name: solid for solid in made.solids(engraved_too=False)["middle"]}
    name = next(name for name in solids if name.startswith("gear_"))
    second, plate = solids[name], solids["middle"]
    meshes = [checked(solid.shape, solid.through_holes)[1] for solid in (second, plate)]
    inner = np.hypot(*meshes[0].vertices[:, :2].T).min()
    assert inner == pytest.approx(TUBE[0] * made.sizes.scale, rel=1e-3)
    assert 0 < between(meshes) < 0.1


def test_two_stages_back_to_the_first_axis() -> None:
    """A clock's motion work: minutes and hours about one axis."""
    m = two_stages((18, 36, 18, 36), math.pi)
    made = Automatic(m, m.sweep(1.0, steps=20))
    assert made.decided["first"] != made.decided["last"]
    assert {solid.name for solid in made.solids(engraved_too=False)["middle"]} >= {"middle", "bushing_B_low"}


@pytest.mark.parametrize("bend", [0.5, 0.9, 2.0, 2.4, -1.2])
def test_pinion_whose_two_mates_overlap_is_two(bend: float) -> None:
    """A pinion of 12 teeth between wheels of 60 and 48: they meet unless they are far round it from each other."""
    module = 1e-3
    m = Mechanism("long_pinion")
    first, middle, last = m.body("first"), m.body("middle"), m.body("last")
    m.revolute("A", m.ground.at(-36 * module, 0), first.origin)
    m.revolute("B", m.ground.origin, middle.origin)
    m.revolute("C", m.ground.at(-30 * module * math.cos(bend), 30 * module * math.sin(bend)), last.origin)
    m.gear_pair("one", first.origin, middle.origin, teeth=(60, 12), module=module)
    m.gear_pair("two", middle.origin, last.origin, teeth=(12, 48), module=module)
    m.drive_angle("motor", first, constant_rate(1.0))
    made = Automatic(m, m.sweep(1.0, steps=40))
    pinions = [wheel for wheel in wheels(made) if wheel.body == "middle"]
    overlap = math.hypot(36 - 30 * math.cos(bend), 30 * math.sin(bend)) < 57  # with their teeth
    assert len(pinions) == (2 if overlap else 1)
    assert (made.decided["first"] != made.decided["last"]) == overlap
    assert not meets(made)
    count = len(made.layout.times)
    for wheel in pinions:
        for mate in wheel.mates:
            assert isinstance(mate, Wheel)
            assert min(gap(made, wheel, mate, at) for at in range(0, count, count // 4)) > 0.06
