"""Wobble engine: a plate that sways on a bent shaft moves pistons along it. SI units."""

from dataclasses import dataclass
from math import cos, dist, pi, radians, sin

from mbsd.spatial import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Pistons, their circle, rods and sizes (m), mass (kg), the bend (degrees), the speed."""

    pistons: int = 4
    circle: float = 0.05
    rod: float = 0.09
    radius: float = 0.010
    length: float = 0.10
    mass: float = 0.15
    bend: float = 18.0
    speed: float = 2 * pi


def build(p: Params) -> Mechanism:
    """The shaft turns about x; a short rod with two balls keeps the plate from turning."""
    m = Mechanism("wobble_engine")
    c, s = cos(radians(p.bend)), sin(radians(p.bend))
    shaft, plate = m.body("shaft"), m.body("plate", 0.4, inertia=(4e-4, 2e-4, 2e-4))
    m.revolute("bearing", m.ground, shaft, at=(-1.6 * p.circle, 0.0, 0.0), axis=(1, 0, 0))
    m.revolute("journal", shaft, plate, at=(0.0, 0.0, 0.0), axis=(c, 0.0, s))
    for k in range(p.pistons):
        turn = 2 * pi * (k + 0.5) / p.pistons
        y, z = p.circle * cos(turn), p.circle * sin(turn)
        pin = (-s * z, y, c * z)  # on the plate, which leans by the bend
        pivot = (pin[0] + (p.rod**2 - (c * z - z) ** 2) ** 0.5, y, z)
        piston = m.rod(f"piston_{k + 1}", pivot, (pivot[0] + p.length, y, z), p.mass, p.radius)
        m.distance(f"rod_{k + 1}", plate, piston, start=pin, end=pivot, length=dist(pin, pivot))
        m.prismatic(f"cylinder_{k + 1}", m.ground, piston, at=(1.5 * p.rod, y, z), axis=(1, 0, 0))
    low = 1.6 * p.circle
    foot = (s * low, 0.0, -c * low)
    end = (foot[0], 1.3 * p.circle, foot[2])
    m.distance("strut", plate, m.ground, start=foot, end=end, length=1.3 * p.circle)
    m.drive_turn("load", "bearing", constant_rate(p.speed))
    return m
