"""Machines whose joints stick and slide, for tests and benchmarks."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mbsd import STANDARD_GRAVITY, Mechanism, harmonic, polynomial


def slider_crank(gravity: Sequence[float] | None = STANDARD_GRAVITY) -> Mechanism:
    """Crank 0.1 m at 30 degrees, rod 0.3 m; pins O, A, B and the guide ``rail``."""
    m = Mechanism("slider-crank", gravity=gravity)
    crank, rod, slider = m.bar("crank", 0.1, 1.0), m.bar("rod", 0.3, 0.8), m.body("slider", 1.5, inertia=0.01)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("rail", m.ground.origin, slider.origin)
    m.start_near(crank=30, rod=-10, slider=(0.37, 0, 0))
    return m


def bell(angle: float = -20.0, turned: float = 0.0) -> Mechanism:
    """Return a pendulum in a dry bearing, which comes to rest off the vertical.

    ``turned`` (rad): the world with it.
    """
    m = Mechanism("bell", gravity=(9.80665 * math.sin(turned), -9.80665 * math.cos(turned)))
    bar = m.bar("bar", 0.5, mass=1.0)
    m.revolute("pin", m.ground.at(0.2, 0.1), bar.start)
    m.friction("rub", "pin", 0.3, static=0.4, radius=0.1, preload=1.0, sticks=True)
    m.start_near(bar=angle + math.degrees(turned))
    return m


def coasting_slider_crank(speed: float = 6.0, pull: float = 0.0) -> Mechanism:
    """Return a slider-crank whose dry joints come to rest at once; the torque ``pull`` t turns it."""
    m = slider_crank(gravity=None)
    for pin in "OAB":
        m.friction(f"rub {pin}", pin, 0.15, static=0.2, radius=0.02, preload=20.0, sticks=True)
    m.friction("rub", "rail", 0.2, length=0.08, preload=10.0, sticks=True)
    if pull:
        m.torque("motor", m.bodies["crank"], polynomial(0.0, pull))
    m.start_moving(crank=speed)
    return m


def shaken_block() -> Mechanism:
    """A block on a spring and on a belt that goes to and fro: it sticks and breaks away again and again."""
    m = Mechanism("shaken block")
    belt, block = m.body("belt", 1.0, inertia=1.0), m.body("block", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, belt.origin)
    m.drive_coordinate("shake", m.ground.origin, belt.origin, harmonic(0.03, 7.0))
    m.prismatic("touch", belt.origin, block.origin)
    m.friction("rub", "touch", 0.3, static=0.5, stribeck=0.05, sticks=True)
    m.spring("spring", m.ground.at(-3, 0), block.origin, 50.0, free_length=3.0)
    m.start_near(belt=(0, 0, 0), block=(0, 0, 0))
    return m


def arm() -> Mechanism:
    """Two links with friction in both joints, which stick and slide in turn."""
    m = Mechanism("arm")
    upper, fore = m.bar("upper", 0.5, mass=1.0), m.bar("fore", 0.4, mass=0.7)
    m.revolute("shoulder", m.ground.at(0, 0), upper.start)
    m.revolute("elbow", upper.end, fore.start)
    for joint in ("shoulder", "elbow"):
        m.friction(f"rub {joint}", joint, 0.3, static=0.4, radius=0.05, sticks=True)
    m.start_near(upper=-20, fore=10)
    return m


def two_slider_cranks(pull: float = 0.0, names: str = "ab") -> Mechanism:
    """Return slider-cranks "a" and "b" without a common body.

    The torque ``pull`` t turns "a", a constant one "b".
    """
    m = Mechanism("two slider-cranks", gravity=None)
    for name in names:
        y, angle, preload = (0.0, 30.0, 20.0) if name == "a" else (1.0, 50.0, 35.0)
        tilt = -math.asin(0.1 * math.sin(math.radians(angle)) / 0.3)
        reach = 0.1 * math.cos(math.radians(angle)) + 0.3 * math.cos(tilt)
        crank, rod = m.bar(f"crank {name}", 0.1, 1.0), m.bar(f"rod {name}", 0.3, 0.8)
        slider = m.body(f"slider {name}", 1.5, inertia=0.01)
        m.revolute(f"O{name}", m.ground.at(0, y), crank.start)
        m.revolute(f"A{name}", crank.end, rod.start)
        m.revolute(f"B{name}", rod.end, slider.origin)
        m.prismatic(f"rail {name}", m.ground.at(0, y), slider.origin)
        for pin in "OAB":
            m.friction(f"rub {pin}{name}", f"{pin}{name}", 0.3, radius=0.02, preload=preload, sticks=True)
        m.torque(f"motor {name}", crank, polynomial(0.0, pull) if name == "a" else 0.02)
        m.start_near(**{f"crank {name}": angle, f"rod {name}": math.degrees(tilt), f"slider {name}": (reach, y, 0)})
        m.start_moving(**{f"crank {name}": 2.0})
    return m


def stuck_five_bar(
    motor: float = 20.0, turned: float = 0.0, order: str = "ABCDE", bend: float | None = None
) -> Mechanism:
    """Return four bars with two freedoms and friction in all joints, added in this ``order``.

    The torque ``motor`` t turns them.

    ``bend`` (rad): c is welded to d, ahead of it by so much.
    """
    fall = 9.80665
    m = Mechanism("five-bar", gravity=(fall * math.sin(turned), -fall * math.cos(turned)))
    a, d = m.bar("a", 0.3, mass=0.6), m.bar("d", 0.25, mass=0.5)
    b, c = m.bar("b", 0.5, mass=0.8), m.bar("c", 0.45, mass=0.7)
    m.revolute("A", m.ground.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    if bend is None:
        m.revolute("D", c.start, d.end)
    else:
        m.weld("D", c.start, d.at(0.25, 0.0, bend))
    m.revolute("E", m.ground.at(0.4 * math.cos(turned), 0.4 * math.sin(turned)), d.start)
    for pin in order:
        preload = 100.0 + 10.0 * "ABCDE".index(pin)
        m.friction(f"rub {pin}", pin, 0.3, static=0.4, radius=0.06, preload=preload, sticks=True)
    m.torque("motor", a, polynomial(0.0, motor))
    tilt = math.degrees(turned)
    m.start_near(a=110.0 + tilt, b=45.0 + tilt, c=100.0 + tilt, d=70.0 + tilt)
    m.start_moving(a=1.0)
    return m


def weightless_slider_crank() -> Mechanism:
    """Return a slider-crank that comes to rest in one dry pin, nothing loading it.

    Squares of its rates are then too small for a number.
    """
    m = Mechanism("weightless", gravity=None)
    r, length, angle = 0.09957978332364759, 0.2476403430340473, 4.788131827429562
    crank, rod = m.bar("part", r, 1.7456816106902577), m.bar("rod", length, 0.8)
    slider = m.body("slider", 1.5748304925257235, inertia=0.01)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("rail", m.ground.origin, slider.origin)
    tilt = -math.asin(r * math.sin(angle) / length)
    reach = r * math.cos(angle) + length * math.cos(tilt)
    m.start_near(part=math.degrees(angle), rod=math.degrees(tilt), slider=(reach, 0, 0))
    m.friction("rub O", "O", 0.05, static=0.22, radius=0.02, preload=20.0, sticks=True)
    m.torque("motor", crank, polynomial(0.0, 0.0))
    m.start_moving(part=1.5748304925257235)
    return m


def loaded_lever() -> Mechanism:
    """A ball falls on a lever that the friction of its pin holds, and later breaks away."""
    m = Mechanism("lever")
    lever, ball = m.body("lever", 1.0, inertia=0.1), m.body("ball", 0.5, inertia=1e-3)
    m.revolute("pin", m.ground.origin, lever.origin)
    m.friction("rub", "pin", 0.5, radius=0.2, sticks=True)
    m.rigid_contact("touch", lever.origin, ball.origin, radius=0.02)
    m.start_near(lever=0, ball=(0.3, 0.32, 0))
    return m


def stopped_bell() -> Mechanism:
    m = bell(40.0)
    m.stop("end", m.joints["pin"], lower=-2.0, upper=1.0, restitution=0.5)
    return m


def ratchet() -> Mechanism:
    """A wheel on a spring that an oscillating load turns forwards alone."""
    m = Mechanism("ratchet", gravity=None)
    wheel, load = m.body("wheel", 1.0, inertia=0.5), m.body("load", 1.0, inertia=0.3)
    m.revolute("axle", m.ground.origin, wheel.origin)
    m.revolute("other", m.ground.at(1, 0), load.origin)
    m.one_way("clutch", m.ground, wheel)
    m.torsion_spring("shaft", wheel, load, 40.0, 0.2)
    m.torque("motor", load, harmonic(6.0, 4.0, 1.0))
    return m


def rubbed_ratchet() -> Mechanism:
    m = ratchet()
    m.friction("rub", "other", 0.2, radius=0.1, preload=20.0, sticks=True)
    return m
