"""Limits and stops of joints become stop pins, blocks beside rails and ends of slots, which meet at the limit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.cams import CLEAR
from mechanisms.stages.automatic.layout.planar import placed
from mechanisms.stages.automatic.pins.stops import RADIUS, Stop
from mechanisms.stages.automatic.slides.slots import Slot
from shared.shapes.solid import Solid
from tests.mechanisms.automatic.layouts import meets
from tools.hunt_parts.case import parts_of

LOW, HIGH = math.radians(-120), math.radians(-40)


def pendulum(scale: float = 1.0, turned: bool = False) -> Mechanism:
    """It swings between two stops, which its driver just reaches; ``turned``: ground is its joint's second body."""
    m = Mechanism("stopped", gravity=None)
    arm = m.bar("arm", 0.2 * scale)
    ends = (m.ground.origin, arm.start)
    joint = m.revolute("A", *(reversed(ends) if turned else ends))
    m.stop("stop", joint, *((-HIGH, -LOW) if turned else (LOW, HIGH)))
    m.drive_angle("motor", arm, harmonic((HIGH - LOW) / 2, 1.0, 0.0, (HIGH + LOW) / 2))
    m.start_near(arm=-80)
    return m


def stops(made: Automatic) -> list[Stop]:
    return [feature for feature in made.layout.features if isinstance(feature, Stop)]


def gaps(made: Automatic, stop: Stop) -> dict[str, float]:
    """Least distance (rmm) of the axes of two stop pins over the motion, by end."""
    poses = made.layout.poses
    nose = placed(np.array([stop.nose]), poses[stop.second])[:, 0]
    return {
        end: float(np.hypot(*(nose - placed(np.array([at]), poses[stop.first])[:, 0]).T).min()) for end, at in stop.ends
    }


@pytest.mark.parametrize(("scale", "turned"), [(1.0, False), (0.1, True), (30.0, False)])
def test_stop_pins_meet_at_both_ends_of_the_way(scale: float, turned: bool) -> None:
    m = pendulum(scale, turned)
    made = Automatic(m, m.sweep())
    [stop] = stops(made)
    assert (stop.first, stop.second) == ("ground", "arm")
    meet = 2 * RADIUS + CLEAR * made.sizes.pivot.fit.running
    assert gaps(made, stop) == {"lower": pytest.approx(meet, abs=1e-3), "upper": pytest.approx(meet, abs=1e-3)}
    assert not meets(made)


def test_no_stop_pin_touches_the_other() -> None:
    m = pendulum()
    outcome = parts_of(m, m.sweep(times=np.linspace(0.0, 2 * math.pi, 121)))
    assert outcome.state == "built", outcome


def elbow(lower: float | None, upper: float | None, reverse: bool = False) -> Mechanism:
    """Two driven bars with stops between them, told of the joint or of the bodies in the other order."""
    m = Mechanism("elbow", gravity=None)
    a, b = m.bar("a", 0.2), m.bar("b", 0.2)
    m.revolute("A", m.ground.origin, a.start)
    joint = m.revolute("B", a.end, b.start, limits=None if reverse else (lower, upper))
    if reverse:
        at = b.at(0.1, 0.0, 0.3), a.at(0.05, 0.0, -0.2)
        for end, word in ((lower, "low"), (upper, "high")):
            if end is not None:
                m.angle_stop(word, *at, at=-end - 0.5, upper=word == "low")
    m.drive_angle("motor", a, constant_rate(1.0))
    m.drive_relative_angle("servo", a, b, harmonic(0.4, 1.0))
    m.start_near(a=0, b=0)
    assert joint.name == "B"
    return m


@pytest.mark.parametrize("reverse", [False, True])
def test_stops_between_moving_bodies(reverse: bool) -> None:
    m = elbow(-0.4, 0.4, reverse)
    made = Automatic(m, m.sweep())
    [stop] = stops(made)
    meet = 2 * RADIUS + CLEAR * made.sizes.pivot.fit.running
    assert gaps(made, stop) == {"lower": pytest.approx(meet, abs=1e-3), "upper": pytest.approx(meet, abs=1e-3)}
    names = {
        body: [solid.name for solid in solids if solid.name.startswith("stop")]
        for body, solids in made.solids(engraved_too=False).items()
    }
    assert names == {"ground": [], "a": ["stop_B_lower", "stop_B_upper"], "b": ["stop_B_b"]}


def test_a_stop_that_is_not_reached_is_there_and_one_of_a_whole_turn_is_not() -> None:
    m = elbow(None, 1.0)
    [stop] = stops(Automatic(m, m.sweep()))
    assert [end for end, _ in stop.ends] == ["upper"]
    m = elbow(-3.0, 3.0)
    assert stops(Automatic(m, m.sweep())) == []


def block(limits: tuple[float | None, float | None], on_ground: bool = True) -> Mechanism:
    m = Mechanism("block", gravity=None)
    block = m.body("block")
    if on_ground:
        joint = m.prismatic("X", m.ground.at(0, 0, 0.3), block.origin)
    else:
        carrier = m.bar("carrier", 0.6)
        m.revolute("O", m.ground.origin, carrier.start)
        joint = m.prismatic("X", carrier.at(0.35, 0), block.origin)
        m.drive_angle("motor", carrier, constant_rate(1.0))
        m.start_near(carrier=0)
    m.stop("stop", joint, *limits)
    m.drive_coordinate("push", joint.i, joint.j, harmonic(0.05, 1.0))
    m.start_near(block=(0.0 if on_ground else 0.35, 0, math.degrees(0.3) if on_ground else 0))
    return m


def nearest(first: list[Solid], second: list[Solid]) -> float:
    """mm."""
    return min(a.shape.val().distance(b.shape.val()) for a in first for b in second)


@pytest.mark.parametrize("on_ground", [True, False])
def test_gibs_meet_the_blocks_at_the_end_of_the_rail(on_ground: bool) -> None:
    """As they are drawn, both bodies in their own frames: the block is at the middle of its way."""
    m = block((-0.05, 0.05), on_ground)
    made = Automatic(m, m.sweep())
    assert not meets(made)
    solids, rail = made.solids(engraved_too=False), "ground" if on_ground else "carrier"
    held = {
        word: [solid for solid in solids[rail] if solid.name.startswith(f"stop_X_{word}")]
        for word in ("lower", "upper")
    }
    turn, at = (math.degrees(0.3), 0.0) if on_ground else (0.0, 350.0)
    clear = CLEAR * made.sizes.pivot.fit.running * made.sizes.scale
    for word, way in (("lower", -50.0), ("upper", 50.0)):
        moved = [
            Solid(solid.name, solid.shape.translate((way + at, 0, 0)).rotate((0, 0, 0), (0, 0, 1), turn), "steel", 0)
            for solid in solids["block"]
            if solid.name.startswith("gib")
        ]
        assert nearest(moved, held[word]) == pytest.approx(clear, rel=1e-6)


def test_a_rail_reaches_its_stops_and_one_far_away_is_left_out() -> None:
    m = block((-0.08, 2.0))
    [stop] = [
        solid
        for solid in Automatic(m, m.sweep()).solids(engraved_too=False)["ground"]
        if solid.name.startswith("stop_X_lower_1")
    ]
    assert stop.shape.val().isValid()
    assert not [
        solid for solid in Automatic(m, m.sweep()).solids(engraved_too=False)["ground"] if "upper" in solid.name
    ]


def test_a_slot_ends_at_its_limits() -> None:
    m = Mechanism("slotted", gravity=None)
    crank, arm = m.bar("crank", 0.05), m.bar("arm", 0.2)
    m.revolute("O", m.ground.origin, arm.start)
    m.revolute("C", m.ground.at(0.1, 0), crank.start)
    m.pin_in_slot("S", arm.start, crank.end, limits=(0.04, None))
    m.drive_angle("motor", crank, constant_rate(1.0))
    m.start_near(crank=90, arm=20)
    made = Automatic(m, m.sweep())
    [slot] = [feature for feature in made.layout.features if isinstance(feature, Slot)]
    assert slot.path[0, 0] == pytest.approx(made.sizes.of_metres(0.04))
    assert slot.path[1, 0] == pytest.approx(made.sizes.of_metres(0.15) + 1.0, abs=1e-3)
