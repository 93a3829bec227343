"""Machines whose many simulations are compared with single ones."""

from __future__ import annotations

import math

from mbsd import Mechanism, curve

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


def barrier(stops: bool = False) -> Mechanism:
    m = Mechanism("barrier")
    a, b, c = m.bar("crank", 0.1, mass=0.3), m.bar("coupler", 0.38, mass=0.5), m.bar("rocker", 0.3, mass=2.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    pivot = m.revolute("D", m.ground.at(0.4, 0.02), c.start)
    m.motor("motor", m.ground, a, curve([-10, 0, 20, 40], [6.0, 5.0, 2.0, 0.0]))
    m.torsion_spring("spring", m.ground, c, 3.0, 0.4, free_angle=1.8)
    if stops:
        m.stop("end", pivot, lower=math.radians(85), upper=math.radians(125), restitution=0.3)
    m.start_near(crank=0, coupler=45, rocker=90)
    return m
