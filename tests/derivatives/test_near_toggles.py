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


@pytest.mark.parametrize("speed", [0.4, 0.8])
def test_light_links_that_whip_through_a_toggle_leave_a_flywheel_alone(speed: float) -> None:
    def whip(rod: float = 0.45) -> mbsd.Mechanism:
        m = mbsd.Mechanism("whip", gravity=(0.0, -9.81))
        crank, link = m.body("crank", 1.4, (0.13, 0.02), 0.014), m.body("rod", rod, (0.32, -0.07), 0.06)
        wheel = m.body("flywheel", 5e5, (0.2, 0.0), 3.5e4)
        m.revolute("O", m.ground.at(0.432, -0.229), crank.origin)
        m.revolute("A", crank.at(0.2926, 0.0), link.origin)
        m.revolute("B", link.at(0.7406, 0.0), wheel.origin)
        m.revolute("C", m.ground.at(0.5724, 0.4684), wheel.at(0.5834, 0.0))
        m.start_near(crank=(0.432, -0.229, 124.47), rod=(0.266, 0.0119, 4.97), flywheel=(1.004, 0.076, 137.7))
        m.start_moving(flywheel=speed)
        return m

    times, step = [0.0, 0.3, 0.6], 1e-4
    slopes = whip().sensitivities(["flywheel.theta"], ["rod.mass"], times=times, simulate=True, tolerance=1e-9)
    ends = [whip(0.45 + h).simulate(times=times, tolerance=1e-12).body("flywheel").theta[-1] for h in (step, -step)]
    assert slopes["flywheel.theta"][-1, 0] == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=0.02)
