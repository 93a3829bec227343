"""Bodies that nothing connects are not measured by each other's loads: equilibrium, stability and modes."""

from __future__ import annotations

import math

import pytest

from mbsd import Mechanism, MobilityError, ModelError, constant_rate

G = 9.80665
pytestmark = pytest.mark.filterwarnings("ignore::mbsd.ModelWarning")


def two_bodies(mass: float, stiffness: float = 0.0, start: float = -60.0) -> Mechanism:
    """A point mass of 0.1 kg on a pin, and an eccentric wheel of ``mass`` (kg), with a torsion spring (N m/rad)."""
    m = Mechanism("two")
    m.revolute("O", m.ground.origin, m.body("bob", 0.1, com=(0.1, 0.0)).origin)
    m.revolute("W", m.ground.at(1.0, 0.0), m.body("wheel", mass, com=(0.2, 0.0), inertia=0.1 * mass).origin)
    if stiffness:
        m.torsion_spring("spring", "ground", "wheel", stiffness)
    m.start_near(bob=start, wheel=-70.0)
    return m


@pytest.mark.parametrize("nearest", [False, True])
@pytest.mark.parametrize("stiffness", [0.0, 1e9])
@pytest.mark.parametrize("mass", [1e-6, 1.0, 1e6])
def test_a_pendulum_hangs_straight_down(mass: float, stiffness: float, nearest: bool) -> None:
    rest = two_bodies(mass, stiffness).equilibrium(nearest=nearest)
    assert rest.body("bob").theta == pytest.approx(-math.pi / 2, abs=1e-12)
    assert rest.joint("O").reaction[1] == pytest.approx(0.1 * G, rel=1e-8)
    assert rest.stability == "stable"


@pytest.mark.parametrize("mass", [1e-6, 1.0, 1e6])
def test_one_that_stands_on_its_head_is_unstable(mass: float) -> None:
    m = two_bodies(mass, 1e9, start=88.0)
    assert m.equilibrium(nearest=True).stability == "unstable"


@pytest.mark.parametrize(("mass", "stiffness"), [(1e-6, 1e9), (1.0, 1e9), (1e6, 1e-3)])
def test_each_has_its_own_rate(mass: float, stiffness: float) -> None:
    m = two_bodies(mass, stiffness)
    rest = m.equilibrium()
    inertia = mass * (0.1 + 0.2**2)
    pull = stiffness + mass * G * 0.2 * math.sin(-rest.body("wheel").theta)
    rates = sorted([math.sqrt(G / 0.1), math.sqrt(pull / inertia)])
    assert [mode.omega for mode in m.modes()] == pytest.approx(rates, rel=1e-6)


def test_bodies_without_a_restoring_force_are_free_beside_it() -> None:
    m = two_bodies(1.0)
    m.change("wheel", com=(0.0, 0.0))
    free, swinging = m.modes()
    assert free.omega == 0.0
    assert list(free.of("bob")) == [0.0, 0.0, 0.0]
    assert swinging.omega == pytest.approx(math.sqrt(G / 0.1), rel=1e-9)


def test_a_load_that_no_actuator_takes_is_told_beside_a_heavy_body() -> None:
    """The motor of the wheel cannot turn the pendulum, whose load is 1e-8 of the wheel's."""
    m = two_bodies(1e7)
    for name in ("bob", "wheel"):
        m.drive_angle(f"motor of {name}", name, constant_rate(1.0))
    motion = m.sweep(0.5, steps=5)
    m.inverse_dynamics(motion, ["motor of bob", "motor of wheel"])
    with pytest.raises((ModelError, MobilityError), match="cannot make this motion"):
        m.inverse_dynamics(motion, ["motor of wheel"])
