"""Bodies on rough contacts: they stick, slide, roll, bounce and jam."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, harmonic
from tools.models.contact_models import G


def incline(friction: float = 0.4, static: float | None = None, slope: float = 25.0) -> Mechanism:
    """A box on two feet, thrown up an incline: it slides, stops, stays or comes back, or tips."""
    m = Mechanism("incline", gravity=(0, -G))
    box = m.body("box", 1.0, inertia=0.01)
    for name, x in (("rear", -0.15), ("front", 0.15)):
        m.rigid_contact(
            name, m.ground.at(0, 0, math.radians(slope)), box.at(x, -0.05), friction=friction, static_friction=static
        )
    c, s = math.cos(math.radians(slope)), math.sin(math.radians(slope))
    m.start_near(box=(-0.05 * s, 0.05 * c, slope))
    m.start_moving(box=(1.5 * c, 1.5 * s, 0))
    return m


def ball(friction: float = 0.2, restitution: float = 0.6) -> Mechanism:
    """A ball between floor and wall, thrown with spin."""
    m = Mechanism("ball", gravity=(0, -G))
    ball = m.body("ball", 0.2, inertia=0.4 * 0.2 * 0.05**2)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, 0.05, restitution, friction)
    m.rigid_contact("wall", m.ground.at(0.5, 0, math.pi / 2), ball.origin, 0.05, restitution, friction)
    m.start_near(ball=(0, 0.4, 0))
    m.start_moving(ball=(1.0, 0, 40))
    return m


def tumbling(friction: float = 0.3, restitution: float = 0.3) -> Mechanism:
    """A box with four corners, thrown."""
    m = Mechanism("tumbling", gravity=(0, -G))
    box = m.body("box", 1.0, inertia=0.02)
    for k, (x, y) in enumerate(((-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1))):
        m.rigid_contact(f"corner {k}", m.ground.at(0, 0), box.at(x, y), 0.0, restitution, friction)
    m.start_near(box=(0, 0.6, 20))
    m.start_moving(box=(1.0, 0, -3))
    return m


def belt(friction: float = 0.3, static: float = 0.5) -> Mechanism:
    """A block on a base that swings to and fro, held by a spring: it sticks and slips."""
    m = Mechanism("belt", gravity=(0, -G))
    base, block = m.body("base", 1.0, inertia=1.0), m.body("block", 1.0, inertia=0.01)
    m.prismatic("rail", m.ground.origin, base.origin)
    m.drive_coordinate("motor", m.ground.origin, base.origin, harmonic(0.1, 6.0))
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, base.at(0, 0), block.at(x, -0.05), friction=friction, static_friction=static)
    m.spring("spring", m.ground.at(-1, 0.05), block.origin, 50.0, 0.5, free_length=1.0)
    m.start_near(base=(0, 0, 0), block=(0, 0.05, 0))
    return m


def crank() -> Mechanism:
    """A linkage that pushes a rough block along the floor and pulls it back."""
    m = Mechanism("crank", gravity=(0, -G))
    crank, rod, block = m.bar("crank", 0.1, mass=0.3), m.bar("rod", 0.4, mass=0.2), m.body("block", 2.0, inertia=0.02)
    m.revolute("O", m.ground.at(0, 0.1), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.at(0, 0.02))
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), block.at(x, -0.05), friction=0.3)
    m.torque("motor", crank, 1.5)
    m.start_near(crank=60, rod=-10, block=(0.44, 0.05, 0))
    return m


def hills() -> Mechanism:
    """A wheel on rough hills: it rolls, slips, flies."""
    m = Mechanism("hills", gravity=(0, -G))
    wheel = m.body("wheel", 0.5, inertia=0.5 * 0.5 * 0.1**2)
    points = [(x, 0.2 * math.sin(2 * x) - 0.1 * x) for x in np.linspace(-2.0, 6.0, 60)]
    m.rigid_terrain("road", m.ground.origin, wheel.origin, points, 0.1, restitution=0.2, friction=0.25)
    m.start_near(wheel=(-0.5, 0.5, 0))
    m.start_moving(wheel=(2.0, 0, 0))
    return m


def rod(friction: float = 0.2) -> Mechanism:
    m = Mechanism("rod", gravity=(0, -G))
    rod = m.body("rod", 1.0, inertia=1.0 / 12)
    m.rigid_contact("tip", m.ground.at(0, 0), rod.at(-0.5, 0), friction=friction)
    angle = math.radians(40)
    m.start_near(rod=(0.5 * math.cos(angle), 0.5 * math.sin(angle), 40))
    m.start_moving(rod=(-2.0, 0, 0))
    return m


def discs() -> Mechanism:
    """Two discs on the floor that roll into each other."""
    m = Mechanism("discs", gravity=(0, -G))
    a, b = m.body("a", 1.0, inertia=0.005), m.body("b", 0.5, inertia=0.001)
    for name, body, radius in (("floor a", a, 0.1), ("floor b", b, 0.06)):
        m.rigid_contact(name, m.ground.at(0, 0), body.origin, radius, 0.3, 0.2)
    m.rigid_discs("pair", a.origin, b.origin, 0.1, 0.06, restitution=0.5, friction=0.3)
    m.start_near(a=(-0.4, 0.1, 0), b=(0.1, 0.2, 0))
    m.start_moving(a=(2.0, 0, -20), b=(-0.5, 0, 10))
    return m


def ring() -> Mechanism:
    """Return a disc within a rolling ring, whose centres pass each other.

    Steps may take them half their way alone.
    """
    m = Mechanism("ring", gravity=(0, -G))
    ring, disc = m.body("ring", 1.0, inertia=0.05), m.body("disc", 0.3, inertia=0.001)
    m.rigid_contact("floor", m.ground.at(0, 0), ring.origin, 0.3, 0.0, 0.5)
    m.rigid_discs("pair", ring.origin, disc.origin, 0.28, 0.06, True, 0.8, 0.3)
    m.start_near(ring=(0, 0.3, 0), disc=(0.15, 0.302, 0))
    m.start_moving(ring=(1.0, 0, 0), disc=(-2.0, 0, 10))
    return m


def freewheel() -> Mechanism:
    """A rolling disc pushed to and fro, with a flywheel that it takes along one way alone."""
    m = Mechanism("freewheel", gravity=(0, -G))
    disc, fly = m.body("disc", 1.0, inertia=0.005), m.body("fly", 0.5, inertia=0.003)
    m.rigid_contact("floor", m.ground.at(0, 0), disc.origin, 0.1, 0.2, 0.4)
    m.revolute("axle", disc.origin, fly.origin)
    m.one_way("ratchet", disc, fly)
    m.spring("spring", m.ground.at(0, 0.1), disc.origin, 80.0, 0.2, free_length=0.5)
    m.start_near(disc=(0.8, 0.15, 0), fly=(0.8, 0.15, 0))
    return m
