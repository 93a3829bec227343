"""Derivatives near poses where a little of a number is much of the motion, and of motions that grow."""

from __future__ import annotations

import numpy as np
import pytest

import mbsd
from mbsd.derivatives import simulations
from mbsd.numbers.names import number_named, with_values

OF = ["b.theta", "b.omega", "c.omega"]


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


def whip(wheel: float = 5e5, speed: float = 0.4, rod: float = 0.45, wind: float = 0.0) -> mbsd.Mechanism:
    """A flywheel of ``wheel`` kg that light links stop at their toggle, within sqrt(1 / wheel) rad or so."""
    m = mbsd.Mechanism("whip", gravity=(0.0, -9.81))
    crank, link = m.body("crank", 1.4, (0.13, 0.02), 0.014), m.body("rod", rod, (0.32, -0.07), 0.06)
    flywheel = m.body("flywheel", wheel, (0.2, 0.0), 0.07 * wheel)
    m.revolute("O", m.ground.at(0.432, -0.229), crank.origin)
    m.revolute("A", crank.at(0.2926, 0.0), link.origin)
    m.revolute("B", link.at(0.7406, 0.0), flywheel.origin)
    m.revolute("C", m.ground.at(0.5724, 0.4684), flywheel.at(0.5834, 0.0))
    if wind:
        m.torque("wind", crank, mbsd.harmonic(wind, 7.0))
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
    m = whip(1e3, wind=20.0)
    assert by_place(m, 1e-10) == pytest.approx(by_differences(m, 1e-4), rel=1e-6)
    assert by_place(m, 1e-10) != pytest.approx(by_place(whip(1e3), 1e-10), rel=1e-3)
