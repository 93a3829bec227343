"""Travel and events in report.md: strokes, ranges, turns, spans, flights, and lists that stay short."""

from __future__ import annotations

import math
import re

import msgspec
import numpy as np
import pytest

from mbsd import Mechanism, angle_reaches, constant_rate
from mechanisms.stages.solve.motion_file import to_motion
from render.magnitudes import floors
from render.report import report
from render.report.transmission import event_section
from render.report.travel import releases, stroke
from render.report.written import Amounts
from shared.contract import EventMark, Motion
from tools.models.motions import bouncing_ball, four_bar_motion


def slider(turn: float = 0.0, swapped: bool = False) -> Motion:
    """A slider-crank of 50 mm whose rail is turned; ``swapped``: the slider is the first body of its joint."""
    m = Mechanism("slider")
    arm, link, block = m.bar("crank", 0.05, mass=0.2), m.bar("rod", 0.15, mass=0.3), m.body("block", mass=0.5)
    m.revolute("O", m.ground.at(0, 0), arm.start)
    m.revolute("A", arm.end, link.start)
    m.revolute("B", link.end, block.origin)
    ends = m.ground.at(0, 0, turn), block.at(0, 0, turn)
    m.prismatic("guide", *(ends[::-1] if swapped else ends))
    m.drive_angle("motor", arm, constant_rate(100.0, turn))
    m.start_near(crank=math.degrees(turn), rod=math.degrees(turn))
    return to_motion(m.sweep(), None, "0" * 64, {}, dict.fromkeys(("crank", "rod", "block"), "mechanism"))


def thrown() -> Motion:
    """A pendulum of 0.5 m that is let go upright at 4 rad/s or more, and lands."""
    m = Mechanism("sling", gravity=(0.0, -9.81))
    arm = m.bar("arm", 0.5, mass=1.0, inertia=0.02)
    hinge = m.revolute("hinge", m.ground.origin, arm.start)
    m.start_near(arm=0)
    m.start_moving(arm=8.0)
    m.event("let_go", angle_reaches(arm, math.pi / 4), releases=hinge)
    m.event("lands", lambda t, moment: moment.body("arm").y + 0.5, direction=-1, terminal=True)
    return to_motion(m.simulate(3.0, event_rows=True), None, "0" * 64, {}, {"arm": "mechanism"})


@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("turn", [0.0, 0.7, -2.0])
def test_the_stroke_of_a_slider_is_twice_its_throw_along_any_rail(turn: float, swapped: bool) -> None:
    motion = slider(turn, swapped)
    assert stroke(motion, motion.joints["guide"]) == pytest.approx(0.1, abs=1e-9)
    pair = "block, ground" if swapped else "ground, block"
    assert f"| guide (prismatic) | {pair} | 100 mm |" in report(motion, None, None)


def test_cranks_turn_and_rockers_swing() -> None:
    text = report(four_bar_motion(turns=3), None, None)
    assert re.search(r"^\| crank \|.*\| 3 turns \|$", text, flags=re.MULTILINE)
    motion = four_bar_motion()
    low, high = (math.degrees(end(motion.bodies["rocker"].theta)) for end in (min, max))
    row = next(line for line in report(motion, None, None).splitlines() if line.startswith("| rocker | "))
    assert f"| {high - low:.1f}° ({low:.1f}° to {high:.1f}°) |" in row
    p = motion.points["P"]
    spans = [Amounts(motion)(float(np.ptp(part)), "m", 4) for part in (p.x, p.y)]
    assert f"| point P | {spans[0]} | {spans[1]} |  |" in report(motion, None, None)


def test_what_is_let_go_has_its_flight_told() -> None:
    motion = thrown()
    (row, event), arm = releases(motion)["hinge"], motion.bodies["arm"]
    assert (event, list(releases(motion))) == ("let_go", ["hinge"])
    middle = [np.asarray(arm.x) + 0.25 * np.cos(arm.theta), np.asarray(arm.y) + 0.25 * np.sin(arm.theta)]
    x, y = (Amounts(motion)(float(part[-1] - part[row]), "m", 4) for part in middle)
    text = report(motion, None, None)
    assert "From let_go on (t = " in text
    assert f"no joint holds arm on ground: to the end it goes {x} along x and {y} along y" in text
    assert "| let_go: event |" in text
    assert "| lands: end |" in text
    assert "holds" not in report(slider(), None, None)


def test_many_events_share_rows() -> None:
    motion = bouncing_ball()
    (hit, *_) = [event for event in motion.events if event.what == "impact"]
    many = [msgspec.structs.replace(hit, time=0.01 * k, impulse=-0.1 * k) for k in range(1, 526)]
    lines = event_section(msgspec.structs.replace(motion, events=[*many, EventMark(time=6.0, name="stop", what="end",
                                                                                   energy=0.0)]))  # fmt: skip
    assert lines[0] == "526 events, in groups; data.json has each."
    assert lines[-2] == f"| {hit.name}: impact | 525 | 0.01 s | 5.25 s | 52.5 N s |"
    assert lines[-1] == "| stop: end | 1 | 6 s | 6 s |  |"
    assert len(event_section(motion)) == 2 + len(motion.events)


def test_rounding_is_nothing_beside_the_scale_of_a_mechanism() -> None:
    motion, small = four_bar_motion(), 1e-12
    amount = Amounts(motion)
    for unit, floor in floors(motion).items():
        assert floor > 0.0, unit
        assert amount(0.9 * floor, unit) == f"0 {unit}"
        assert not amount(1.1 * floor, unit).startswith("0 ")
    joint = motion.joints["A"]
    noisy = msgspec.structs.replace(joint, torque=[small * value for value in joint.fx])
    text = report(msgspec.structs.replace(motion, joints=motion.joints | {"A": noisy}), None, None)
    assert not re.search(r"\d [pn](N|W|J)", text.split("## Energy")[0])


def test_moments_of_inertia_are_in_units_that_people_know() -> None:
    text = report(four_bar_motion(), None, None)
    assert "kg mm²" not in text
    assert re.search(r"\| crank \|.* kg cm² \|", text)
