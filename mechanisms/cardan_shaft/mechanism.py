"""Cardan shaft: two universal joints turn one shaft at the rate of another that runs aside of it. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd.spatial import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths (m), the bend at each joint (degrees), the radius of the shafts (m), and the speed (rad/s)."""

    outer: float = 0.10
    middle: float = 0.16
    bend: float = 28.0
    radius: float = 0.006
    speed: float = 2 * pi


def build(p: Params) -> Mechanism:
    """Input and output along x, the middle shaft at the bend between; both yokes of the middle lie in one plane."""
    m = Mechanism("cardan_shaft")
    along = (cos(radians(p.bend)), sin(radians(p.bend)), 0.0)
    a, b = (0.0, 0.0, 0.0), (p.middle * along[0], p.middle * along[1], 0.0)
    start, end = (-p.outer, 0.0, 0.0), (b[0] + p.outer, b[1], 0.0)
    first = m.shaft("input", start, a, p.radius)
    middle = m.shaft("middle", a, b, p.radius)
    last = m.shaft("output", b, end, p.radius)
    across = (-along[1], along[0], 0.0)
    m.revolute("bearing_in", m.ground, first, at=(-0.7 * p.outer, 0.0, 0.0), axis=(1, 0, 0))
    m.universal("cross_in", first, middle, at=a, first=(0, 0, 1), second=across)
    m.universal("cross_out", middle, last, at=b, first=across, second=(0, 0, 1))
    m.cylindrical("bearing_out", m.ground, last, at=(b[0] + 0.7 * p.outer, b[1], 0.0), axis=(1, 0, 0))
    m.drive_turn("motor", "bearing_in", constant_rate(p.speed))
    return m
