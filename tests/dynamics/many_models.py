"""Machines whose many simulations are compared with single ones."""

from __future__ import annotations

import math
from collections.abc import Callable

from mbsd import Mechanism, harmonic

STEPS = 20


def door(stiffness: float = 5.0, damping: float = 10.0) -> Mechanism:
    m = Mechanism("door", gravity=None)
    leaf = m.bar("door", 0.9, mass=30.0)
    m.revolute("hinge", m.ground.at(0, 0), leaf.start)
    m.torsion_spring("closer", m.ground, leaf, stiffness, damping, free_angle=-0.3)
    m.start_near(door=90)
    return m


def pendulum() -> Mechanism:
    m = Mechanism("double")
    a, b = m.bar("a", 1.0, mass=1.0), m.bar("b", 0.7, mass=0.5)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.torsion_spring("joint", a, b, 2.0, 0.1)
    m.trace("P", b.at(0.6, 0.1))
    m.start_near(a=-80, b=-60)
    return m


def press(
    pivot: tuple[float, float] = (0.0, 0.0),
    end: float = 0.05,
    point: float = 0.1,
    amplitude: float = 0.6,
    rate: float = 9.0,
    torque: float = 0.4,
    gravity: float = -9.80665,
    com: float = 0.075,
    start: float = 0.3,
) -> Mechanism:
    """A slider-crank whose crank swings by a law, with a pendulum on its rod that a torque turns."""
    m = Mechanism("press", gravity=(0.0, gravity))
    crank, rod, slider = (
        m.bar("crank", 0.05, mass=0.2),
        m.bar("rod", 0.15, 0.3, (com, 0.0), 1e-3),
        m.body("slider", 0.5),
    )
    hand = m.bar("hand", 0.08, mass=0.1)
    m.revolute("O", m.ground.at(*pivot), crank.start)
    m.revolute("A", crank.at(end, 0.0), rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.revolute("H", rod.at(0.1, 0.0), hand.start)
    m.torque("twist", hand, harmonic(torque, 5.0), rod)
    m.drive_angle("motor", crank, harmonic(amplitude, rate, 0.2))
    m.trace("P", rod.at(point, 0.02))
    m.start_near(crank=10, rod=0, hand=math.degrees(start))
    return m


def crowded(order: tuple[int, ...]) -> Mechanism:
    """Return a pendulum under forces of several terms, two of which share a law."""
    m = Mechanism("crowded")
    rod, tip = m.bar("rod", 0.4, mass=1.0), m.body("tip", 0.3, inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.revolute("B", rod.end, tip.origin)
    law = harmonic(0.3, 4.0)
    add: list[Callable[[], object]] = [
        lambda: m.torsion_spring("k", m.ground, rod, stiffness=1.0, damping=0.1, free_angle=0.2),
        lambda: m.spring("s", m.ground.at(0.3, 0.3), rod.end, 20.0, damping=0.5, free_length=0.2),
        lambda: m.torque("first", rod, law),
        lambda: m.torque("second", tip, law, rod),
        lambda: m.spring("t", m.ground.at(-0.3, 0.1), tip.at(0.02, 0.0), 5.0, free_length=0.3),
    ]
    for k in order:
        add[k]()
    m.start_near(rod=-40)
    return m


def air() -> Mechanism:
    """A piston that is thrown against its gas; where it is light enough, it does not reach the head."""
    m = Mechanism("air", gravity=None)
    piston = m.body("piston", 1.0)
    m.prismatic("rail", m.ground.origin, piston.origin)
    m.gas("gas", m.ground.at(-0.1, 0), piston.origin, area=1e-3, pressure=2e5, at=0.1, clearance=0.01)
    m.force("push", piston.origin, -1.0, 0.0)
    m.start_moving(piston=(-3.0, 0, 0))
    return m
