"""Machines with stops and contacts without friction."""

from __future__ import annotations

import math

from mbsd import Mechanism, curve


def barrier(stops: bool = False, damping: float = 0.4) -> Mechanism:
    m = Mechanism("barrier")
    a, b, c = m.bar("crank", 0.1, mass=0.3), m.bar("coupler", 0.38, mass=0.5), m.bar("rocker", 0.3, mass=2.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    pivot = m.revolute("D", m.ground.at(0.4, 0.02), c.start)
    m.motor("motor", m.ground, a, curve([-10, 0, 20, 40], [6.0, 5.0, 2.0, 0.0]))
    m.torsion_spring("spring", m.ground, c, 3.0, damping, free_angle=1.8)
    if stops:
        m.stop("end", pivot, lower=math.radians(85), upper=math.radians(125), restitution=0.3)
    m.start_near(crank=0, coupler=45, rocker=90)
    return m


def ball() -> Mechanism:
    m = Mechanism("ball", gravity=(0, -9.81))
    ball = m.body("ball", mass=0.2, inertia=1e-4)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, radius=0.05, restitution=0.6)
    m.spring("band", m.ground.at(0, 0.3), ball.origin, 1.0, 0.0, free_length=0.2)
    m.start_near(ball=(0.01, 0.5, 0))
    return m


def bumpers() -> Mechanism:
    m = Mechanism("bumpers", gravity=None)
    carts = [m.body(f"c{k}", mass=0.5) for k in range(4)]
    for k, cart in enumerate(carts):
        m.prismatic(f"rail{k}", m.ground.origin, cart.origin)
    for k in range(3):
        m.coordinate_stop(f"s{k}", carts[k].origin, carts[k + 1].origin, 0.1, restitution=0.9)
    m.coordinate_stop("wall", m.ground.origin, carts[3].origin, 1.0, upper=True, restitution=0.8)
    m.start_near(c0=(-0.5, 0, 0), c1=(0, 0, 0), c2=(0.1, 0, 0), c3=(0.2, 0, 0))
    m.start_moving(c0=(2.0, 0, 0), c1=(0, 0, 0), c2=(0, 0, 0), c3=(0, 0, 0))
    return m


def box() -> Mechanism:
    m = Mechanism("box", gravity=(0, -9.81))
    box = m.body("box", mass=1.0, inertia=0.01)
    for name, x in (("left", -0.1), ("right", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), box.at(x, -0.1), restitution=0.4)
    m.start_near(box=(0, 0.5, 10))
    return m


def plank() -> Mechanism:
    """It comes to rest on three points of a line, the middle one alone carrying at times."""
    m = Mechanism("plank", gravity=(0, -9.81))
    plank = m.body("plank", mass=1.0, inertia=0.02)
    for name, x in (("left", -0.1), ("middle", 0.0), ("right", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), plank.at(x, -0.1), restitution=0.4)
    m.start_near(plank=(0, 0.5, 10))
    return m


def limited() -> Mechanism:
    m = Mechanism("limited")
    arm, fore = m.bar("arm", 0.5, mass=1.0), m.bar("fore", 0.4, mass=0.5)
    m.revolute("shoulder", m.ground.at(0, 0), arm.start)
    m.revolute("elbow", arm.end, fore.start, limits=(math.radians(-10), math.radians(140)))
    slide = m.body("slide", mass=0.3)
    m.prismatic("rail", m.ground.at(1.0, -0.2), slide.origin, limits=(-0.1, 0.2))
    m.spring("tie", fore.end, slide.origin, 30.0, 0.5, free_length=0.2)
    m.start_near(arm=0, fore=30, slide=(1.0, -0.2, 0))
    return m


def massless() -> Mechanism:
    m = Mechanism("massless")
    link, bob = m.bar("link", 0.4), m.body("bob", mass=1.0, inertia=0.01)
    m.revolute("pin", m.ground.at(0, 0), link.start)
    m.revolute("end", link.end, bob.origin)
    m.angle_stop("stop", m.ground.origin, link.start, math.radians(-80), restitution=0.5)
    m.start_near(link=0, bob=(0.4, 0, 0))
    return m
