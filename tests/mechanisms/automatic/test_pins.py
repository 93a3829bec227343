"""Pins that several joints share, pins with play, welds and stops."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from math import pi, sin
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.cams import CLEAR
from mechanisms.stages.automatic.layout.planar import placed
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.stops import RADIUS, Stop
from mechanisms.stages.automatic.pins.welds import BLOCK, Weld
from mechanisms.stages.automatic.slides.slots import Slot
from mechanisms.stages.automatic.wheels.wheels import Wheel
from shared.shapes.solid import Solid
from shared.stage.errors import UserError
from tests.mechanisms.automatic.proofs import meets
from tests.shared.shape_checks import checked
from tools.hunt_parts.case import parts_of
from tools.models.four_bars import model

# A pin that runs in several slots at once: one pin with a roller in each.


def sine_and_cosine(turn: float) -> Mechanism:
    """Two Scotch yokes at right angles on one crank pin."""
    m = Mechanism("sine_and_cosine")
    crank = m.bar("crank", 0.05)
    m.revolute("O", m.ground.origin, crank.start)
    for name, angle in (("cosine", turn), ("sine", turn + pi / 2)):
        yoke = m.body(name)
        m.pin_in_slot(f"slot_{name}", yoke.at(0, 0, pi / 2), crank.end)
        m.prismatic(f"guide_{name}", m.ground.at(0, 0, angle), yoke.at(0.14, 0))
        m.start_near(**{name: (0.03 * math.cos(angle), 0.03 * math.sin(angle), math.degrees(angle))})
    m.drive_angle("motor", crank, constant_rate(1.0, turn + 0.5))
    return m


def two_levers(turn: float) -> Mechanism:
    """Two levers swing about pivots on ground, and one crank pin runs in both."""
    m = Mechanism("two_levers")
    crank = m.bar("crank", 0.05)
    m.revolute("O", m.ground.origin, crank.start)
    for name, angle in (("first", turn), ("second", turn + pi / 2)):
        lever = m.bar(name, 0.2)
        m.revolute(f"P_{name}", m.ground.at(-0.1 * math.cos(angle), -0.1 * math.sin(angle)), lever.start)
        m.pin_in_slot(f"slot_{name}", lever.start, crank.end)
        m.start_near(**{name: math.degrees(angle)})
    m.drive_angle("motor", crank, constant_rate(1.0, turn))
    return m


def two_genevas(turn: float) -> Mechanism:
    """A crank pin indexes a wheel on its right and one on its left."""
    m = Mechanism("two_genevas")
    crank = m.body("crank")
    m.revolute("O", m.ground.origin, crank.origin)
    for name, side in (("right", turn), ("left", turn + pi)):
        wheel = m.body(name)
        m.revolute(f"W_{name}", m.ground.at(0.08 * math.cos(side), 0.08 * math.sin(side)), wheel.origin)
        m.geneva(f"index_{name}", crank.origin, wheel.origin, slots=4, radius=0.08 * sin(pi / 4))
        m.start_near(**{name: math.degrees(turn) + 45})
    m.drive_angle("motor", crank, constant_rate(1.0, turn))
    return m


@pytest.mark.parametrize("turn", [0.0, 0.9])
@pytest.mark.parametrize("build", [sine_and_cosine, two_levers, two_genevas])
def test_one_pin_with_a_roller_in_each_slot(build: Callable[[float], Mechanism], turn: float) -> None:
    m = build(turn)
    made = Automatic(m, m.sweep(2 * pi, steps=180))
    assert not meets(made)
    plan = made.plan()
    here = plan.solids["crank"]
    pins = [solid for solid in here if solid.name.startswith("pin_")]
    assert len(pins) == 1
    assert sum(solid.name.startswith("roller_") for solid in here) == 2
    box = pins[0].shape.val().BoundingBox()
    for body in made.levels:
        low, high = made.heights.bottom(body), made.heights.top(body)
        assert box.zmin < low + 0.5
        assert box.zmax > high - 0.5
    for solid in here:
        checked(solid.shape, solid.through_holes)
    [crank] = [solid for solid in made.solids(engraved_too=False)["crank"] if solid.name == "crank"]
    checked(crank.shape, crank.through_holes)


def test_pin_of_a_slot_where_a_rod_has_its_pin_is_refused() -> None:
    m = sine_and_cosine(0.0)
    rod, block = m.bar("rod", 0.2), m.body("block")
    m.revolute("A", m.bodies["crank"].at(0.05, 0), rod.start)
    m.revolute("B", rod.end, block.origin)
    m.prismatic("way", m.ground.at(0, 0, pi), block.at(0, 0, pi))
    m.start_near(rod=180, block=(-0.16, 0, 0))
    with pytest.raises(UserError, match="pin of joint 'slot_cosine' is where crank has that of joint 'A'"):
        _ = Automatic(m, m.sweep(1.0, steps=20)).layout


# Pins and gears with play as solids: bushings bored wider by what the journal moves, teeth with their backlash.


def loose_crank(clearance: float, **joint: Any) -> Mechanism:
    """A slider-crank with play at the slider's pin."""
    m = Mechanism("loose_crank", gravity=None)
    crank, rod = m.bar("crank", 0.05, mass=0.3), m.bar("rod", 0.12, mass=0.2)
    slider = m.body("slider", mass=0.1, inertia=1e-4)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.clearance_joint("B", rod.end, slider.origin, clearance, 0.01, **({"stiffness": 1e9} | joint))
    m.drive_angle("motor", crank, constant_rate(20.0))
    m.start_near(crank=40, rod=-15)
    return m


def planned(m: Mechanism, duration: float = math.pi / 10) -> Automatic:
    return Automatic(m, m.simulate(duration, 200, event_rows=True))


def test_a_pin_with_play_has_bushings_bored_as_much_wider() -> None:
    m = loose_crank(0.5e-3)
    parts = planned(m)
    [pin] = [feature for feature in parts.layout.select(Pin) if feature.play]
    moved = -m.simulate(math.pi / 10, 200, event_rows=True).force("B").gap.min() + 0.5e-3
    assert pin.name == "B"
    assert 1e3 * moved <= pin.play * parts.sizes.scale < 1.05e3 * moved  # it sees more poses than the outputs
    pieces = {piece.name: piece for body in parts.solids(engraved_too=False).values() for piece in body}
    plain = parts.sizes.pivot.bored()
    for name, bored in (("A", plain), ("B", plain + 2.0 * pin.play)):
        edges = pieces[f"bushing_{name}_low"].shape.edges("%CIRCLE").vals()
        assert 2.0 * min(edge.radius() for edge in edges) == pytest.approx(bored * parts.sizes.scale, abs=1e-6)


def test_too_much_play_and_a_shared_place_are_refused() -> None:
    with pytest.raises(UserError, match=r"clearance joint 'B' moves .* mm to a side, and bushings of"):
        _ = planned(loose_crank(4e-3)).layout
    m = loose_crank(0.5e-3)
    extra = m.bar("extra", 0.1, mass=0.1)
    m.revolute("C", m.bodies["slider"].origin, extra.start)
    with pytest.raises(UserError, match="'B' and 'C' are at one place of 'slider'"):
        _ = planned(m).layout


def test_teeth_of_gears_with_play_have_their_backlash() -> None:
    def gears(backlash: float) -> list[Wheel]:
        m = Mechanism("gears", gravity=None)
        a, b = m.body("a", mass=1.0, inertia=2e-3), m.body("b", mass=1.0, inertia=1e-3)
        m.revolute("A", m.ground.at(0, 0), a.origin)
        m.revolute("B", m.ground.at(0.09, 0), b.origin)
        m.gear_mesh("mesh", a.origin, b.origin, 1e7, teeth=(40, 20), module=3e-3, backlash=backlash)
        m.start_moving(a=5.0)
        parts = planned(m)
        wheels = parts.layout.select(Wheel)
        for wheel in wheels:
            wheel.play *= parts.sizes.scale
        return wheels

    tight, loose = gears(0.0), gears(0.4e-3)
    assert sorted(wheel.teeth for wheel in loose) == [20, 40]
    assert [wheel.play for wheel in loose] == pytest.approx([wheel.play + 0.4 for wheel in tight], abs=1e-9)
    assert np.isfinite([wheel.phase for wheel in loose]).all()


# Bolts of welds stay clear of the pins of both bodies: a load welded at a joint, or beside one. No CAD is built.


LENGTHS = (0.1, 0.25, 0.2, 0.22)


def _loaded(*places: float, body: str = "rocker") -> Automatic:
    """A four-bar with loads welded to a bar, at these distances from its first joint (m)."""
    m = model(LENGTHS)
    for k, place in enumerate(places):
        load = m.body(f"load{k}", 5.0, inertia=0.01)
        m.weld(f"fix{k}", m.bodies[body].at(place, 0.0), load.at(0.0, 0.0))
    return _planned(m)


def _planned(m: Mechanism) -> Automatic:
    return Automatic(m, m.sweep(times=np.linspace(0, 2 * np.pi, 121)))


def _gap(weld: Weld, body: str, place: tuple[float, float]) -> float:
    """From a place of a body to the line between both bolts (rmm)."""
    line = np.linspace(*weld.bolts(body), 200)
    return float(np.hypot(*(line - place).T).min())


@pytest.mark.parametrize("body", ["crank", "coupler", "rocker"])
@pytest.mark.parametrize("places", [(0.0,), (0.018,), (0.2,), (0.19, 0.2)])
def test_bolts_of_a_load_at_or_beside_a_joint_clear_its_hardware(body: str, places: tuple[float, ...]) -> None:
    """Such loads were refused for their bores, or their spacers met the flanges of bushings."""
    made = _loaded(*places, body=body)
    assert not meets(made)
    welds = made.layout.select(Weld)
    pins = made.layout.select(Pin)
    assert len(welds) == len(places)
    for weld in welds:
        ends = [
            np.array([made.layout.seen(mover, bolt, "ground")[7] for bolt in weld.bolts(mover)])
            for mover in weld.movers
        ]
        np.testing.assert_allclose(ends[0], ends[1], atol=1e-4)
        for mover in weld.movers:
            places_of_pins = [pin.places[mover] for pin in pins if mover in pin.places]
            assert all(_gap(weld, mover, place) > BLOCK + made.sizes.hardware for place in places_of_pins)
    for first, second in pairwise(welds):
        assert min(_gap(first, body, bolt) for bolt in second.bolts(body)) > 2 * BLOCK


def test_a_weld_far_from_all_joints_stays_where_it_is() -> None:
    (weld,) = _loaded(0.1).layout.select(Weld)
    middle = np.mean(weld.bolts("load0"), axis=0)
    assert math.hypot(*middle) < 1e-9


def test_a_plate_without_room_for_bolts_is_refused() -> None:
    m = model(LENGTHS)
    load = m.body("load", 5.0, inertia=0.01)
    m.weld("fix", m.bodies["rocker"].at(0.0, 0.0), load.origin)
    for k, (x, y) in enumerate(np.ndindex(13, 13)):
        m.revolute(f"P{k}", load.at(0.02 * (x - 6), 0.02 * (y - 6)), m.body(f"k{k}", 0.1, inertia=1e-4).origin)
    made = Automatic(m, _planned(model(LENGTHS)).solution, pin=8.0)
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.layout.motion import times_of
    from mechanisms.stages.automatic.pins.pins import gather as pins
    from mechanisms.stages.automatic.pins.welds import gather as welds
    from mechanisms.stages.automatic.pins.welds import with_free_bolts

    layout = Layout(m, made.wishes()[0], {}, times_of(made.solution))
    features = [*pins(m, [j for j in m.joints.values() if j.kind.name == "revolute"], layout)]
    features += welds(m, [m.joints["fix"]], layout)
    with pytest.raises(UserError, match="'load' together find no place"):
        with_free_bolts(features, layout)


# Limits and stops of joints become stop pins, blocks beside rails and ends of slots, which meet at the limit.


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
    return made.layout.select(Stop)


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
    [slot] = made.layout.select(Slot)
    assert slot.path[0, 0] == pytest.approx(made.sizes.of_metres(0.04))
    assert slot.path[1, 0] == pytest.approx(made.sizes.of_metres(0.15) + 1.0, abs=1e-3)
