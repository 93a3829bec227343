"""The trammel of Archimedes: a rod on two shuttles in crossed grooves, whose end draws an ellipse.
Every point of the rod draws one: half of its axes are the distances of the point from the two pins. The point midway
between the pins draws a circle.
"""

from dataclasses import dataclass
from math import degrees, pi

from mbsd import Mechanism, constant_rate

VARIANTS = {"skew": {"angle": pi / 3}}


@dataclass(frozen=True)
class Params:
    """Lengths (m), the angle of the second groove against the first (rad), speed of the rod (rad/s)."""

    pins: float = 0.080  # distance of the two pins on the rod
    beyond: float = 0.070  # from the second pin to the pen
    angle: float = pi / 2
    speed: float = pi / 2


def build(p: Params) -> Mechanism:
    """The first groove lies along x.

    The rod turns evenly; its pen is beyond the pin of the second shuttle.
    """
    m = Mechanism("trammel", gravity=None)
    first, second = m.body("first"), m.body("second")
    rod = m.bar("rod", p.pins + p.beyond)
    m.prismatic("X", m.ground.at(0, 0), first.origin)
    m.prismatic("Y", m.ground.at(0, 0, p.angle), second.origin)
    m.revolute("A", first.origin, rod.start)
    m.revolute("B", second.origin, rod.at(p.pins, 0))
    m.drive_angle("motor", rod, constant_rate(p.speed))
    m.trace("pen", rod.end)
    m.start_near(first=(-p.pins, 0, 0), second=(0, 0, degrees(p.angle)), rod=0)
    return m
