"""Joints that stick beside contacts with friction: they break away where statics says so."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import fsolve

from mbsd import Mechanism, polynomial
from tools.models.rough import carried_five_bar, dragged_arm

G = 9.81
RATE = 2.0
PIN, STATIC, FLOOR, RADIUS, PRELOAD = 0.2, 0.25, 0.3, 0.02, 20.0


def pushed_block() -> Mechanism:
    """A crank with dry bearings under a torque RATE t, whose rod pushes a block on two rough feet."""
    m = Mechanism("pushed block", gravity=(0, -G))
    crank, rod, block = m.bar("crank", 0.1, mass=0.3), m.bar("rod", 0.4, mass=0.2), m.body("block", 2.0, inertia=0.02)
    m.revolute("O", m.ground.at(0, 0.1), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.at(0, 0.02))
    for pin in "OAB":
        m.friction(f"rub {pin}", pin, PIN, static=STATIC, radius=RADIUS, preload=PRELOAD, sticks=True)
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), block.at(x, -0.05), friction=FLOOR)
    m.torque("motor", crank, polynomial(0.0, RATE))
    m.start_near(crank=60, rod=-10, block=(0.44, 0.05, 0))
    return m


def greatest_torque(crank: float, rod: float, senses: tuple[float, float, float]) -> float:
    """The torque on the crank at which all pins and feet are at their limits, by statics alone.

    crank, rod: angles (rad); ``senses``: directions in which O, A, B are about to turn. The block goes forwards or
    backwards with the crank.
    """
    r, length = 0.1, 0.4
    a = np.array([r * math.cos(crank), r * math.sin(crank)])
    b = length * np.array([math.cos(rod), math.sin(rod)])
    forwards = -math.copysign(1.0, senses[0] * math.sin(crank - rod))

    def cross(p: np.ndarray, f: np.ndarray) -> float:
        return float(p[0] * f[1] - p[1] * f[0])

    def equations(unknown: np.ndarray) -> list[float]:
        at_o, at_a, at_b = unknown[0:2], unknown[2:4], unknown[4:6]  # on crank, rod and block
        rear, front, torque = unknown[6:]
        forces = [np.linalg.norm(f) for f in (at_o, at_a, at_b)]
        limit = [STATIC * RADIUS * (float(f) + PRELOAD) * sense for f, sense in zip(forces, senses, strict=True)]
        down = np.array([0.0, -G])
        on_crank = at_o - at_a + 0.3 * down
        on_rod = at_a - at_b + 0.2 * down
        on_block = at_b + 2.0 * down + np.array([-FLOOR * forwards * (rear + front), rear + front])
        return [
            *on_crank,
            cross(a, -at_a) + cross(0.5 * a, 0.3 * down) + torque - limit[0] + limit[1],
            *on_rod,
            cross(b, -at_b) + cross(0.5 * b, 0.2 * down) - limit[1] + limit[2],
            *on_block,
            cross(np.array([0.0, 0.02]), at_b) - limit[2]
            + 0.1 * (front - rear) - 0.05 * FLOOR * forwards * (rear + front),
        ]  # fmt: skip

    start = np.array([0.0, 5.0, 0.0, 3.0, 0.0, 1.0, 10.0, 10.0, 0.5])
    out, _, solved, _ = fsolve(equations, start, full_output=True, xtol=1e-13)
    assert solved == 1
    return float(out[-1])


def test_a_crank_breaks_away_at_the_torque_of_statics() -> None:
    """Three pins and two feet hold one freedom together: none gives way before all are at their limits."""
    sol = pushed_block().simulate(0.6, steps=60)
    breaks = [event.time for event in sol.events if event.name.startswith("rub") and event.what == "slides"][-1]
    stops = [event.time for event in sol.events if event.name == "rub O" and event.what == "sticks"][-1]
    k = int(np.searchsorted(sol.t, breaks)) - 1
    assert stops < sol.t[k]
    crank, rod = (float(sol.body(name).theta[k]) for name in ("crank", "rod"))
    late = [float(sol.body(name).omega[-1]) for name in ("crank", "rod")]
    senses = tuple(math.copysign(1.0, rate) for rate in (late[0], late[1] - late[0], -late[1]))
    assert RATE * breaks == pytest.approx(greatest_torque(crank, rod, senses), rel=1e-7)


def test_a_weak_joint_behind_a_strong_one_breaks_away() -> None:
    """Its limit is small beside the accelerations that the strong joint prevents."""
    m = Mechanism("arm")
    upper, fore = m.bar("upper", 0.5, 1.0), m.bar("fore", 0.4, 0.7)
    m.revolute("shoulder", m.ground.origin, upper.start)
    m.revolute("elbow", upper.end, fore.start)
    m.friction("strong", "shoulder", 0.3, radius=0.05, preload=2e5, sticks=True)
    m.friction("weak", "elbow", 0.3, radius=0.05, preload=1.0, sticks=True)
    m.torque("pull", fore, polynomial(0.0, 1.0))
    m.start_near(upper=0, fore=-90)
    sol = m.simulate(0.5, steps=10)
    breaks = [event.time for event in sol.events if event.name == "weak" and event.what == "slides"]
    assert breaks[0] == pytest.approx(0.3 * 0.05 * (0.7 * 9.80665 + 1.0), rel=1e-9)


@pytest.mark.parametrize("build", [dragged_arm, carried_five_bar])
def test_what_joints_share_agrees_with_the_motion_where_contacts_slide(build) -> None:
    """Contacts push as the motion of the whole machine asks, whatever its joints at rest carry."""
    m = build(True)
    sol = m.simulate(0.5, steps=20)
    pins = [f"rub {pin}" for pin in "ABCDEPQ" if pin in m.joints]
    assert {e.name for e in sol.events if e.what == "sticks"} == set(pins)
    bodies = [name for name in m.bodies if name != "ground"]
    momentum = sum(m.bodies[name].mass * sol.body(name).ax for name in bodies)
    normal, friction = (sum(getattr(sol.contact(name), part) for name in m.contacts) for part in ("normal", "friction"))
    np.testing.assert_allclose(friction, momentum, atol=1e-9)
    np.testing.assert_allclose(friction, -FLOOR * normal, atol=1e-9)


def test_joints_with_several_freedoms_share_on_a_sledge_that_slides() -> None:
    """Four joints of a five-bar turn in the motion that would give way first, with the same part of their limits."""
    sol = carried_five_bar(True).simulate(0.5, steps=20)
    joints = [sol.friction(f"rub {pin}") for pin in "ABCDE"]
    parts = np.sort([np.abs(each.force) / (0.24 * 0.02 * (each.normal + 1000.0)) for each in joints], axis=0)[:, 1:]
    np.testing.assert_allclose(parts[1:], np.broadcast_to(parts[-1], (4, 20)), rtol=1e-9)
    assert (parts[0] < 0.9 * parts[-1]).all()
