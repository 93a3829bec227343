"""Joints that stick may jam: links nearly in one line do, joints that carry nothing do not."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, SimulationError

G = 9.80665


@pytest.mark.parametrize("sticks", [True, False])
def test_joints_that_carry_nothing_are_no_jam(sticks: bool) -> None:
    """A cart in free flight: its axles carry no more than rounding."""
    m = Mechanism("flight")
    cart = m.body("cart", 2.0, inertia=0.05)
    for k, x in enumerate((-0.3, 0.3)):
        wheel = m.body(f"wheel {k}", 0.3, inertia=0.0015)
        m.revolute(f"axle {k}", cart.at(x, -0.1), wheel.origin)
        m.friction(f"rub {k}", f"axle {k}", 0.3, radius=0.02, sticks=sticks)
    m.start_near(cart=(0, 1, 0))
    m.start_moving(cart=(1.0, 2.0, 0.0), **{"wheel 0": 30.0, "wheel 1": -10.0})
    sol = m.simulate(1.0, steps=20, tolerance=1e-9)
    np.testing.assert_allclose(sol.body("wheel 0").omega, 30.0, rtol=1e-12)
    np.testing.assert_allclose(sol.body("cart").y, 1 + 2 * sol.t - G * sol.t**2 / 2, atol=1e-9)


def four_bar_that_sticks(lengths: tuple[float, float, float], speed: float, mu: float, angle: float) -> Mechanism:
    """Bars of so many metres and kilograms, 1.2 m of ground."""
    m = Mechanism("four-bar")
    crank, coupler, rocker = (m.bar(n, x, x) for n, x in zip(("crank", "coupler", "rocker"), lengths, strict=True))
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(1.2, 0), rocker.start)
    for pin in "ABCD":
        m.friction(f"rub {pin}", pin, mu, static=1.3 * mu, radius=0.05, sticks=True)
    m.start_near(crank=angle, coupler=10.0, rocker=angle)
    m.start_moving(crank=speed)
    return m


def from_change_point(lengths: tuple[float, float, float]) -> float:
    """How far the lengths are from letting all bars lie in one line (m)."""
    a, b, c = lengths
    return min(abs(a + b - c - 1.2), abs(a - b + c - 1.2), abs(a - b - c + 1.2))


@settings(max_examples=15, deadline=None)
@given(
    lengths=st.tuples(st.floats(0.8, 1.5), st.floats(0.8, 1.5), st.floats(0.8, 1.5)),
    speed=st.floats(0.5, 5.0),
    mu=st.floats(0.05, 0.6),
    angle=st.floats(50.0, 80.0),
)
def test_a_four_bar_loses_energy_only_and_no_friction_passes_its_limit(lengths, speed, mu, angle) -> None:
    assume(from_change_point(lengths) > 0.02)
    m = four_bar_that_sticks(lengths, speed, mu, angle)
    sol = m.simulate(1.0, steps=100, tolerance=1e-8)
    total = sol.energy.total
    assert (np.diff(total) <= 1e-6 * max(1.0, np.abs(total).max())).all()
    for pin in "ABCD":
        view = sol.friction(f"rub {pin}")
        slip = 0.05 * np.abs(view.rate)
        limit = (mu + 0.3 * mu * np.exp(-((slip / 0.01) ** 2))) * 0.05 * view.normal
        assert (np.abs(view.force) <= limit * (1 + 1e-6) + 1e-9).all()
        assert (view.power <= 1e-9).all()


def test_links_nearly_in_one_line_jam_and_the_joint_is_named() -> None:
    """0.4 mm from a change point the lever arms are below the friction circles: no acceleration is finite there.

    Friction that slides with slip_speed 1e-3 m/s slows down without bound at the same place.
    """
    lengths = (0.9995897538149691, 0.8, 1.4)
    with pytest.raises(SimulationError, match=r"four-bar: at t = 0\.7588.* s .*joints jam, 'A' .*one line"):
        four_bar_that_sticks(lengths, 2.0, 0.5, 69.0).simulate(1.0, steps=100, tolerance=1e-8)
    four_bar_that_sticks(lengths, 2.0, 0.01, 69.0).simulate(1.0, steps=100, tolerance=1e-8)


def rod(friction: float, degrees: float, speed: float, yields: bool = False) -> Mechanism:
    """A uniform rod of 2 m and 1 kg whose lower end slides on a table."""
    m = Mechanism("painleve")
    bar = m.bar("rod", 2.0, 1.0)
    m.set_mass("rod", 1.0, (1.0, 0.0), 1.0 / 3.0)
    if yields:
        m.contact("table", m.ground.origin, bar.start, 1e6, damping=0.5, friction=friction)
    else:
        m.rigid_contact("table", m.ground.origin, bar.start, friction=friction)
    m.start_near(rod=(0.0, 0.0, degrees))
    m.start_moving(rod=(speed, 0.0, 0.0))
    return m


def critical(degrees: float) -> float:
    """(1 + 3 cos^2) / (3 sin cos), Genot, Brogliato 1999, Eur. J. Mech. A 18, 653."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (1 + 3 * c * c) / abs(3 * s * c)


@pytest.mark.parametrize(("friction", "degrees", "speed"), [(2.0, 60.0, -3.0), (1.6, 60.0, -5.0), (2.0, 120.0, 3.0)])
def test_it_is_refused_with_its_friction_and_a_remedy_that_helps(friction, degrees, speed) -> None:
    with pytest.raises(SimulationError, match="Painleve's paradox") as error:
        rod(friction, degrees, speed).simulate(1.0, 20)
    said = str(error.value)
    assert "at t = 0 s contact 'table' jams" in said
    numbers = re.search(r"friction ([\d.]+) is above ([\d.]+)", said)
    assert numbers
    assert float(numbers[1]) == friction
    assert float(numbers[2]) == pytest.approx(critical(degrees), rel=1e-3)
    assert "m.contact(...)" in said
    sol = rod(friction, degrees, speed, yields=True).simulate(0.02, 20)
    assert sol.body("rod").theta[-1] != sol.body("rod").theta[0]


@pytest.mark.parametrize(("friction", "degrees", "speed"), [(1.2, 60.0, -3.0), (2.0, 60.0, 3.0), (1.0, 120.0, 3.0)])
def test_below_it_and_the_other_way_it_moves(friction, degrees, speed) -> None:
    assert rod(friction, degrees, speed).simulate(0.05, 10).t[-1] == 0.05
