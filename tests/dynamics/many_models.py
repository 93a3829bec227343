"""Machines whose many simulations are compared with single ones."""

from __future__ import annotations

from mbsd import Mechanism

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
