"""Derivatives along simulations: formulas, differences of whole ones, and what events make of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, ModelWarning, curve
from mbsd.derivatives.free import free_tangents
from mbsd.measures import final, largest, samples
from mbsd.testing.derivatives import check_derivatives
from mechanisms.quarter_car import mechanism as quarter_car

GRAVITY = 9.80665


def ball(restitution: float = 0.7) -> Mechanism:
    m = Mechanism("ball")
    body = m.body("ball", mass=1.0, inertia=0.01)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), body.at(0, 0, math.pi / 2))
    m.coordinate_stop(
        "floor", m.ground.at(0, 0, math.pi / 2), body.at(0, 0, math.pi / 2), at=0.05, restitution=restitution
    )
    m.start_near(ball=(0, 0.5, 0))
    return m


def door() -> Mechanism:
    m = Mechanism("door")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.torsion_spring("spring", m.ground, rod, stiffness=2.0, damping=0.3, free_angle=-2.0)
    m.angle_stop("end", m.ground.at(0, 0), rod.start, at=-1.2, restitution=0.4)
    m.start_near(rod=0)
    return m


def oscillator() -> Mechanism:
    m = Mechanism("oscillator", gravity=None)
    mass = m.body("mass", mass=2.0, inertia=1.0)
    m.prismatic("guide", m.ground.at(0, 0), mass.origin)
    m.spring("spring", m.ground.at(-1.0, 0), mass.origin, 50.0, free_length=1.0)
    m.start_near(mass=(0.1, 0, 0))
    return m


def four_bar() -> Mechanism:
    m = Mechanism("four_bar")
    a, b, c = m.bar("a", 0.04, mass=0.2), m.bar("b", 0.12, mass=0.3), m.bar("c", 0.09, mass=0.2)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(0.12, 0), c.start)
    m.spring("spring", m.ground.at(0.05, 0.2), b.end, 300.0, damping=1.0, free_length=0.1)
    m.start_near(a=20, b=45, c=100)
    m.start_moving(a=30.0)
    m.trace("P", b.at(0.06, 0.03))
    return m


def test_an_oscillator_has_the_derivatives_of_its_formula() -> None:
    s = oscillator().sensitivities(["mass.x", "mass.vx"], ["spring.stiffness", "mass.start.x", "mass.mass"], 3.0, 60)
    omega, t = 5.0, s.t
    by_omega = -0.1 * t * np.sin(omega * t)
    assert np.abs(s.of("mass.x", "spring.stiffness") - by_omega * omega / 100.0).max() < 1e-7
    assert np.abs(s.of("mass.x", "mass.mass") + by_omega * omega / 4.0).max() < 1e-6
    assert np.abs(s.of("mass.vx", "mass.start.x") + omega * np.sin(omega * t)).max() < 1e-5


def test_a_ball_that_bounces_has_those_of_its_formula_across_impacts() -> None:
    s = ball().sensitivities(["ball.y", "ball.vy"], ["floor.restitution", "ball.start.y", "floor.at"], 0.6, 60)
    fall = math.sqrt(2 * 0.45 / GRAVITY)
    after = s.t > fall
    since, speed = s.t[after] - fall, GRAVITY * fall
    assert np.abs(s.of("ball.y", "floor.restitution")[after] - speed * since).max() < 1e-9
    assert np.abs(s.of("ball.y", "ball.start.y")[~after] - 1.0).max() < 1e-9
    by_drop = 1 / (GRAVITY * fall)  # of the time of the impact
    expected = 0.7 * GRAVITY * by_drop * since - (0.7 * speed - GRAVITY * since) * by_drop
    assert np.abs(s.of("ball.y", "ball.start.y")[after] - expected).max() < 1e-8
    assert len(s.solution.events) == 1


def test_a_four_bar_agrees_with_differences_of_simulations() -> None:
    numbers = ["a.length", "b.mass", "D.x", "spring.stiffness", "spring.free_length", "a.moving.omega", "P.x"]
    check_derivatives(four_bar(), ["c.theta", "b.omega", "A.fx", "spring.effort", "P.x"], numbers, 0.6, 30, 1e-5, 2e-4)


def test_compiled_tangents_are_those_in_arrays(monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = ["a.length", "b.mass", "D.x", "spring.stiffness", "gravity.y", "a.moving.omega", "c.start.angle"]
    of = ["a.theta", "b.ax", "C.fx", "spring.effort"]
    compiled = four_bar().sensitivities(of, numbers, 0.3, 30)
    monkeypatch.setattr(free_tangents, "can_differentiate", lambda terms: False)
    arrays = four_bar().sensitivities(of, numbers, 0.3, 30)
    for label in of:
        scale = np.abs(arrays[label]).max(axis=0)
        assert (np.abs(compiled[label] - arrays[label]) <= 1e-8 * scale).all(), label


def test_the_solution_is_that_of_simulate_to_the_bit() -> None:
    m = four_bar()
    own = m.sensitivities("a.theta", "a.mass", 0.3, 30).solution
    sol = m.simulate(0.3, 30, tolerance=1e-9)
    assert all(np.array_equal(getattr(own, part), getattr(sol, part)) for part in ("t", "q", "v", "a", "lam", "wrench"))


def test_tangents_of_a_smooth_simulation_are_as_exact_as_it_is() -> None:
    """Against a finer mesh of tangents: a fast four-bar, whose spring whips its crank round."""
    m = four_bar()
    numbers, of = ["a.length", "b.mass", "spring.stiffness", "a.moving.omega"], ["a.theta", "c.omega", "A.fx"]
    given = m.sensitivities(of, numbers, 0.6, 60)
    fine = m.sensitivities(of, numbers, times=np.linspace(0.0, 0.6, 601), tolerance=1e-12)
    for label in of:
        scale = np.abs(fine[label]).max(axis=0)
        assert (np.abs(given[label] - fine[label][::10]).max(axis=0) < 2e-6 * scale).all(), label


def test_a_wheel_on_a_bump_agrees_with_differences_where_its_road_is_wider_than_the_wheel() -> None:
    """The engine that keeps the speed works against the slip of the tyre, which settles within 0.5 ms."""
    m = quarter_car.build(quarter_car.Params())
    radius = 1.0 / float(np.abs(quarter_car.road(quarter_car.Params())(np.linspace(0.2, 1.2, 20001))[:, 2]).max())
    assert radius > quarter_car.Params().radius
    check_derivatives(m, ["engine.effort", "wheel.omega", "body.y"], ["body.mass"], 0.9, 45, tolerance=1e-4, step=1e-2)


def test_a_road_that_bends_more_tightly_than_the_wheel_is_warned_of(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its foot jumps where two places of the road are as near, and the tyre's force with it."""
    x = np.linspace(0.0, 0.4, 61)
    tight = curve([0.3, *(0.5 + x), 1.1], [0.0, *(0.025 * (1 - np.cos(5 * math.pi * x))), 0.0])
    monkeypatch.setattr(quarter_car, "road", lambda p: tight)
    m = quarter_car.build(quarter_car.Params())
    with pytest.warns(ModelWarning, match=r"quarter_car: derivatives along this simulation are known to .* at best"):
        m.sensitivities({"effort": largest("engine.effort")}, "body.mass", quarter_car.DURATION, steps=100)


@pytest.mark.parametrize("number", ["end.restitution", "end.at", "rod.length", "rod.mass", "spring.stiffness"])
def test_a_door_that_bounces_to_rest_agrees_at_its_end(number: str) -> None:
    of = {"angle": lambda sol: sol.body("rod").theta[[20, -1]], "push": final("A.fx")}
    check_derivatives(door(), of, [number], 0.9, 60, tolerance=1e-5, step=1e-5)


def test_a_rod_that_falls_on_a_rough_floor_agrees_with_differences() -> None:
    m = Mechanism("fall")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.rigid_contact("a", m.ground.at(0, 0), rod.start, friction=0.3, restitution=0.5)
    m.rigid_contact("b", m.ground.at(0, 0), rod.end, friction=0.2, restitution=0.5)
    m.start_near(rod=(0, 0.3, 35))
    of = {"x": final("rod.x"), "turn": final("rod.omega")}
    numbers = ["a.restitution", "a.friction", "b.restitution", "rod.length", "rod.start.angle"]
    check_derivatives(m, of, numbers, 0.4, 40, tolerance=1e-6, step=1e-4)


def test_a_box_that_slides_and_stops_agrees_with_differences() -> None:
    m = Mechanism("slide")
    box = m.body("box", mass=2.0, inertia=0.05)
    for name, x in (("left", -0.2), ("right", 0.2)):
        m.rigid_contact(name, m.ground.at(0, 0), box.at(x, -0.1), friction=0.3, static_friction=0.35)
    m.spring("spring", m.ground.at(2.0, 0.1), box.at(0.2, 0), 40.0, free_length=1.5)
    m.start_near(box=(0, 0.1, 0))
    m.start_moving(box=(1.0, 0, 0))
    s = check_derivatives(
        m, {"x": final("box.x"), "pull": final("spring.effort")},
        ["left.friction", "box.mass", "spring.stiffness", "box.moving.vx"], 1.0, 40, tolerance=1e-6, step=1e-4,
    )  # fmt: skip
    assert len(s) == 4


@pytest.mark.parametrize("ended", [False, True])
def test_measures_of_some_outputs_have_the_derivatives_of_these(ended: bool) -> None:
    m = door()
    if ended:
        m.event("low", lambda t, s: s.body("rod").theta + 0.5, terminal=True)
    numbers, times = ["rod.length", "end.restitution", "gravity.y"], [0.0, 0.05, 0.1, 0.35, 0.5, 0.7]
    whole = m.sensitivities("rod.theta", numbers, times=times)
    for measures in (
        {"last": final("rod.theta")},
        {"some": samples("rod.theta", [0.1, 0.05])},
        {"last": final("rod.theta"), "some": samples("rod.theta", [0.1, 0.05]), "again": final("rod.theta")},
    ):
        part = m.sensitivities(measures, numbers, times=times)
        assert np.array_equal(part.t, whole.t)
        for label in measures:
            row = -1 if label != "some" else [2, 1]
            assert np.array_equal(part.values[label], whole.values["rod.theta"][row])
            np.testing.assert_allclose(part[label], whole["rod.theta"][row], rtol=1e-9, atol=1e-12)


def test_the_end_of_a_simulation_moves_with_its_event() -> None:
    m = oscillator()
    m.event("middle", lambda t, moment: moment.body("mass").x - 0.05, direction=-1, terminal=True)
    s = m.sensitivities({"when": lambda sol: sol.t[-1], "x": final("mass.x"), "v": final("mass.vx")},
                        ["spring.stiffness", "mass.start.x"], 3.0, 60)  # fmt: skip
    when = math.acos(0.5) / 5.0
    assert s.values["when"] == pytest.approx(when)
    assert s.of("when", "spring.stiffness") == pytest.approx(-when / 5.0 * 5.0 / 100.0, rel=1e-6)
    assert s.of("x", "spring.stiffness") == pytest.approx(0.0, abs=1e-9)
    assert s.of("v", "mass.start.x") == pytest.approx(-5.0 * 0.1 / math.sqrt(0.1**2 - 0.05**2), rel=1e-5)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (
            lambda m: m.event("hit", lambda t, o: o.body("rod").theta + 0.5, action=lambda o: None),
            "what event 'hit' changes",
        ),
        (lambda m: m.friction("rub", m.joints["A"], 0.2, radius=0.01, sticks=True), "joints stick \\('rub'\\)"),
    ],
)
def test_what_has_no_derivative_is_refused(change: Any, says: str) -> None:
    m = door()
    change(m)
    with pytest.raises(ModelError, match=says):
        m.sensitivities("rod.theta", "rod.mass", 0.5, 20)


def test_joints_that_repeat_others_have_no_reactions_but_the_motion_has_derivatives() -> None:
    m = Mechanism("shelf")
    left, right, shelf = m.bar("left", 0.2, mass=0.3), m.bar("right", 0.2, mass=0.3), m.body("shelf", mass=2.0)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", m.ground.at(0.3, 0), right.start)
    m.revolute("C", left.end, shelf.at(0, 0))
    m.revolute("D", right.end, shelf.at(0.3, 0))
    m.angle_lock("level", m.ground.origin, shelf.origin)
    m.torsion_spring("spring", m.ground, left, stiffness=3.0, damping=0.1)
    m.start_near(left=29, right=29, shelf=0)
    check_derivatives(m, ["left.theta", "shelf.vx"], ["shelf.mass", "spring.stiffness"], 0.4, 20, tolerance=1e-6)
    with pytest.raises(ModelError, match="reactions of joints that repeat others"):
        m.sensitivities("A.fx", "shelf.mass", 0.4, 20)


def test_work_is_refused_by_name() -> None:
    with pytest.raises(ModelError, match="derivatives of 'work'"):
        door().sensitivities("work", "rod.mass", 0.1, 10)
