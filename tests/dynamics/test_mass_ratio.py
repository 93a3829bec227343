"""Heavy bodies that hang at light ones: as few steps, and reactions as exact, as with usual masses."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate

pytestmark = pytest.mark.filterwarnings("ignore::mbsd.base.errors.ModelWarning")


def _double_pendulum(lower: float, upper: float = 1.0) -> Mechanism:
    m = Mechanism("pendulum")
    first, second = m.bar("first", 1.0, mass=upper), m.bar("second", 1.0, mass=lower)
    m.revolute("hook", m.ground.origin, first.start)
    m.revolute("elbow", first.end, second.start)
    m.start_near(first=-60, second=-30)
    return m


def _four_bar(coupler: float, base: float | None = None) -> Mechanism:
    m = Mechanism("linkage")
    frame = m.ground
    if base is not None:
        frame = m.body("base", mass=base, inertia=base)
        m.weld("weld", m.ground.origin, frame.origin)
    a, b, c = m.bar("a", 0.3, mass=1.0), m.bar("b", 1.0, mass=coupler), m.bar("c", 0.8, mass=1.0)
    m.revolute("A", frame.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", frame.at(1.0, 0), c.start)
    m.start_near(a=60, b=20, c=100)
    return m


@pytest.mark.parametrize("formulation", ["reference", "independent"])
@pytest.mark.parametrize("ratio", [1e9, 1e12])
def test_motion_and_reactions_are_those_of_a_massless_upper_link(ratio: float, formulation: str) -> None:
    """Divided by the ratio they differ by parts of its inverse, below what integration leaves."""
    sol = _double_pendulum(ratio).simulate(3.0, steps=30, formulation=formulation)
    limit = _double_pendulum(1.0, upper=0.0).simulate(3.0, steps=30, tolerance=1e-10)
    assert sol.stats.steps < 200
    np.testing.assert_allclose(sol.body("second").theta, limit.body("second").theta, atol=1e-5)
    force, expected = np.hypot(sol.joint("hook").fx, sol.joint("hook").fy), np.hypot(*_hook(limit))
    np.testing.assert_allclose(force / ratio, expected, rtol=1e-4, atol=1e-4)
    assert sol.stats.acceleration_residual < 1e-10


def _hook(sol) -> tuple[np.ndarray, np.ndarray]:
    return sol.joint("hook").fx, sol.joint("hook").fy


def test_formulations_agree_on_a_closed_loop_with_a_heavy_coupler() -> None:
    reference = _four_bar(1e9).simulate(2.0, steps=20, formulation="reference", tolerance=1e-9)
    independent = _four_bar(1e9).simulate(2.0, steps=20, formulation="independent", tolerance=1e-9)
    np.testing.assert_allclose(
        reference.joint("A").fx, independent.joint("A").fx, atol=1e-5 * np.abs(independent.joint("A").fx).max()
    )
    assert reference.stats.steps < 2 * independent.stats.steps


def test_what_rounding_would_decide_is_refused_with_the_bodies() -> None:
    with pytest.raises(ModelError, match=r"pendulum: body 'first' is joined on to 'second', .* 1\.\de\+15 times apart"):
        _double_pendulum(1e15).simulate(1.0)
    _double_pendulum(1e-15).simulate(0.2)  # a light body that hangs at a heavy one costs no digits


def test_a_light_base_on_ground_costs_no_digits() -> None:
    """A frame that a weld holds on ground is ground: it need not weigh much beside a machine of 1e12 kg."""
    based = _four_bar(1e12, base=1e-3).simulate(1.0, steps=10, formulation="reference", tolerance=1e-9)
    plain = _four_bar(1e12).simulate(1.0, steps=10, formulation="reference", tolerance=1e-9)
    assert based.stats.steps < 2 * plain.stats.steps
    np.testing.assert_allclose(based.body("b").theta, plain.body("b").theta, atol=1e-6)
    force = based.joint("weld")
    np.testing.assert_allclose(force.fx, based.joint("A").fx + based.joint("D").fx, rtol=1e-6)


@pytest.mark.parametrize("inertia", [1e-3, 1e-6, 1e-9, 0.0])
@pytest.mark.parametrize("mass", [0.01, 0.0])
def test_a_slider_that_rests_at_its_dead_centre_keeps_its_own_mass(mass: float, inertia: float) -> None:
    """Everything rests but the crank and the rod's big end at the start; the slider is not held by ground for it."""
    m = Mechanism("press", gravity=(0.0, -9.81))
    crank, rod, slider = m.bar("crank", 0.04, mass=0.012), m.bar("rod", 0.12, mass=0.03), m.body("slider")
    m.change("slider", mass=mass, inertia=inertia)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_angle("motor", crank, constant_rate(2 * np.pi))
    m.start_near(crank=0, rod=0, slider=0)
    simulated, swept = m.simulate(duration=1.0, steps=90), m.sweep(duration=1.0, steps=90)
    for joint in "OAB":
        np.testing.assert_allclose(simulated.joint(joint).force, swept.joint(joint).force, atol=1e-9)
    assert simulated.stats.power_residual < 1e-12
