"""Derivatives past the touch of contacts that yield by much less than the size of the mechanism."""

from __future__ import annotations

import numpy as np
import pytest

import mbsd
from mbsd.numbers.names import number_named, with_values


def slider_crank(size: float) -> mbsd.Mechanism:
    """Its second pin has play."""
    m = mbsd.Mechanism("slider_crank", gravity=None)
    crank, rod = m.bar("crank", 0.05 * size, mass=0.3), m.bar("rod", 0.12 * size, mass=0.21)
    slider = m.body("slider", mass=0.14, inertia=1e-4)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.clearance_joint(
        "B", rod.end, slider.origin, 1e-3 * size, radius=0.01 * size, stiffness=1e8, damping=0.5, exponent=1.5
    )
    m.drive_angle("motor", crank, mbsd.constant_rate(30.0))
    m.start_near(crank=0, rod=0)
    return m


def gears() -> mbsd.Mechanism:
    """Teeth with backlash, which a load turns over."""
    m = mbsd.Mechanism("gears", gravity=None)
    a, b = m.body("a", mass=0.2, inertia=1e-4), m.body("b", mass=0.1, inertia=3e-5)
    m.revolute("A", m.ground.at(0, 0), a.origin)
    m.revolute("B", m.ground.at(0.09, 0), b.origin)
    m.gear_mesh("mesh", a.origin, b.origin, teeth=(40, 20), module=0.003, stiffness=1e6, backlash=1e-4, damping=0.5)
    m.torque("motor", a, 2.0)
    m.torque("load", b, 0.4)
    return m


@pytest.mark.parametrize(
    ("make", "name", "quantity", "duration"),
    [
        (lambda: slider_crank(1.0), "slider.mass", ("slider", "x"), 0.02),
        (lambda: slider_crank(100.0), "slider.mass", ("slider", "vx"), 0.02),
        (lambda: slider_crank(1.0), "rod.length", ("slider", "x"), 0.012),
        (gears, "a.inertia", ("b", "omega"), 0.01),
    ],
)
def test_derivatives_past_hard_contacts_are_those_of_differences(
    make: object, name: str, quantity: tuple[str, str], duration: float
) -> None:
    m = make()  # pyright: ignore[reportCallIssue]
    body, column = quantity
    made = m.sensitivities([f"{body}.{column}"], [name], duration, 20, tolerance=1e-11)
    number, ends = number_named(m, name), {}
    h = 1e-6 * number.value
    for offset in (-2, -1, 1, 2):
        other = with_values(m, [number], [number.value + offset * h]).simulate(duration, steps=20, tolerance=1e-12)
        ends[offset] = getattr(other.body(body), column)
    expected = (8 * (ends[1] - ends[-1]) - (ends[2] - ends[-2])) / (12 * h)
    assert np.abs(made.of(f"{body}.{column}", name) - expected).max() < 1e-4 * np.abs(expected).max()
