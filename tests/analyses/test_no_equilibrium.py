"""Mechanisms without an equilibrium are refused with the reason why they have none."""

from __future__ import annotations

import pytest

from mbsd import EquilibriumError, Mechanism


def test_a_cart_on_a_slope_runs_away() -> None:
    m = Mechanism("slope")
    cart, bob = m.body("cart", 2.0, inertia=0.1), m.bar("bob", 0.5, 1.0)
    m.prismatic("rail", m.ground.at(0, 0, 0.3), cart.at(0, 0, 0.3))
    m.revolute("pin", cart.origin, bob.start)
    m.start_near(bob=-80.0)
    with pytest.raises(
        EquilibriumError, match=r"It runs away: the loads have drawn '\w+' \S+ m from its start, and on"
    ):
        m.equilibrium()


def test_a_wheel_under_a_torque_goes_round_and_round() -> None:
    m = Mechanism("motor", gravity=None)
    wheel = m.body("wheel", 1.0, inertia=0.1)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.torque("drive", wheel, 2.0)
    with pytest.raises(EquilibriumError, match=r"drive 'wheel' round and round, \S+ turns so far"):
        m.equilibrium()


def test_two_masses_fall_into_each_other() -> None:
    m = Mechanism("stars", gravity=None)
    first, second = m.body("one", 1.0, inertia=0.1), m.body("two", 1.0, inertia=0.1)
    for name, body in (("a", first), ("b", second)):
        m.prismatic(f"rail {name}", m.ground.origin, body.origin)
    m.gravitation("pull", first.origin, second.origin, -5.0)
    m.start_near(one=(0.0, 0.0, 0.0), two=(1.0, 0.0, 0.0))
    with pytest.raises(EquilibriumError, match="no equilibrium was found"):
        m.equilibrium()


def test_a_ball_above_a_rigid_floor_would_rest_on_it() -> None:
    m = Mechanism("ball")
    ball = m.body("ball", 2.0, inertia=0.1)
    m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.1)
    m.start_near(ball=(0.0, 0.5, 0.0))
    with pytest.raises(EquilibriumError, match=r"It went \S+ m beyond 'floor'. Rest on a contact or at a limit is not"):
        m.equilibrium()
