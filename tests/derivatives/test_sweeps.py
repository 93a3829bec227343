"""Derivatives of sweeps against differences of whole sweeps, and against formulas."""

from __future__ import annotations

import numpy as np
import pytest

import mbsd.derivatives.sensitivities
from mbsd import Mechanism, ModelError, constant_rate
from mbsd.measures import integral, largest, samples
from mbsd.numbers.names import number_named, with_value
from mbsd.testing.derivatives import check_derivatives
from tools.random_mechanisms.linkages import linkage

RATE = 3.0


def crank() -> Mechanism:
    m = Mechanism("crank")
    arm = m.bar("arm", 0.2, mass=1.5)
    m.revolute("A", m.ground.at(0.1, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(RATE))
    m.trace("P", arm.end)
    return m


def slider_crank() -> Mechanism:
    m = Mechanism("slider_crank")
    arm, rod = m.bar("crank", 0.05, mass=0.2), m.bar("rod", 0.15, mass=0.3)
    slider = m.body("slider", mass=0.5)
    m.revolute("O", m.ground.at(0, 0), arm.start)
    m.revolute("A", arm.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0.01), slider.origin)
    m.drive_angle("motor", arm, constant_rate(100.0))
    m.spring("spring", m.ground.at(-0.1, 0.1), rod.at(0.1, 0.02), 200.0, damping=3.0, free_length=0.05)
    m.trace("P", rod.at(0.05, 0.03))
    m.start_near(crank=0, rod=0)
    return m


def test_a_crank_has_the_derivatives_of_its_formulas() -> None:
    s = crank().sensitivities(["P.x", "P.ay", "motor.effort"], ["arm.length", "A.x", "motor.rate", "arm.mass"], 2.0, 40)
    turn = RATE * s.t
    assert np.abs(s.of("P.x", "arm.length") - np.cos(turn)).max() < 1e-11
    assert np.abs(s.of("P.x", "A.x") - 1.0).max() < 1e-11
    assert np.abs(s.of("P.x", "motor.rate") + 0.2 * s.t * np.sin(turn)).max() < 1e-10
    assert np.abs(s.of("P.ay", "arm.length") + RATE**2 * np.sin(turn)).max() < 1e-9
    expected = 9.80665 * 0.1 * np.cos(turn)
    assert np.abs(s.of("motor.effort", "arm.mass") - expected).max() < 1e-9


def test_a_slider_crank_with_a_spring_agrees_with_differences_of_sweeps() -> None:
    numbers = [
        "crank.length", "rod.length", "rod.mass", "guide.y", "motor.rate", "spring.stiffness", "spring.free_length",
        "gravity.y", "P.x", "spring.i.x", "rod.com.x", "rod.A.y", "slider.mass", "spring.damping",
    ]  # fmt: skip
    quantities = ["slider.ax", "B.fx", "motor.effort", "P.x", "P.vy", "spring.effort", "kinetic", "rod.alpha"]
    errors = check_derivatives(slider_crank(), quantities, numbers, steps=60, tolerance=5e-8)
    assert errors["guide.y"] < 1e-9


@pytest.mark.parametrize("seed", [3, 5])
def test_random_linkages_agree_with_differences_of_whole_motions(seed: int) -> None:
    m = linkage(seed, 2, damping=True).m
    bodies = [body.name for body in m.bodies.values() if body.name != "ground"]
    numbers = [f"{bodies[0]}.mass", *(f"{joint}.i.x" for joint in list(m.joints)[:2]), f"{list(m.joints)[2]}.j.y"]
    first = next(iter(m.joints))
    reaction = f"joint {first}.fx" if first in {*m.bodies, *m.traces} else f"{first}.fx"
    quantities = [f"{bodies[-1]}.x", f"{bodies[0]}.omega", reaction]
    check_derivatives(m, quantities, numbers, 0.2, 10, tolerance=1e-5, step=1e-4)


def test_friction_in_joints_that_depends_on_their_reactions() -> None:
    m = slider_crank()
    m.friction("rub", m.joints["guide"], 0.2, slip_speed=0.5, length=0.04)
    m.friction("pin", m.joints["A"], 0.1, radius=0.01, slip_speed=0.05)
    check_derivatives(
        m, ["motor.effort", "B.fx"], ["rub.coefficient", "pin.radius", "rod.length", "slider.mass"], 0.05, 30,
        tolerance=1e-6,
    )  # fmt: skip


def test_joints_that_repeat_others_share_their_loads_as_in_the_sweep() -> None:
    m = Mechanism("shelf")
    left, right, shelf = m.bar("left", 0.2, mass=0.3), m.bar("right", 0.2, mass=0.3), m.body("shelf", mass=2.0)
    m.revolute("A", m.ground.at(0, 0), left.start)
    m.revolute("B", m.ground.at(0.3, 0), right.start)
    m.revolute("C", left.end, shelf.at(0, 0))
    m.revolute("D", right.end, shelf.at(0.3, 0))
    m.angle_lock("level", m.ground.origin, shelf.origin)  # repeats the parallelogram
    m.drive_angle("motor", left, constant_rate(1.0, 0.5))
    m.start_near(left=29, right=29, shelf=0)
    assert m.mobility().redundant
    check_derivatives(m, ["D.fy", "level.torque", "motor.effort"], ["shelf.mass", "motor.rate"], 0.5, 10, 1e-7)
    with pytest.raises(ModelError, match=r"no derivative by 'left.length': joints repeat others"):
        m.sensitivities("D.fy", "left.length", 0.5, 10)


def test_measures_and_functions_of_a_solution() -> None:
    m = slider_crank()
    of = {
        "peak": largest("motor.effort"),
        "energy": integral("motor.power"),
        "some": samples("P.x", [0.0]),
        "mine": lambda sol: float((sol.joint("B").magnitude ** 2).mean()),
        "curve": lambda sol: sol.body("slider").x - sol.point("P").x,
    }
    numbers = ["crank.length", "slider.mass"]
    s = m.sensitivities(of, numbers, steps=90)
    assert s["peak"].shape == (2,)
    assert s["curve"].shape == (91, 2)
    check_derivatives(m, of, numbers, float(s.t[-1]), 90, tolerance=1e-8)
    assert s.table().shape == (91, 3)


def test_a_measure_or_a_function_may_be_asked_for_alone() -> None:
    m = slider_crank()
    peak = largest("motor.effort")
    both = m.sensitivities({"peak": peak, "reach": lambda sol: sol.body("slider").x.max()}, "crank.length", steps=40)
    assert np.array_equal(m.sensitivities(peak, "crank.length", steps=40)["motor.effort"], both["peak"])
    alone = m.sensitivities(lambda sol: sol.body("slider").x.max(), "crank.length", steps=40)
    assert np.array_equal(alone["0"], both["reach"])


def test_efforts_of_other_actuators_than_those_that_made_the_motion() -> None:
    m = slider_crank()
    slider = m.bodies["slider"]
    m.force("pull", slider.origin, 0.0, (1.0, 0.0))
    of = {"pull": lambda sol: sol.mechanism.inverse_dynamics(sol, ["pull"]).efforts["pull"]}
    check_derivatives(m, of, ["slider.mass", "rod.length", "spring.stiffness", "motor.rate"], 0.02, 12, 1e-7)


def test_a_number_is_put_back_and_derived_ones_stay_derived() -> None:
    m = slider_crank()
    number = number_named(m, "rod.inertia")
    with with_value(m, number, 5.0):
        assert m.bodies["rod"].inertia == 5.0
    assert m.bodies["rod"].inertia == pytest.approx(0.3 * 0.15**2 / 12)
    m.change("rod", mass=0.6)
    assert m.bodies["rod"].inertia == pytest.approx(0.6 * 0.15**2 / 12)


@pytest.mark.parametrize(
    ("of", "to", "says"),
    [
        ("slider.ax", "crank.lenght", "'crank': there is no number 'lenght'"),
        ("slider.ax", "crnk.length", "there is no thing with numbers 'crnk', did you mean 'crank'"),
        ("slider.ax", ["crank.mass", "crank.mass"], "each once"),
        ("slider.ax", [], "each once"),
        ("slider.xx", "crank.length", "there is no quantity 'slider.xx'"),
        ({"a": 3.0}, "crank.length", "'a' is 3.0"),
        ({"a": lambda sol: "fast"}, "crank.length", "'a' gives 'fast'"),
        ({"a": lambda sol: 1 / 0}, "crank.length", "the function 'a' fails"),
        ([], "crank.length", "of is \\[\\]"),
        ({"a": lambda sol: []}, "crank.length", "'a' gives \\[\\]; it must give a number"),
        ({"a": lambda sol: ["1", "2"]}, "crank.length", "'a' gives \\['1', '2'\\]"),
        ({"a": lambda sol: True}, "crank.length", "'a' gives True"),
        ("slider.ax", "A", "'A' is no number; it has some: A.x, A.y, A.angle, A.i.x"),
        ("slider.ax", "gravty.y", "no thing with numbers 'gravty', did you mean 'gravity'"),
        ("slider.ax", "gravity", "'gravity' is no number; it has some: gravity.x, gravity.y"),
        ("slider.ax", "crank.moving.omega", "'crank' has no such number before start_moving gives it"),
    ],
)
def test_what_cannot_be_asked_is_refused(of: object, to: object, says: str) -> None:
    with pytest.raises(ModelError, match=says):
        slider_crank().sensitivities(of, to)  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("duration", [None, 10.0])
@pytest.mark.parametrize(
    ("asked", "says"),
    [
        ({"of": "slider.xx"}, "there is no quantity 'slider.xx', did you mean 'slider.x'"),
        ({"of": {"a": largest("motor.efort")}}, "there is no quantity 'motor.efort', did you mean 'motor.effort'"),
        ({"of": samples("slider.x", [0.123])}, "0.123 s is no output"),
        ({"of": lambda sol, more: 1.0}, "must be a function of a solution, a single argument"),
        ({"of": 3}, "of is 3"),
        ({"tolerance": 0.0}, "tolerance is 0; it must be positive"),
    ],
)
def test_what_cannot_be_asked_is_refused_before_a_motion_is_solved(
    asked: dict[str, object], says: str, duration: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ran(*given: object) -> None:
        raise AssertionError("it ran")

    monkeypatch.setattr(mbsd.derivatives.sensitivities, "sweep", ran)
    monkeypatch.setattr(mbsd.derivatives.sensitivities, "simulation_tangents", ran)
    simulated = {"simulate": duration is not None, "duration": duration}
    with pytest.raises(ModelError, match=says):
        slider_crank().sensitivities(**{"of": "slider.x", "to": "crank", "steps": 20, **simulated, **asked})  # pyright: ignore[reportArgumentType]


def test_a_number_at_its_end_is_differentiated_to_one_side() -> None:
    m = slider_crank()
    m.change("spring", damping=0.0)
    s = m.sensitivities("motor.effort", "spring.damping", steps=20)
    m.change("spring", damping=1.0)
    ahead = m.sweep(steps=20).driver("motor").effort
    m.change("spring", damping=0.0)
    assert np.abs(s["motor.effort"][:, 0] - (ahead - m.sweep(steps=20).driver("motor").effort)).max() < 1e-8


def rolling(kind: str) -> Mechanism:
    m = Mechanism(kind)
    first, second = m.body("first", 1.0, inertia=0.01), m.body("second", 2.0, inertia=0.05)
    if kind == "disc":
        m.prismatic("rail", m.ground.at(0, 0.1), first.origin)
        m.revolute("hub", first.origin, second.origin)
        m.rolling_disc("roll", m.ground.at(0, 0), second.origin, radius=0.1)
        m.drive_coordinate("motor", m.ground.at(0, 0.1), first.origin, constant_rate(0.3))
        m.start_near(first=(0, 0.1, 0), second=(0, 0.1, 20))
        return m
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(0.5 if kind == "gears" else 0.7, 0), second.origin)
    add = m.gear_pair if kind == "gears" else m.belt
    add("mesh", first.origin, second.origin, radius_i=0.2, radius_j=0.3)
    m.drive_angle("motor", first, constant_rate(3.0))
    m.start_near(first=0, second=20)
    return m


@pytest.mark.parametrize("kind", ["gears", "belt", "disc"])
def test_what_rolls_turns_with_its_start_angle(kind: str) -> None:
    s = rolling(kind).sensitivities(["second.theta", "second.omega"], ["second.start.angle"], 1.0, 10)
    assert np.abs(s["second.theta"] - 1.0).max() < 1e-10
    assert np.abs(s["second.omega"]).max() < 1e-10
