"""Contacts and limits where nothing pushes back: a motion or pose that would need their forces is refused by name."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import EquilibriumError, LimitError, Mechanism, ModelError, SimulationError, constant_rate
from mbsd.model.laws import polynomial


def ram(way: float) -> Mechanism:
    """A disc of radius 0.1 m, driven down from 1 m to 1 - ``way`` within 1 s above a floor."""
    m = Mechanism("press", gravity=None)
    axis, body = m.ground.at(0, 0, math.pi / 2), m.body("ram", 1.0, inertia=0.1)
    m.prismatic("guide", axis, body.at(0, 0, math.pi / 2))
    m.drive_coordinate("drive", axis, body.origin, polynomial(1.0, -way))
    m.rigid_contact("floor", m.ground.origin, body.origin, radius=0.1)
    m.start_near(ram=(0, 1, 0))
    return m


def ball(height: float) -> Mechanism:
    m = Mechanism("ball", gravity=(0.0, -10.0))
    body = m.body("ball", 1.0, inertia=0.1)
    m.rigid_contact("floor", m.ground.origin, body.origin, radius=0.1)
    m.bushing("hold", m.ground.at(0, 0.6), body.origin, (100.0, 100.0, 1.0))
    m.force("lift", body.origin, 0.0, direction=(0, 1))
    m.force("side", body.origin, 0.0, direction=(1, 0))
    m.torque("spin", body, 0.0)
    m.start_near(ball=(0, height, 0))
    return m


def arm(*limits: float | None, start: float = 0.0) -> Mechanism:
    m = Mechanism("arm")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("pin", m.ground.origin, rod.start, limits=limits)
    m.start_near(rod=start)
    return m


def test_a_driven_motion_through_a_contact_is_refused() -> None:
    assert ram(0.9).sweep(1.0, steps=10).body("ram").y[-1] == pytest.approx(0.1), "it may touch"
    says = r"press: at t = 0.9 s the motion is beyond contact 'floor', at the furthest by 0.1 m. Drive less far"
    with pytest.raises(LimitError, match=says):
        ram(1.0).sweep(1.0, steps=20)
    with pytest.raises(SimulationError, match=r"press: at t = 0.9 s .* 'floor' against its stop, and nothing can give"):
        ram(1.0).simulate(1.0, steps=2)


@pytest.mark.parametrize("steps", [2, 50])
def test_a_driver_through_a_limit_is_refused_in_a_simulation_too(steps: int) -> None:
    m = arm(None, 0.4)
    m.drive_angle("motor", m.bodies["rod"], constant_rate(2.0))
    with pytest.raises(SimulationError, match=r"arm: at t = 0.2 s joints and drivers move 'pin upper' against"):
        m.simulate(1.0, steps=steps)
    with pytest.raises(LimitError, match=r"arm: at t = 0.2 s joint 'pin' passes its upper limit of 22.9183 degrees"):
        m.sweep(1.0, steps=50)


def test_an_equilibrium_beyond_a_contact_or_limit_is_refused() -> None:
    assert ball(0.4).equilibrium().body("ball").y == pytest.approx(0.5)
    m = ball(0.4)
    m.change("hold", stiffness=(100.0, 15.0, 1.0))
    with pytest.raises(
        EquilibriumError, match=r"ball: the pose that balances is 0.167 m beyond 'floor'. Rest on a cont"
    ):
        m.equilibrium()
    assert arm(-2.0, 0.4).equilibrium().body("rod").theta == pytest.approx(-math.pi / 2)
    with pytest.raises(EquilibriumError, match=r"arm: the pose that balances is 1.17 rad beyond 'pin lower'"):
        arm(-0.4, 0.4).equilibrium()
    with pytest.raises(EquilibriumError, match="beyond 'pin lower'"):
        arm(2 * math.pi - 0.4, 2 * math.pi + 0.4).equilibrium()


def test_a_closed_contact_has_no_linear_motion() -> None:
    frequency = ball(0.4).modes()[-1].frequency
    assert frequency == pytest.approx(10.0 / (2 * math.pi))
    with pytest.raises(
        ModelError, match=r"ball: 'floor' is closed in this state, and a contact pushes to one side only"
    ):
        ball(0.1).linearise("start")
    m = Mechanism("clutch")
    wheel = m.body("wheel", 1.0, inertia=0.1)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.one_way("clutch", m.ground, wheel)
    with pytest.raises(ModelError, match=r"clutch: 'clutch' is closed in this state"):
        m.linearise("start")


def test_efforts_are_not_found_for_what_a_contact_does() -> None:
    m = ball(0.1)
    m.change("hold", stiffness=(100.0, 15.0, 1.0))
    sol = m.simulate(0.1, steps=4)
    np.testing.assert_allclose(sol.contact("floor").normal, 2.5, rtol=1e-9)
    with pytest.raises(ModelError, match=r"ball: contact 'floor' pushes at t = 0 s of this motion"):
        m.inverse_dynamics(sol, ["lift", "side", "spin"])
    free = ball(0.4).simulate(0.1, steps=4)
    assert not free.contact("floor").closed.any()
    made = free.mechanism.inverse_dynamics(free, ["lift", "side", "spin"])
    np.testing.assert_allclose(made.efforts["lift"], 0.0, atol=1e-9)
