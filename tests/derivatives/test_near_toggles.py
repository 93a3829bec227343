"""Derivatives near poses where a little of a number is much of the motion, and of motions that grow."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import mbsd
from mbsd.derivatives import simulations
from mbsd.derivatives.free import explicit_time
from mbsd.numbers.names import number_named, with_values

OF = ["b.theta", "b.omega", "c.omega"]
Law = Any
"""Law of a torque: a motion, or a function of time."""


def flat(start: float, speed: float) -> mbsd.Mechanism:
    """Nearly a parallelogram, which passes its flat pose."""
    m = mbsd.Mechanism("flat")
    a, b, c = m.bar("a", 0.1, mass=1.0), m.bar("b", 0.3, mass=1.0), m.bar("c", 0.1, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(0.3001, 0), c.start)
    m.spring("s", m.ground.at(0.1, 0.2), b.at(0.15, 0.02), 100.0, damping=1.0)
    m.start_near(a=start, b=1, c=start)
    m.start_moving(a=speed)
    return m


def differences(m: mbsd.Mechanism, name: str, t: np.ndarray, h: float) -> np.ndarray:
    """(T, k) of fourth order, of whole motions."""
    number = number_named(m, name)

    def moved(k: int) -> np.ndarray:
        sol = with_values(m, [number], [number.value + k * h]).simulate(times=t, tolerance=1e-12)
        return np.stack([getattr(sol.body(label[0]), label[2:]) for label in OF], axis=1)

    return (8.0 * (moved(1) - moved(-1)) - (moved(2) - moved(-2))) / (12.0 * h)


@pytest.mark.parametrize("way", ["_in_independent_coordinates", "_between_looks", "_at_nodes"])
@pytest.mark.parametrize(("start", "speed"), [(6.0, -3.0), (3.0, 3.0)])
def test_near_a_flat_pose_they_are_those_of_differences(
    way: str, start: float, speed: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    if way != "_in_independent_coordinates":
        monkeypatch.setattr(simulations, "suits", lambda ready: None)
    if way == "_at_nodes":
        monkeypatch.setattr(simulations, "CLOSE", -1.0)
    m, t = flat(start, speed), np.linspace(0.0, 0.3, 7)
    own = m.sensitivities(OF, "D.x", times=t)
    known = differences(m, "D.x", t, 1e-7)
    assert np.abs(known).max() > 1000.0
    for k, label in enumerate(OF):
        assert np.allclose(own[label][:, 0], known[:, k], rtol=0.0, atol=2e-6 * np.abs(known[:, k]).max()), label


def hung(times: float) -> mbsd.Mechanism:
    """A bar at which another one hangs, so many times as heavy."""
    m = mbsd.Mechanism("hung")
    a, b = m.bar("a", 0.2, mass=1.0), m.bar("b", 0.3, mass=times)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.start_near(a=-20, b=40)
    return m


def test_masses_too_far_apart_are_refused_in_words() -> None:
    with pytest.raises(mbsd.ModelError, match=r"hung: derivatives of simulations where inertias of joined bodies"):
        hung(1e8).sensitivities("b.theta", "B.x", 0.2, 4)
    assert np.isfinite(hung(1e4).sensitivities("b.theta", "B.x", 0.2, 4)["b.theta"]).all()


def whip(
    wheel: float = 5e5, speed: float = 0.4, rod: float = 0.45, wind: Law | None = None, cam: mbsd.Motion | None = None
) -> mbsd.Mechanism:
    """A flywheel of ``wheel`` kg that light links stop at their toggle, within sqrt(1 / wheel) rad or so.

    ``wind`` turns the crank; ``cam`` drives a cam on which it stands a little off the middle.
    """
    m = mbsd.Mechanism("whip", gravity=(0.0, -9.81))
    crank, link = m.body("crank", 1.4, (0.13, 0.02), 0.014), m.body("rod", rod, (0.32, -0.07), 0.06)
    flywheel = m.body("flywheel", wheel, (0.2, 0.0), 0.07 * wheel)
    frame = m.ground.at(0.432, -0.229)
    if cam:
        turned = m.body("cam", 10.0, (0.0, 0.0), 1.0)
        m.revolute("E", m.ground.at(0.432, -0.229), turned.origin)
        m.drive_angle("motor", turned, cam)
        m.start_near(cam=(0.432, -0.229, 0.0))
        frame = turned.at(0.01, 0.0)
    m.revolute("O", frame, crank.origin)
    m.revolute("A", crank.at(0.2926, 0.0), link.origin)
    m.revolute("B", link.at(0.7406, 0.0), flywheel.origin)
    m.revolute("C", m.ground.at(0.5724, 0.4684), flywheel.at(0.5834, 0.0))
    if wind:
        m.torque("wind", crank, wind)
    m.start_near(crank=(0.432, -0.229, 124.47), rod=(0.266, 0.0119, 4.97), flywheel=(1.004, 0.076, 137.7))
    m.start_moving(flywheel=speed)
    return m


TIMES = [0.0, 0.3, 0.6]


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
@pytest.mark.parametrize("speed", [0.4, 0.8])
def test_light_links_that_whip_through_a_toggle_leave_a_flywheel_alone(speed: float) -> None:
    step = 1e-4
    m = whip(speed=speed)
    slopes = m.sensitivities(["flywheel.theta"], ["rod.mass"], times=TIMES, simulate=True, tolerance=1e-9)
    moved = [whip(speed=speed, rod=0.45 + h) for h in (step, -step)]
    ends = [own.simulate(times=TIMES, tolerance=1e-12).body("flywheel").theta[-1] for own in moved]
    assert slopes["flywheel.theta"][-1, 0] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=0.02)


def by_place(m: mbsd.Mechanism, tolerance: float) -> float:
    """d flywheel.omega / d A.x at the end."""
    of = "flywheel.omega"
    return m.sensitivities(of, "A.x", times=TIMES, simulate=True, tolerance=tolerance)[of][-1, 0]


def by_differences(m: mbsd.Mechanism, step: float) -> float:
    number = number_named(m, "A.x")
    moved = [with_values(m, [number], [number.value + k * step]) for k in (-2, -1, 1, 2)]
    omega = [own.simulate(times=TIMES, tolerance=1e-12).body("flywheel").omega[-1] for own in moved]
    return float(8.0 * (omega[2] - omega[1]) - (omega[3] - omega[0])) / (12.0 * step)


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
@pytest.mark.parametrize("wheel", [1e2, 1e4, 5e5, 1e7])
def test_through_a_toggle_of_any_width_they_converge_with_the_tolerance(wheel: float) -> None:
    """In it they are a million times as large as behind it, where few of their digits would be left."""
    known = by_differences(whip(wheel), 1e-4)
    for tolerance in (1e-9, 1e-11):
        assert by_place(whip(wheel), tolerance) == pytest.approx(known, rel=5e-6)


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
@pytest.mark.parametrize("wheel", [1e9, 1e10, 1e12])
def test_where_a_toggle_leaves_no_digits_that_is_said(wheel: float) -> None:
    with pytest.warns(mbsd.ModelWarning, match=r"whip: derivatives along this simulation .* differences of whole sim"):
        by_place(whip(wheel), 1e-9)


def test_a_force_that_time_changes_is_no_motion_of_its_own() -> None:
    m = whip(1e3, wind=mbsd.harmonic(20.0, 7.0))
    assert by_place(m, 1e-10) == pytest.approx(by_differences(m, 1e-4), rel=1e-6)
    assert by_place(m, 1e-10) != pytest.approx(by_place(whip(1e3), 1e-10), rel=1e-3)


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
@pytest.mark.parametrize("wind", [mbsd.harmonic(20.0, 7.0), lambda t: 20.0 * np.sin(7.0 * t)])
@pytest.mark.parametrize("wheel", [5e5, 1e7])
def test_through_a_toggle_under_a_torque_of_time_they_keep_six_digits(wheel: float, wind: Law) -> None:
    known = by_differences(whip(wheel, wind=wind), 1e-4)
    for tolerance in (1e-9, 1e-11):
        assert by_place(whip(wheel, wind=wind), tolerance) == pytest.approx(known, rel=3e-6)


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
@pytest.mark.parametrize("cam", [mbsd.constant_rate(3.0), mbsd.harmonic(0.5, 11.0)])
def test_through_a_toggle_that_a_driver_moves_they_keep_seven_digits(cam: mbsd.Motion) -> None:
    known = by_differences(whip(2e5, cam=cam), 1e-4)
    for tolerance in (1e-10, 1e-11):
        assert by_place(whip(2e5, cam=cam), tolerance) == pytest.approx(known, rel=2e-7)


@pytest.mark.filterwarnings("ignore:.*Masses are in kilograms")
def test_under_a_torque_of_time_a_toggle_that_leaves_no_digits_is_told() -> None:
    with pytest.warns(mbsd.ModelWarning, match=r"whip: derivatives along this simulation .* differences of whole sim"):
        by_place(whip(1e10, wind=mbsd.harmonic(20.0, 7.0)), 1e-9)


def blown(driven: bool) -> mbsd.Mechanism:
    """A four-bar with a pendulum on its coupler, driven or turned by torques of time."""
    m = mbsd.Mechanism("blown", gravity=(0.0, -9.81))
    a, b, c = m.bar("a", 0.1, mass=1.0), m.bar("b", 0.3, mass=1.0), m.bar("c", 0.2, mass=1.0)
    hung = m.bar("hung", 0.2, mass=0.5)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(0.25, 0.1), c.start)
    m.revolute("P", b.at(0.15, 0.05), hung.start)
    if driven:
        m.drive_angle("motor", a, mbsd.harmonic(0.7, 11.0))
    else:
        m.torque("wind", a, mbsd.harmonic(2.0, 17.0))
    m.torque("gusts", c, lambda t: 0.3 * np.sin(9.0 * t))
    m.start_near(a=60, b=10, c=80, hung=-50)
    return m


@pytest.mark.filterwarnings("error:.*derivatives along this simulation")
@pytest.mark.parametrize("way", ["_in_independent_coordinates", "_between_looks", "_at_nodes"])
@pytest.mark.parametrize("driven", [False, True])
def test_how_time_changes_a_motion_is_found_in_all_ways(
    way: str, driven: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Slopes by time are found, else they would be noise and raise a warning."""
    if way != "_in_independent_coordinates":
        monkeypatch.setattr(simulations, "suits", lambda ready: None)
    if way == "_at_nodes":
        monkeypatch.setattr(simulations, "CLOSE", -1.0)

    def slopes() -> np.ndarray:
        of = "hung.omega"
        return blown(driven).sensitivities(of, ["B.x", "hung.mass"], 0.5, 5, simulate=True, tolerance=1e-10)[of]

    known = slopes()
    monkeypatch.setattr(explicit_time, "SUDDEN", 0.0)
    monkeypatch.setattr(explicit_time, "ABOVE", 0.0)
    own = slopes()
    assert np.allclose(own, known, rtol=0.0, atol=1e-7 * np.abs(known).max())
