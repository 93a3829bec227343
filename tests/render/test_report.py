"""report.md: its numbers are those of the motion, its sentences are true, travel and events among them."""

from __future__ import annotations

import math
import re
from pathlib import Path

import msgspec
import numpy as np
import pytest

from mbsd import Mechanism, angle_reaches, constant_rate
from mechanisms.stages.solve.motion_file import to_motion
from render import report
from render.insights import insights
from render.insights.loops import loops
from render.magnitudes import floors
from render.report.facts import facts
from render.report.transmission import event_section
from render.report.travel import releases, stroke
from render.report.written import Amounts, degrees, speed, turning, written
from shared.contract import EventMark, Motion, Provenance, write_motion
from shared.contract.clearance import Clearance, PairClearance
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.models.motions import bouncing_ball, four_bar_motion

MOTION = four_bar_motion()


def slider_crank(
    crank: float = 0.05,
    rod: float = 0.15,
    mass: float = 0.5,
    start: float = 0.3,
    steps: int = 360,
    rate: float = 100.0,
) -> Motion:
    m = Mechanism("slider_crank")
    arm, link, block = m.bar("crank", crank), m.bar("rod", rod), m.body("slider", mass)
    m.revolute("O", m.ground.at(0, 0), arm.start)
    m.revolute("A", arm.end, link.start)
    m.revolute("B", link.end, block.origin)
    m.prismatic("guide", m.ground.at(0, 0), block.origin)
    m.drive_angle("motor", arm, constant_rate(rate, start))
    m.start_near(crank=math.degrees(start), rod=-math.degrees(math.asin(crank / rod * math.sin(start))))
    return to_motion(m.sweep(steps=steps), None, "0" * 64, {}, dict.fromkeys(("crank", "rod", "slider"), "mechanism"))


# -- transmission ----------------------------------------------------------------------------------------------------


def test_a_four_bars_transmission_angle_and_dead_points_are_those_of_its_triangles() -> None:
    a, b, c, d = 0.040, 0.120, 0.090, 0.120
    [loop] = loops(MOTION)
    assert (loop.crank, loop.coupler, loop.follower, loop.slides) == ("crank", "coupler", "rocker", False)
    assert loop.lengths == pytest.approx((a, b, c, d))
    ends = [math.acos((b * b + c * c - (d + s * a) ** 2) / (2 * b * c)) for s in (-1, 1)]
    assert loop.transmission.min() == pytest.approx(min(*ends, math.pi - ends[1]), abs=1e-6)
    angles = [angle for _, angle in loop.dead_points(np.array(MOTION.time))]
    # crank and coupler in line: a triangle of b + a or b - a, c and d
    stretched = math.acos(((b + a) ** 2 + d * d - c * c) / (2 * (b + a) * d))
    folded = math.pi + math.acos(((b - a) ** 2 + d * d - c * c) / (2 * (b - a) * d))
    assert angles == pytest.approx([stretched, folded], abs=1e-4)
    rocker = [math.acos(((b + s * a) ** 2 - c * c - d * d) / (-2 * c * d)) for s in (-1, 1)]
    assert loop.travel == pytest.approx(rocker[1] - rocker[0], abs=1e-3)


def test_a_slider_cranks_dead_points_are_its_dead_centres() -> None:
    motion = slider_crank()
    [loop] = loops(motion)
    assert loop.slides
    assert loop.transmission.min() == pytest.approx(math.acos(0.05 / 0.15), abs=1e-3)
    assert loop.travel == pytest.approx(0.1, abs=1e-4)
    angles = sorted(angle % (2 * math.pi) for _, angle in loop.dead_points(np.array(motion.time)))
    assert min(abs(math.sin(angle)) for angle in angles) < 1e-6
    assert len(angles) == 2


@pytest.mark.parametrize(("start", "steps"), [(0.0, 360), (0.0, 7), (math.pi, 36), (1e-4, 36), (math.pi / 2, 4)])
def test_dead_centres_on_the_seam_of_a_period_count_once(start: float, steps: int) -> None:
    motion = slider_crank(start=start, steps=steps)
    [loop] = loops(motion)
    angles = sorted(angle for _, angle in loop.dead_points(np.array(motion.time)))
    assert len(angles) == 2
    away = [min(abs(math.remainder(angle - dead, 2 * math.pi)) for dead in (0.0, math.pi)) for angle in angles]
    assert max(away) < 1e-6 + 0.6 / steps**2
    if steps > 30:
        assert "even_return" in {each.kind for each in insights(motion)}


def test_a_linkage_that_nothing_turns_has_no_driven_loop() -> None:
    free = msgspec.structs.replace(MOTION, drivers={})
    assert loops(free) == []
    assert "## Transmission" not in report.report(free, None, None)


def test_a_crank_that_forces_turn_has_its_dead_points_once_and_tells_how_evenly_it_runs() -> None:
    run = msgspec.structs.replace(four_bar_motion(turns=3), drivers={}, analysis="simulation", period=None)
    omega = np.array(run.bodies["crank"].omega) * (1 + 0.1 * np.cos(run.bodies["crank"].theta))
    crank = msgspec.structs.replace(run.bodies["crank"], omega=omega.tolist())
    said = report.report(msgspec.structs.replace(run, bodies=run.bodies | {"crank": crank}), None, None)
    [line] = [line for line in said.splitlines() if "are in line with the crank at" in line]
    assert line.count(" s)") == 3  # two dead points, and the least transmission angle
    assert "In its last turn the crank has 6.28 rad/s (60 rpm) on average" in said
    assert "its speed fluctuates by 20 % of the mean" in said
    assert "on average" not in report.report(MOTION, None, None)


def test_a_body_that_turns_about_its_centre_of_mass_does_not_move() -> None:
    still = msgspec.structs.replace(MOTION.bodies["crank"], com=(1e-19, 0.0))
    said = report.report(msgspec.structs.replace(MOTION, bodies=MOTION.bodies | {"crank": still}), None, None)
    assert "| crank | 0 |  | 0 | 6.28 rad/s (60 rpm) |" in said


# -- sentences -------------------------------------------------------------------------------------------------------


def test_peaks_are_told_with_their_time() -> None:
    text = report.report(MOTION, None, None)
    joint = MOTION.joints["C"]
    size = np.hypot(joint.fx, joint.fy)
    assert f"| C (revolute) | coupler, rocker | {written(float(size.max()), 'N')} |" in text
    p = MOTION.points["P"]
    fastest = float(np.hypot(p.vx, p.vy).max())
    assert f"| point P | {speed(fastest)} |" in text
    assert "6.28 rad/s (60 rpm)" in text
    assert "1 degree of freedom and is driven by motor" in text
    assert "weighs 270 g" in text
    assert "It was not checked" in text


def test_peaks_of_fast_machines_are_written_without_exponents() -> None:
    text = report.report(slider_crank(rate=400.0), None, None)
    assert re.search(r"\| slider \| .* m/s² \(\d{3,4} g\)", text), text
    assert not re.search(r"\de[+-]?\d+ g\b", text)


def test_a_sweeps_work_over_a_period_is_nothing() -> None:
    assert re.search(r"\| motor \|.*\| 0 J \|$", report.report(MOTION, None, None), flags=re.MULTILINE)


def test_impacts_and_their_losses() -> None:
    motion = bouncing_ball()
    text = report.report(motion, None, None)
    assert f"Impacts and other events (1 impact) take {written(0.75 * 0.2 * 9.81, 'J')}." in text
    assert "moved by forces alone" in text


def test_the_balance_of_a_simulation_counts_what_impacts_take() -> None:
    m = Mechanism("ball", gravity=(0.0, -9.81))
    body = m.body("ball", 0.2, inertia=1e-4)
    m.rigid_contact("floor", m.ground.at(0, 0), body.origin, radius=0.05, restitution=0.5)
    m.start_near(ball=(0, 1.05, 0))
    motion = to_motion(m.simulate(2.0, event_rows=True), None, "0" * 64, {}, {"ball": "mechanism"})
    text = report.report(motion, None, None)
    drift = re.search(r"drifts by .*: ([\d.e-]+) of the largest exchange", text)
    assert drift
    assert float(drift[1]) < 1e-9
    assert re.search(r"\| floor \(rigid contact\) \| 1\.96 N \|", text)


def test_massless_bodies_load_nothing() -> None:
    motion = slider_crank(mass=0.0)
    assert "Nothing loads the joints: no body has a mass, and no force acts." in report.report(motion, None, None)


def test_the_nearest_parts_are_named() -> None:
    pair = PairClearance(
        bodies=("crank", "coupler"), pieces=("pin_B", "coupler"), gap=0.0004, proven=0.00039, time=0.25, proof="motion",
        poses=90,
    )  # fmt: skip
    clearance = Clearance(
        mechanism="four_bar", provenance=Provenance(inputs="0" * 64, versions={}), limit=1e-5, resolution=1e-5,
        interpolation_error=0.0, pairs=[pair], apart=12,
    )  # fmt: skip
    text = report.report(MOTION, None, clearance)
    assert "pin_B (crank) and coupler (coupler) come nearest, to 400 µm at t = 0.25 s" in text


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (0.0123, "N", "12.3 mN"), (4200.0, "N", "4.2 kN"), (0.05, "kg", "50 g"), (3.2, "kg", "3.2 kg"),
        (0.0004, "m", "400 µm"), (-0.054, "N m", "\N{MINUS SIGN}54 mN·m"), (0.0, "W", "0 W"), (1234.0, "m", "1234 m"),
    ],
)  # fmt: skip
def test_numbers(value: float, unit: str, words: str) -> None:
    assert written(value, unit) == words


def test_speeds_and_angles() -> None:
    assert (speed(10.0), speed(10.0, travels=True)) == ("10 m/s", "10 m/s (36 km/h)")
    assert turning(2 * math.pi) == "6.28 rad/s (60 rpm)"
    assert degrees(-math.pi / 4) == "\N{MINUS SIGN}45.0°"


# -- the stage -------------------------------------------------------------------------------------------------------


def test_it_is_written_once(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = Out("four_bar")
    write_motion(out.motion, MOTION)
    report.run("four_bar")
    text = out.report.read_text()
    assert text.startswith("# Four bar\n\nFour-bar crank-rocker")  # as mechanism.py says
    report.run("four_bar")
    assert "nothing to do" in capsys.readouterr().out
    write_motion(out.motion, four_bar_motion(speed=3.0))
    report.run("four_bar")
    assert out.report.read_text() != text


def test_without_a_motion_it_says_so(out_root: Path) -> None:
    with pytest.raises(UserError, match=r"data\.json"):
        report.run("four_bar")


def test_powers_that_are_rounding_are_nothing() -> None:
    motor = MOTION.drivers["motor"]
    power = np.maximum(motor.power, 0.0)
    power[5] = -1e-13
    said = report.report(
        msgspec.structs.replace(MOTION, drivers={"motor": msgspec.structs.replace(motor, power=power.tolist())}),
        None,
        None,
    )
    [row] = [line for line in said.splitlines() if line.startswith("| motor |")]
    assert row.split("|")[6].strip() == "0 W"


def test_an_effort_that_is_rounding_beside_the_reactions_is_nothing() -> None:
    motor = MOTION.drivers["motor"]
    tuned = msgspec.structs.replace(
        motor, effort=list(1e-16 * np.array(motor.effort)), power=[1e-18] * len(MOTION.time)
    )
    motion = msgspec.structs.replace(MOTION, drivers={"motor": tuned})
    [row] = [line for line in report.report(motion, None, None).splitlines() if line.startswith("| motor |")]
    assert row == "| motor | 0 N·m | 0 s | 0 N·m | 0 W | 0 W | 0 J |"
    assert not [fact for fact in facts(motion, None, None) if fact.startswith("motor")]


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
    assert f"| guide (prismatic) | {pair} | 100 mm |" in report.report(motion, None, None)


def test_cranks_turn_and_rockers_swing() -> None:
    text = report.report(four_bar_motion(turns=3), None, None)
    assert re.search(r"^\| crank \|.*\| 3 turns \|$", text, flags=re.MULTILINE)
    motion = four_bar_motion()
    low, high = (math.degrees(end(motion.bodies["rocker"].theta)) for end in (min, max))
    row = next(line for line in report.report(motion, None, None).splitlines() if line.startswith("| rocker | "))
    assert f"| {high - low:.1f}° ({low:.1f}° to {high:.1f}°) |" in row
    p = motion.points["P"]
    spans = [Amounts(motion)(float(np.ptp(part)), "m", 4) for part in (p.x, p.y)]
    assert f"| point P | {spans[0]} | {spans[1]} |  |" in report.report(motion, None, None)


def test_released_bodies_have_their_flight_reported() -> None:
    motion = thrown()
    (row, event), arm = releases(motion)["hinge"], motion.bodies["arm"]
    assert (event, list(releases(motion))) == ("let_go", ["hinge"])
    middle = [np.asarray(arm.x) + 0.25 * np.cos(arm.theta), np.asarray(arm.y) + 0.25 * np.sin(arm.theta)]
    x, y = (Amounts(motion)(float(part[-1] - part[row]), "m", 4) for part in middle)
    text = report.report(motion, None, None)
    assert "From let_go on (t = " in text
    assert f"no joint holds arm on ground: to the end it goes {x} along x and {y} along y" in text
    assert "| let_go: event |" in text
    assert "| lands: end |" in text
    assert "holds" not in report.report(slider(), None, None)


def test_many_events_share_rows() -> None:
    motion = bouncing_ball()
    (hit, *_) = [event for event in motion.events if event.what == "impact"]
    many = [msgspec.structs.replace(hit, time=0.01 * k, impulse=-0.1 * k) for k in range(1, 526)]
    lines = event_section(msgspec.structs.replace(motion, events=[*many, EventMark(time=6.0, name="stop", what="end",
                                                                                   energy=0.0)]))  # fmt: skip
    assert lines[0] == "526 events, in groups; data.json has each."
    assert lines[-2] == f"| {hit.name}: impact | 525 | 0.01 s | 5.25 s | 52.5 N·s |"
    assert lines[-1] == "| stop: end | 1 | 6 s | 6 s |  |"
    assert len(event_section(motion)) == 2 + len(motion.events)


def test_rounding_is_nothing_beside_the_scale_of_a_mechanism() -> None:
    motion, small = four_bar_motion(), 1e-12
    amount = Amounts(motion)
    for unit, floor in floors(motion).items():
        assert floor > 0.0, unit
        assert amount(0.9 * floor, unit) == written(0.0, unit)
        assert not amount(1.1 * floor, unit).startswith("0 ")
    joint = motion.joints["A"]
    noisy = msgspec.structs.replace(joint, torque=[small * value for value in joint.fx])
    text = report.report(msgspec.structs.replace(motion, joints=motion.joints | {"A": noisy}), None, None)
    assert not re.search(r"\d [pn](N|W|J)", text.split("## Energy")[0])


def test_moments_of_inertia_are_in_units_that_people_know() -> None:
    text = report.report(four_bar_motion(), None, None)
    assert "kg mm²" not in text
    assert re.search(r"\| crank \|.* kg·cm² \|", text)
