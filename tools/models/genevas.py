"""A Geneva drive for the solver's tests."""

from __future__ import annotations

import math

from mbsd import Mechanism, constant_rate


def geneva(slots: int, distance: float = 0.1, start: float = 0.0) -> Mechanism:
    """With the given slots and distance of centres (m), its crank turning at 1 rad/s from ``start`` (rad)."""
    m = Mechanism("geneva", gravity=None)
    crank, wheel = m.body("crank"), m.body("wheel", 1.0, (0, 0), 2e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(distance, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots, distance * math.sin(math.pi / slots))
    m.drive_angle("motor", crank, constant_rate(1.0, start))
    m.start_near(wheel=5)
    return m


def two_genevas() -> Mechanism:
    """Two wheels of one crank, which starts where a pin leaves."""
    m = Mechanism("two", gravity=None)
    crank = m.body("crank", 0.5, (0.0, 0.0), 1e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    for name, slots, x in (("wheel", 4, 0.1), ("other", 5, -0.12)):
        wheel = m.body(name, 1.0, (0.0, 0.0), 1e-3)
        m.revolute(f"W{name}", m.ground.at(x, 0), wheel.origin)
        turned = 0.0 if x > 0 else math.pi / 3
        m.geneva(f"index {name}", crank.at(0, 0, turned), wheel.origin, slots, abs(x) * math.sin(math.pi / slots))
    m.start_near(crank=-45.0)
    m.start_moving(crank=6.0)
    return m


def free(slots: int, gravity: tuple[float, float] | None = (0.0, -9.81), speed: float = 10.0) -> Mechanism:
    """A crank with a flywheel's inertia that turns a wheel and its own unbalance."""
    m = Mechanism("geneva", gravity=gravity)
    crank, wheel = m.body("crank", 0.5, (0.01, 0.0), 1e-3), m.body("wheel", 1.0, (0.0, 0.0), 2e-3)
    m.revolute("O", m.ground.origin, crank.origin)
    m.revolute("W", m.ground.at(0.1, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots, 0.1 * math.sin(math.pi / slots))
    m.torsion_spring("spring", m.ground, crank, 0.0, 0.0)
    m.start_near(wheel=5)
    m.start_moving(crank=speed)
    return m


def swinging() -> Mechanism:
    """It swings back at its slot, again and again."""
    m = free(4, speed=1.0)
    m.change("spring", stiffness=0.02)
    return m


def two() -> Mechanism:
    """Two wheels of one crank, whose spring and damper vary."""
    m = two_genevas()
    m.torsion_spring("spring", m.ground, m.bodies["crank"], 0.0, 1e-4)
    return m
