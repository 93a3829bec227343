"""Numbers of insights against closed forms: Whitworth, Geneva, Scotch yoke, Chebyshev, pendulum, gears and others."""

from __future__ import annotations

import math
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from scipy.special import ellipk

from mbsd import Mechanism, MechanismError, constant_rate
from mechanisms.cam_follower import mechanism as cam_follower
from mechanisms.geneva_drive import mechanism as geneva_drive
from mechanisms.quick_return import mechanism as quick_return
from mechanisms.stages.solve.motion_file import to_motion
from render.insights import Insight, insights
from render.insights.meeting import PIN, happening, meets
from render.magnitudes import length_scale
from shared.contract import Motion


@cache
def _gallery(name: str, seconds: float, **values: Any) -> Motion:
    module = import_module(f"mechanisms.{name}.mechanism")
    return _solved(module.build(module.Params(**values)), seconds)


def _solved(m: Mechanism, seconds: float = 0.0, steps: int = 360) -> Motion:
    solution = m.simulate(seconds, event_rows=True) if seconds else m.sweep(steps=steps)
    return to_motion(solution, None, "0" * 64, {}, dict.fromkeys(m.bodies, "mechanism"))


def found(name: str, kind: str, body: str = "", seconds: float = 0.0, **values: Any) -> Insight:
    """Return the first insight of a kind into a mechanism of the gallery."""
    return first(_gallery(name, seconds, **values), kind, body)


def first(motion: Motion, kind: str, name: str = "") -> Insight:
    """Return the first insight of a kind, of a body or joint if a name is given."""
    return next(
        each for each in insights(motion) if each.kind == kind and (not name or name in each.bodies + each.joints)
    )


@pytest.mark.parametrize("body", ["arm", "ram"])
@pytest.mark.parametrize("crank", [0.03, 0.04])
def test_whitworths_quick_return_is_that_of_its_tangents(body: str, crank: float) -> None:
    """The arm turns back where the crank is square to it: 180 degrees + 2 asin(crank / height) of the crank out."""
    each, beyond = found("quick_return", "quick_return", body, crank=crank), math.asin(crank / 0.1)
    out, back = math.pi + 2 * beyond, math.pi - 2 * beyond
    assert each.number == pytest.approx(out / back, rel=1e-4)
    assert each.end - each.start == pytest.approx(out / (math.pi / 2), rel=1e-4)
    assert f"{round(math.degrees(out))}°" in each.sentence()
    assert f"within {round(math.degrees(back))}°" in each.sentence()


def test_the_return_of_a_crank_rocker_is_that_of_its_dead_points() -> None:
    a, b, c, d = 0.04, 0.12, 0.09, 0.12
    stretched = math.acos(((b + a) ** 2 + d * d - c * c) / (2 * (b + a) * d))
    folded = math.pi + math.acos(((b - a) ** 2 + d * d - c * c) / (2 * (b - a) * d))
    way = (folded - stretched) / math.tau
    motion = _four_bar((a, b, c, d))
    assert first(motion, "quick_return").number == pytest.approx(max(way / (1 - way), (1 - way) / way), rel=1e-4)
    assert first(motion, "dead_point").number == pytest.approx(stretched, abs=1e-4)
    ends = [math.acos((c * c + d * d - (b + s * a) ** 2) / (2 * c * d)) for s in (-1, 1)]
    assert first(motion, "stroke").number == pytest.approx(ends[1] - ends[0], abs=1e-3)


@pytest.mark.parametrize(
    ("lengths", "template"),
    [((0.04, 0.12, 0.09, 0.12), "limit_crank"), ((0.03, 0.12, 0.08, 0.11), "limit_crank_folded")],
)
def test_a_crank_turns_round_up_to_its_limit_and_no_further(
    lengths: tuple[float, float, float, float], template: str
) -> None:
    each = first(_four_bar(lengths), "limit")
    assert each.template == template
    first(_four_bar((0.998 * each.number, *lengths[1:])), "limit")
    with pytest.raises(MechanismError):
        _four_bar((1.002 * each.number, *lengths[1:]))


def _four_bar(lengths: tuple[float, float, float, float], point: tuple[float, float] | None = None) -> Motion:
    a, b, c, d = lengths
    m = Mechanism("four_bar")
    crank, coupler, rocker = m.bar("crank", a), m.bar("coupler", b), m.bar("rocker", c)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(d, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(math.tau))
    m.start_near(crank=0, coupler=45, rocker=100)
    if point is not None:
        m.trace("P", coupler.at(*point))
    return _solved(m)


@pytest.mark.parametrize("slots", [4, 6])
def test_a_geneva_wheel_rests_and_is_fastest_as_its_geometry_says(slots: int) -> None:
    """It rests for 1/2 + 1/n of a turn; halfway the pin is at distance 1 - sin(pi / n), on a circle sin(pi / n)."""
    m, sine = geneva_drive.build(geneva_drive.Params(slots=slots)), math.sin(math.pi / slots)
    motion = _solved(m, steps=360 * slots)
    rest = first(motion, "dwell")
    assert rest.number == pytest.approx(0.5 + 1 / slots, abs=3e-3)
    assert (rest.end - rest.start) * math.pi == pytest.approx(math.tau * (0.5 + 1 / slots), abs=0.02)
    assert "locked" in rest.sentence()
    fastest = first(motion, "speed_peak")
    assert fastest.number == pytest.approx(sine / (1 - sine), rel=1e-4)


def test_a_yoke_is_a_cosine_and_a_slider_is_not() -> None:
    assert found("scotch_yoke", "cosine").number == pytest.approx(0.04, rel=1e-9)
    motion = _slider_crank(0.04, 0.12)
    assert not [each for each in insights(motion) if each.kind == "cosine"]
    # half of the stroke is where r cos a + sqrt(l^2 - r^2 sin^2 a) = l: cos a = r / (2 l)
    assert first(motion, "halves").number == pytest.approx(math.acos(0.04 / 0.24) / math.pi, abs=1e-4)
    assert first(motion, "transmission").number == pytest.approx(math.pi / 2 - math.asin(1 / 3), abs=1e-4)
    assert "19°" in first(motion, "transmission").sentence()
    assert first(motion, "stroke").number == pytest.approx(0.08, rel=1e-6)
    assert "twice the length of the crank" in first(motion, "stroke").sentence()


def _slider_crank(crank: float, rod: float) -> Motion:
    m = Mechanism("slider_crank")
    arm, link, block = m.bar("crank", crank), m.bar("rod", rod), m.body("slider", 0.5)
    m.revolute("O", m.ground.at(0, 0), arm.start)
    m.revolute("A", arm.end, link.start)
    m.revolute("B", link.end, block.origin)
    m.prismatic("guide", m.ground.at(0, 0), block.origin)
    m.drive_angle("motor", arm, constant_rate(math.tau))
    m.start_near(crank=0, rod=0)
    return _solved(m)


def test_chebyshevs_straight_line_deviates_as_a_dense_path_does() -> None:
    """The Lambda linkage 1 : 2 : 2.5 : 2.5 : 2.5, its path computed anew at 20000 angles of the crank."""
    unit = 0.02
    a, d, b = unit, 2 * unit, 2.5 * unit
    motion = _four_bar((a, b, b, d), (2 * b, 0.0))
    each = first(motion, "straight_line")
    first_angle, last_angle = (math.tau * at for at in (each.start, each.end))
    angle = np.linspace(first_angle, last_angle, 20000)
    crank = a * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    gap = np.array([d, 0.0]) - crank
    length = np.hypot(*gap.T)
    turn = np.arctan2(*gap.T[::-1]) + np.arccos(length / (2 * b))
    path = crank + 2 * b * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    middle = path - path.mean(axis=0)
    axes = np.linalg.svd(middle, full_matrices=False)[2]
    assert each.number == pytest.approx(np.abs(middle @ axes[1]).max(), rel=0.05)
    assert np.ptp(middle @ axes[0]) > 3 * unit
    assert each.end - each.start > 0.35, "half of the turn is straight"


def test_peaucelliers_line_is_exact_and_an_ellipse_is_one() -> None:
    assert found("peaucellier", "straight_line", "P").number < 1e-9
    each = found("trammel", "ellipse", "pen")
    assert each.number == pytest.approx(0.150, rel=1e-6)
    assert "300 mm by 140 mm" in each.sentence()


@pytest.mark.parametrize(("crossed", "words"), [(False, "while the small one turns twice."), (True, "the other way.")])
def test_a_belt_has_the_ratio_of_its_pulleys(crossed: bool, words: str) -> None:
    each = found("belt_drive", "speed_ratio", crossed=crossed)
    assert each.number == pytest.approx(-0.5 if crossed else 0.5)
    assert each.sentence().endswith(words)


def test_a_planetary_gear_has_willis_ratio() -> None:
    assert found("planetary_gear", "speed_ratio", "carrier").number == pytest.approx(0.25)


def test_a_pantograph_copies_to_scale() -> None:
    assert found("pantograph", "scale").number == pytest.approx(2.5, rel=1e-6)


def test_a_swing_takes_as_long_as_the_elliptic_integral_says() -> None:
    each = found("pendulum", "swing", seconds=8.0)
    small = math.tau * math.sqrt(2 * 0.3 / (3 * 9.81))
    assert each.number == pytest.approx(small * 2 / math.pi * ellipk(math.sin(math.radians(75)) ** 2), rel=1e-3)
    assert f"{each.number / small:.3g} times" in each.sentence()


def test_a_damped_swing_loses_what_its_decrement_says() -> None:
    motion = _gallery("mass_spring_damper", 2.0)
    root = math.sqrt(400.0 - 2.0**2)
    assert first(motion, "swing").number == pytest.approx(math.tau / root, rel=1e-3)
    assert first(motion, "decay").number == pytest.approx(math.exp(-2.0 * math.tau / root), rel=0.02)


def test_a_ball_comes_back_with_its_restitution() -> None:
    m = Mechanism("ball", gravity=(0.0, -9.81))
    ball = m.body("ball", 0.2, inertia=1e-4)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, radius=0.05, restitution=0.6)
    m.start_near(ball=(0, 1.05, 0))
    motion = _solved(m, 1.2)
    assert first(motion, "losses").number == pytest.approx(-sum(event.energy for event in motion.events))
    each = first(motion, "impact")
    speed = math.sqrt(2 * 9.81)
    assert each.number == pytest.approx(0.2 * speed * 1.6, rel=1e-6)
    assert each.start == pytest.approx(speed / 9.81, rel=1e-6)
    assert "4.43 m/s" in each.sentence()
    assert "60 %" in each.sentence()


def test_a_cam_presses_at_the_angle_of_its_lift() -> None:
    """tan of the pressure angle of a radial roller: slope of the lift over the distance of the roller's centre."""
    p = cam_follower.Params()
    m = cam_follower.build(p)
    m.bodies["follower"].mass = 0.1
    law = cam_follower.lift_law(p)(np.linspace(0, math.tau, 36001))
    angle = np.arctan2(np.abs(law[:, 1]), p.base + p.roller + law[:, 0])
    assert first(_solved(m), "pressure_angle").number == pytest.approx(float(angle.max()), abs=2e-3)


def test_a_toggle_goes_as_far_past_its_line_as_it_was_given() -> None:
    each = found("toggle_clamp", "toggle")
    assert each.number == pytest.approx(math.radians(3.0), abs=1e-3)
    assert each.sentence() == (
        "The handle goes 3° past the line with the link: there the arm cannot push it back, so it locks."
    )


def test_at_a_slot_as_much_happens_as_its_force_times_its_sliding() -> None:
    """The pin slides in the arm at the rate of its distance from the pivot."""
    m = quick_return.build(quick_return.Params())
    for body in m.bodies.values():
        body.mass = 0.1
    motion = _solved(m)
    joint, crank = motion.joints["slot"], 0.04 * np.exp(1j * np.asarray(motion.bodies["crank"].theta)) + 0.1j
    sliding = np.abs(np.gradient(np.abs(crank), motion.time, edge_order=2))
    turning = PIN * length_scale(motion) * np.abs(np.subtract(motion.bodies["crank"].omega, motion.bodies["arm"].omega))
    wanted = np.hypot(joint.fx, joint.fy) * (sliding + turning)
    assert happening(motion, "slot") == pytest.approx(wanted, abs=2e-3 * wanted.max())
    assert [name for name, each in motion.joints.items() if meets(each)] == ["slot"]


def test_a_geneva_pin_meets_its_wheel_while_that_turns() -> None:
    motion = _gallery("geneva_drive", 0.0)
    happens, omega = happening(motion, "index"), np.abs(motion.bodies["wheel"].omega)
    assert omega[int(happens.argmax())] > 0.05 * omega.max()


@pytest.mark.parametrize("damping", [0.0, 0.01])
def test_a_pendulum_stands_again_at_the_height_that_its_angle_says(damping: float) -> None:
    motion = _gallery("pendulum", 4.0, damping=damping)
    each = first(motion, "climbs")
    theta = np.asarray(motion.bodies["rod"].theta)
    k = int(np.argmin(np.abs(np.asarray(motion.time) - each.start)))
    assert each.number == pytest.approx((1 + math.sin(theta[k])) / (1 + math.sin(theta[0])), abs=1e-3)
    assert (each.number > 0.99) == (damping == 0.0)
