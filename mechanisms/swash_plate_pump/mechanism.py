"""Swash plate pump: a tilted plate that turns moves pistons in a block. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin, tan

from mbsd.spatial import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Pistons, their circle and sizes (m), mass (kg), the tilt (degrees), the speed (rad/s)."""

    pistons: int = 5
    circle: float = 0.04
    radius: float = 0.008
    length: float = 0.075
    mass: float = 0.12
    tilt: float = 15.0
    speed: float = 2 * pi


def build(p: Params) -> Mechanism:
    """The shaft turns about x; a ball of each piston stays on the plate."""
    m = Mechanism("swash_plate_pump")
    normal = (cos(radians(p.tilt)), 0.0, -sin(radians(p.tilt)))
    plate = m.body("plate")
    m.revolute("bearing", m.ground, plate, at=(-1.3 * p.circle, 0.0, 0.0), axis=(1, 0, 0))
    for k in range(p.pistons):
        turn = 2 * pi * k / p.pistons + pi / 2
        y, z = p.circle * cos(turn), p.circle * sin(turn)
        x = tan(radians(p.tilt)) * z
        piston = m.rod(f"piston_{k + 1}", (x, y, z), (x + p.length, y, z), p.mass, p.radius)
        m.point_on_plane(f"shoe_{k + 1}", plate, piston, at=(x, y, z), axis=normal)
        m.prismatic(f"bore_{k + 1}", m.ground, piston, at=(0.6 * p.length, y, z), axis=(1, 0, 0))
    m.drive_turn("motor", "bearing", constant_rate(p.speed))
    return m
