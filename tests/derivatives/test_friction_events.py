"""Derivatives across events of friction, freewheels and markers: each against differences that have converged."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, distance_reaches, harmonic, polynomial
from mbsd.testing.derivatives import check_derivatives

GRAVITY = 9.80665


def box(static: float, pull: object = None, feet: int = 2, stiffness: float = 0.0, speed: float = 0.0) -> Mechanism:
    """A box on feet of friction 0.3, which a law pulls along x or a spring; its centre of mass is off its middle."""
    m = Mechanism("box")
    body = m.body("box", mass=2.0, inertia=0.05, com=(0.03, 0.0))
    for name, x in (("left", -0.2), ("right", 0.2))[:feet]:
        m.rigid_contact(name, m.ground.at(0, 0), body.at(x, -0.1), friction=0.3, static_friction=static)
    if feet == 1:
        m.angle_lock("level", m.ground.origin, body.origin)
    if pull is not None:
        m.force("pull", body.at(0, 0), pull)
    if stiffness:
        m.spring("spring", m.ground.at(2.0, 0.1), body.at(0, 0), stiffness, free_length=1.5)
    m.start_near(box=(0, 0.1, 0))
    m.start_moving(box=(speed, 0, 0))
    return m


def test_sliding_that_begins_above_a_higher_static_friction_has_the_derivatives_of_its_formula() -> None:
    """Pulled by c t it holds until c t = mu_s m g, then slides against mu m g."""
    rate, mass, static = 20.0, 2.0, 0.5
    m = box(static, polynomial(0.0, rate), feet=1)
    s = m.sensitivities(["box.x", "box.vx"], ["left.static_friction", "left.friction"], 1.0, 40)
    begun = static * mass * GRAVITY / rate
    since = np.maximum(s.t - begun, 0.0)
    sliding = s.t > begun
    by_begun = -np.where(sliding, rate * begun - 0.3 * mass * GRAVITY, 0.0) / mass
    assert np.abs(s.of("box.vx", "left.static_friction") - by_begun * mass * GRAVITY / rate).max() < 1e-8
    assert np.abs(s.of("box.x", "left.static_friction") - by_begun * since * mass * GRAVITY / rate).max() < 1e-8
    assert np.abs(s.of("box.vx", "left.friction") + GRAVITY * since).max() < 1e-8


@pytest.mark.parametrize("feet", [1, 2])
def test_sliding_that_turns_round_agrees_with_differences(feet: int) -> None:
    m = box(0.6, feet=feet, stiffness=200.0, speed=1.0)
    numbers = ["left.friction", "box.mass", "spring.stiffness", "box.moving.vx"]
    check_derivatives(m, ["box.x", "box.vx"], numbers, 1.0, 20, tolerance=1e-8, confirmed=True)
    turned = m.simulate(1.0).contact("left").friction
    assert turned.min() < 0.0 < turned.max()


@pytest.mark.parametrize(("left", "right"), [(0.5, 0.5), (0.35, 0.9)])
def test_feet_that_give_way_together_agree_with_differences(left: float, right: float) -> None:
    m = box(left, polynomial(0.0, 20.0))
    m.change("right", static_friction=right)
    numbers = ["left.static_friction", "right.static_friction", "box.com.x"]
    check_derivatives(m, ["box.x", "box.vx"], numbers, 0.8, 4, tolerance=1e-8)


@settings(max_examples=3, deadline=None)
@given(amplitude=st.floats(13.0, 40.0), rate=st.floats(3.0, 9.0), static=st.floats(0.31, 0.6))
def test_a_box_that_is_pushed_to_and_fro_agrees_with_differences(amplitude: float, rate: float, static: float) -> None:
    m = box(static, harmonic(amplitude, rate), feet=1)
    if amplitude < 1.05 * static * 2.0 * GRAVITY:
        return
    check_derivatives(
        m, ["box.x"], ["left.static_friction", "pull.amplitude", "pull.rate"], 1.0, 8, tolerance=1e-6, step=1e-4
    )


def test_how_friction_at_rest_is_shared_has_no_derivative_and_says_so() -> None:
    m = box(0.5, 5.0)
    with pytest.raises(ModelError, match=r"'share' has no derivative: .* friction that contacts at rest share"):
        m.sensitivities({"share": lambda sol: sol.contact("left").friction}, "box.mass", 0.1, 4)
    s = m.sensitivities({"press": lambda sol: sol.contact("left").normal}, "box.mass", 0.1, 4)
    assert np.abs(s["press"] - GRAVITY * (0.2 - 0.03) / 0.4)[1:].max() < 1e-6


def freewheel(clockwise: bool = False) -> Mechanism:
    m = Mechanism("freewheel", gravity=None)
    first, second = m.body("first", 1.0, inertia=0.02), m.body("second", 1.0, inertia=0.05)
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(0, 0), second.origin)
    m.one_way("clutch", first, second, clockwise)
    m.torsion_spring("spring", m.ground, first, stiffness=2.0, damping=0.01, free_angle=-0.3 if clockwise else 0.3)
    m.torsion_spring("load", m.ground, second, stiffness=0.3, damping=0.1)
    m.start_near(first=0, second=0)
    sign = -1.0 if clockwise else 1.0
    m.start_moving(first=0.5 * sign, second=sign)
    return m


@pytest.mark.parametrize("clockwise", [False, True])
def test_a_freewheel_that_closes_agrees_with_differences(clockwise: bool) -> None:
    m = freewheel(clockwise)
    numbers = ["first.inertia", "spring.stiffness", "load.damping", "second.moving.omega"]
    check_derivatives(m, ["first.theta", "second.omega"], numbers, 1.0, 20, tolerance=1e-7, confirmed=True)
    assert [event.what for event in m.simulate(1.0).events][:3] == ["closes", "opens", "closes"]


def pendulum(watch: str, length: float = 1.0) -> Mechanism:
    m = Mechanism("pendulum")
    rod = m.bar("rod", length, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=0)
    if watch == "distance":
        m.event("low", distance_reaches(m.ground.at(0.3, -1.2), rod.end, 0.5), direction=-1, terminal=True)
    elif watch == "numbers":
        m.event("low", lambda t, q, v: q[1] + 0.5, direction=-1, terminal=True, frames=(rod.end,))
    else:
        m.event("low", lambda t, moment: moment.point(rod.end).y + 0.5, direction=-1, terminal=True)
    return m


@pytest.mark.parametrize("watch", ["distance", "numbers", "moment"])
def test_an_event_that_watches_the_end_of_a_bar_moves_with_its_length(watch: str) -> None:
    s = pendulum(watch).sensitivities({"when": lambda sol: sol.t[-1]}, "rod.length", 1.0, 20)
    times = [pendulum(watch, 1.0 + h).simulate(1.0, tolerance=1e-12).t[-1] for h in (-2e-3, -1e-3, 1e-3, 2e-3)]
    expected = float(np.array([1.0, -8.0, 8.0, -1.0]) @ times) / 12e-3
    assert s.of("when", "rod.length") == pytest.approx(expected, rel=1e-5)


# -- where there is no derivative ------------------------------------------------------------------------------------


def falling(height: float, speed: float = 0.0, feet: bool = False) -> Mechanism:
    m = Mechanism("ball")
    ball = m.body("ball", mass=1.0, inertia=0.01)
    for name, x in (("left", -0.2), ("right", 0.2)) if feet else (("left", 0.0),):
        m.rigid_contact(name, m.ground.at(0, 0), ball.at(x, -0.05), restitution=0.7)
    m.start_near(ball=(0, height, 0))
    m.start_moving(ball=(0.3, speed, 0))
    return m


def test_two_impacts_at_one_time_have_derivatives_only_by_what_keeps_them_together() -> None:
    m = falling(0.5, feet=True)
    check_derivatives(m, ["ball.y", "ball.vy"], ["ball.start.y", "gravity.y"], 0.4, 20, tolerance=1e-7, confirmed=True)
    for number in ("ball.start.angle", "ball.moving.omega", "left.y"):
        says = f"no derivative by '{number}' beyond t = 0.30.* s: 'left' and 'right' are met at one time"
        with pytest.raises(ModelError, match=says):
            m.sensitivities("ball.y", number, 0.4, 20)


def test_a_start_in_contact_has_no_derivative_by_what_opens_it() -> None:
    m = falling(0.05)
    rests = m.sensitivities("ball.x", ["ball.mass", "ball.moving.vx"], 0.3, 10)
    assert np.abs(rests.of("ball.x", "ball.moving.vx") - rests.t).max() < 1e-9
    for number in ("ball.start.y", "ball.moving.vy", "left.y"):
        with pytest.raises(ModelError, match=f"no derivative by '{number}': contact 'left' is closed at the start"):
            m.sensitivities("ball.y", number, 0.3, 10)


def test_a_motion_that_begins_with_an_impact_is_an_error() -> None:
    with pytest.raises(ModelError, match="begins with an impact of 'left'"):
        falling(0.05, -1.0).sensitivities("ball.y", "left.restitution", 0.1, 10)


def test_a_row_of_balls_that_touch_passes_derivatives_on() -> None:
    m = Mechanism("cradle", gravity=None)
    for k, x in enumerate((-0.1, 0.1, 0.2)):
        ball = m.body(f"b{k}", mass=1.0, inertia=0.01)
        m.prismatic(f"g{k}", m.ground.at(0, 0), ball.origin)
        m.start_near(**{f"b{k}": (x, 0, 0)})
        m.start_moving(**{f"b{k}": (1.0 if k == 0 else 0.0, 0, 0)})
    for k in (0, 1):
        m.rigid_discs(f"c{k}", m.bodies[f"b{k}"].origin, m.bodies[f"b{k + 1}"].origin, 0.05, 0.05, restitution=1.0)
    s = m.sensitivities("b2.x", ["b0.moving.vx", "b0.start.x"], 0.45, 3)
    assert s.of("b2.x", "b0.moving.vx")[-1] == pytest.approx(0.45, abs=1e-8)  # x = 0.2 + v (t - 0.1 / v)
    assert s.of("b2.x", "b0.start.x")[-1] == pytest.approx(1.0, abs=1e-8)
    with pytest.raises(ModelError, match=r"no derivative by 'b1.start.x' beyond t = 0\.1 s"):
        m.sensitivities("b2.x", "b1.start.x", 0.45, 3)


# -- Genevas ---------------------------------------------------------------------------------------------------------


def geneva(angle: float, slots: int = 4) -> Mechanism:
    m = Mechanism("geneva")
    crank, wheel = m.body("crank", 0.1, inertia=1e-4), m.body("wheel", 0.2, inertia=2e-4)
    m.revolute("A", m.ground.at(0, 0), crank.origin)
    m.revolute("B", m.ground.at(0.1, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots=slots, radius=0.1 * math.sin(math.pi / slots))
    m.torque("turn", crank, 0.01)
    m.start_near(crank=math.degrees(angle))
    m.start_moving(crank=2.0)
    return m


@pytest.mark.parametrize(("angle", "duration"), [(-0.4, 0.35), (-1.2, 0.3)])
@pytest.mark.filterwarnings("error")
def test_a_geneva_agrees_with_differences_from_inside_and_outside_its_slot(angle: float, duration: float) -> None:
    numbers = ["crank.start.angle", "turn.torque", "wheel.inertia", "crank.moving.omega"]
    m = geneva(angle)
    check_derivatives(m, ["wheel.theta", "crank.theta"], numbers, duration, 7, tolerance=3e-7, step=3e-4)
    s = m.sensitivities("crank.theta", numbers, duration, 7)
    assert not s.solution.events
    assert s.solution.mechanism is m


def belt(scale: float = 1.0, turn: float = 0.0) -> Mechanism:
    """A block on a belt that sticks until its spring pulls it off; till then no number moves it."""
    c, s = scale * math.cos(turn), scale * math.sin(turn)
    m = Mechanism("belt", gravity=(10.0 * s, -10.0 * c))
    band, block = m.body("band", 1.0, inertia=scale**2), m.body("block", 1.0, inertia=scale**2)
    m.prismatic("rail", m.ground.at(0, 0, turn), band.origin)
    m.drive_coordinate("motor", m.ground.at(0, 0, turn), band.origin, polynomial(0.0, 0.1 * scale))
    m.rigid_contact("touch", band.origin, block.origin, friction=0.4, static_friction=0.6)
    m.spring("spring", m.ground.at(-3.0 * c, -3.0 * s), block.origin, 50.0, free_length=3.0 * scale)
    m.start_near(band=(0, 0, math.degrees(turn)), block=(0, 0, math.degrees(turn)))
    return m


@pytest.mark.parametrize(("scale", "turn"), [(1.0, 0.0), (1e-3, 0.7), (1e3, -0.4)])
def test_a_block_on_a_belt_slips_later_or_sooner(scale: float, turn: float) -> None:
    """It slips at t = mu_s m g / (k v), which a stiffer spring and a faster belt bring nearer."""
    m = belt(scale, turn)
    numbers = ["touch.static_friction", "spring.stiffness"]
    check_derivatives(m, ["block.x"], numbers, 1.5, 6, tolerance=1e-7, step=1e-4)
