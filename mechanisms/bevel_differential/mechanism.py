"""Bevel differential: the cage turns at the mean of both shafts, whatever their difference. SI units."""

from dataclasses import dataclass
from math import cos, pi, sin

from mbsd.spatial import Mechanism, function


@dataclass(frozen=True)
class Params:
    """Teeth, distance of the planet (m), the mean speed and how far both differ (rad/s)."""

    side: int = 20
    planet: int = 14
    radius: float = 0.05
    speed: float = pi
    curve: float = 0.6 * pi


def build(p: Params) -> Mechanism:
    """Shafts along x, the planet's axis along z at the start; the car goes through bends."""
    m = Mechanism("bevel_differential")
    out, inner, thick = 2.7 * p.radius, 0.55 * p.radius, 0.1 * p.radius
    cage = m.body("cage")
    left = m.shaft("left", (-out, 0.0, 0.0), (-inner, 0.0, 0.0), thick)
    right = m.shaft("right", (inner, 0.0, 0.0), (out, 0.0, 0.0), thick)
    planet = m.disc("planet", (0.0, 0.0, p.radius), (0, 0, 1), 0.45 * p.radius, thickness=thick)
    for name, shaft, way in (("left", left, -1.0), ("right", right, 1.0)):
        m.revolute(f"block_{name}", m.ground, shaft, at=(2.2 * way * p.radius, 0.0, 0.0), axis=(way, 0, 0))
    m.revolute("left_bearing", cage, left, at=(-1.4 * p.radius, 0.0, 0.0), axis=(-1, 0, 0))
    m.cylindrical("right_bearing", cage, right, at=(1.4 * p.radius, 0.0, 0.0), axis=(1, 0, 0))
    m.revolute("pin", cage, planet, at=(0.0, 0.0, p.radius), axis=(0, 0, 1))
    m.gear_pair("left_mesh", "left_bearing", "pin", teeth=(p.side, p.planet))
    m.gear_pair("right_mesh", "pin", "right_bearing", teeth=(p.planet, p.side))
    for name, way in (("left", -1.0), ("right", 1.0)):

        def turn(t: float, way: float = way) -> float:
            return way * p.speed * t + p.curve / p.speed * (1 - cos(p.speed * t))

        def rate(t: float, way: float = way) -> float:
            return way * p.speed + p.curve * sin(p.speed * t)

        rates = rate, lambda t: p.curve * p.speed * cos(p.speed * t)
        m.drive_turn(f"drive_{name}", f"block_{name}", function(turn, *rates, period=2 * pi / p.speed))
    return m
