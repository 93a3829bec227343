"""Machines with joints that repeat others, and with events that release joints."""

from __future__ import annotations

import math

import numba

from mbsd import Mechanism, angle_reaches, constant_rate, polynomial, speed_reaches

# Machines with joints that repeat others.


def cranks(turning: float = 0.0, stops: bool = False, motor: bool = False) -> Mechanism:
    """Return three equal cranks, of which the third repeats the others.

    Where they turn they lie flat twice a turn.
    """
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


# Machines whose events release joints.


@numba.njit
def kicked(t, q, v):
    return v[0] + 0.2, v[1] + 0.5, v[2] - 1.0


def sling() -> Mechanism:
    """An arm that is thrown off its hinge onto a floor."""
    m = Mechanism("sling", gravity=(0, -9.81))
    arm = m.bar("arm", 0.5, mass=0.3)
    hinge = m.revolute("hinge", m.ground.at(0, 1), arm.start)
    m.torque("spring", arm, 4.0)
    for name, tip in (("floor", arm.start), ("other", arm.end)):
        m.rigid_contact(name, m.ground.at(0, 0), tip, radius=0.02, restitution=0.3, friction=0.2)
    m.event("off", angle_reaches(arm, math.pi / 4), releases=hinge)
    m.start_near(arm=-90)
    return m


def chain() -> Mechanism:
    """Two pendulums: the lower one breaks off with a kick, then the upper one, and a motor lets go."""
    m = Mechanism("chain")
    a, b, disc = m.bar("a", 1.0, mass=1.0), m.bar("arm", 0.7, mass=0.5), m.body("disc", mass=1.0, inertia=5e-3)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("hinge", a.end, b.start)
    m.revolute("axle", a.at(0.5, 0), disc.origin)
    m.friction("rub", "hinge", 0.1, radius=0.02)
    m.drive_angle("motor", disc, constant_rate(20.0))
    m.torsion_spring("spring", m.ground, a, 1.0, 0.1)
    m.event("break", speed_reaches(b, -2.0), frames=b, action=kicked, releases="hinge")
    m.event("stop", angle_reaches(disc, 9.0), releases=("motor", "A"))
    m.event("again", angle_reaches(disc, 10.0), releases="A")
    m.start_near(a=-30, arm=-20)
    return m


def dry_chain() -> Mechanism:
    """Return a chain in dry bearings.

    They come to rest, hold, and are released while they hold and while they turn.
    """
    m = chain()
    m.friction("dry", "A", 0.2, radius=0.1, preload=120.0, sticks=True)
    m.friction("dry axle", "axle", 0.1, radius=0.02, sticks=True)
    return m


def held_up() -> Mechanism:
    """Return two bars that their dry pins hold until both are released at once.

    Then one falls on a floor.
    """
    m = Mechanism("shelf", gravity=(0, -9.81))
    a, b, disc = m.bar("a", 0.4, mass=0.5), m.bar("coupler", 0.3, mass=0.4), m.body("disc", mass=1.0, inertia=1.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("axle", m.ground.at(2, 0), disc.origin)
    m.drive_angle("clock", disc, constant_rate(1.0))
    for pin in "AB":
        m.friction(f"rub {pin}", pin, 0.3, radius=0.1, preload=150.0, sticks=True)
    m.rigid_contact("floor", m.ground.at(0, -0.3), b.end, radius=0.01, restitution=0.3, friction=0.2)
    m.event("B breaks", angle_reaches(disc, 0.3), releases="B")
    m.event("A breaks", angle_reaches(disc, 0.5), releases="A")
    m.event("too", angle_reaches(disc, 0.5), releases=("A", "B"))
    m.start_near(a=10, coupler=20, disc=(2, 0, 0))
    return m


def twin_hinges() -> Mechanism:
    """A sling whose second hinge takes over."""
    m = sling()
    m.revolute("twin", m.ground.at(0, 1), m.bodies["arm"].start)
    m.event("twin breaks", angle_reaches(m.bodies["arm"], math.radians(80)), releases="twin")
    return m


def broken_cranks(m: Mechanism) -> Mechanism:
    """Three equal cranks of which each breaks in turn; then the coupler is free."""
    for k, (angle, joints) in enumerate(((-75, "A1"), (-80, ("B0", "A2")))):
        m.event(f"breaks {k}", angle_reaches(m.bodies["crank0"], math.radians(angle)), releases=joints)
    m.event("last", speed_reaches(m.bodies["crank2"], 0.5), releases="B2")
    return m


def motor_and_cranks() -> Mechanism:
    """The crank with the motor lets go of the coupler, which the others carry, and then the motor itself."""
    m = cranks()
    m.drive_angle("motor", m.bodies["crank1"], polynomial(math.radians(-60), -2.0))
    m.event("off", angle_reaches(m.bodies["crank1"], math.radians(-80)), releases="B1")
    m.event("stops", angle_reaches(m.bodies["crank1"], math.radians(-120)), releases="motor")
    return m
