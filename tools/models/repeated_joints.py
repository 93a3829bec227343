"""Machines with joints that repeat others."""

from __future__ import annotations

import math

from mbsd import Mechanism, constant_rate


def cranks(turning: float = 0.0, stops: bool = False, motor: bool = False) -> Mechanism:
    """Three equal cranks, of which the third repeats the others; where they turn they lie flat twice a turn."""
    m = Mechanism("cranks", gravity=(0, -9.81))
    coupler = m.bar("coupler", 0.6, mass=1.0)
    pins = []
    for k, (x, y) in enumerate(((0.0, 0.0), (0.6, 0.0), (0.25, 0.2))):
        crank = m.bar(f"crank{k}", 0.3, mass=0.4)
        pins.append(m.revolute(f"A{k}", m.ground.at(x, y), crank.start))
        m.revolute(f"B{k}", crank.end, coupler.at(x, y))
    m.torsion_spring("spring", m.ground, m.bodies["crank0"], 1.0 if not turning else 0.0, 0.05)
    if stops:
        m.stop("end", pins[0], lower=math.radians(-130), upper=math.radians(-30), restitution=0.4)
    if motor:
        m.drive_angle("motor", m.bodies["crank1"], constant_rate(9.0))
    m.start_near(crank0=-60, crank1=-60, crank2=-60)
    if turning:
        m.start_moving(crank0=turning)
    return m


def dry(sticks: bool) -> Mechanism:
    """The same with friction, which depends on the rows that hold."""
    m = cranks(stops=sticks)
    m.friction("friction", "A2", 0.03, radius=0.02, sticks=sticks)
    m.friction("other", "B0", 0.05, radius=0.03, sticks=sticks)
    return m


def row_of_cranks(count: int = 18) -> Mechanism:
    """Equal cranks beside each other, with four rows each."""
    m = Mechanism("row", gravity=(0, -9.81))
    coupler = m.bar("coupler", 0.1 * count, mass=1.0)
    for k in range(count):
        x, y, crank = 0.1 * k, 0.01 * (k % 3), m.bar(f"crank{k}", 0.3, mass=0.4)
        m.revolute(f"A{k}", m.ground.at(x, y), crank.start)
        m.revolute(f"B{k}", crank.end, coupler.at(x, y))
    m.torsion_spring("spring", m.ground, m.bodies["crank0"], 1.0, 0.05)
    m.start_near(**{f"crank{k}": -60 for k in range(count)})
    m.start_moving(crank0=6.0)
    return m


def doors() -> Mechanism:
    """A leaf on two hinges of one axis, beside a slider on two rails."""
    m = Mechanism("doors", gravity=(0, -9.81))
    leaf, cart = m.bar("leaf", 0.8, mass=2.0), m.body("cart", mass=1.0, inertia=0.05)
    m.revolute("hinge", m.ground.at(0, 0), leaf.start)
    m.revolute("other", m.ground.at(0, 0), leaf.at(0, 0))
    m.prismatic("rail", m.ground.at(1.2, -0.5), cart.origin)
    m.prismatic("rail2", m.ground.at(1.2, -0.4), cart.at(0, 0.1))
    m.spring("tie", leaf.end, cart.origin, 30.0, 0.6, free_length=0.3)
    m.start_near(leaf=-20, cart=(1.2, -0.5, 0))
    return m
