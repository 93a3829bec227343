"""A wheel released on a slope rolls through two dales, over the hill between them, and comes back.
Nothing is lost as long as it rolls; on a terrain of planks (a variant) every corner takes a part of its speed, and
dropped from above (another one) it bounces until it rolls.
"""

from dataclasses import dataclass
from math import atan, cos, radians, sin

import numpy as np

from mbsd import Mechanism

DURATION = 3.67

VARIANTS = {
    "polygonal": {"terrain": "polygonal"},
    "bouncing": {"terrain": "bouncing", "restitution": 0.75, "start": -0.22},
}


@dataclass(frozen=True)
class Params:
    """Radius (m), mass (kg) and radius of gyration of the wheel (in its radius), friction, weight (m/s^2).

    ``terrain`` is rolling, polygonal or bouncing. The dales are ``dales`` (m) apart and ``hill`` deep (m); ``planks``
    are their lengths and slopes (m, degrees). The wheel is released where it touches the hills at ``start`` (m, from
    the middle).
    """

    terrain: str = "rolling"
    radius: float = 0.042
    mass: float = 0.12
    gyration: float = 0.66
    friction: float = 0.9
    restitution: float = 0.0
    dales: float = 0.36
    hill: float = 0.040
    start: float = -0.280
    drop: float = 0.12  # above the terrain, where it bounces
    edge: float = 0.03  # from the first plank's end, on planks
    planks: tuple[tuple[float, float], ...] = ((0.17, -40.0), (0.13, -20.0), (0.15, 0.0), (0.13, 20.0), (0.17, 40.0))
    gravity: float = 9.81


def height(p: Params, x: np.ndarray) -> np.ndarray:
    """Height of the hills (m): two dales at half of their distance on either side."""
    return p.hill * ((2 * x / p.dales) ** 2 - 1) ** 2


def slope(p: Params, x: float) -> float:
    """Slope of the hills."""
    u = 2 * x / p.dales
    return 8 * p.hill / p.dales * u * (u**2 - 1)


def corners(p: Params) -> list[tuple[float, float]]:
    """Where planks begin, and where the last one ends (m); the lowest are level with y = 0."""
    points = [(0.0, 0.0)]
    for length, angle in p.planks:
        x, y = points[-1]
        points.append((x + length * cos(radians(angle)), y + length * sin(radians(angle))))
    middle, lowest = points[-1][0] / 2, min(y for _, y in points)
    return [(x - middle, y - lowest) for x, y in points]


def first_place(p: Params) -> tuple[float, float]:
    """Place of the wheel's centre (m): its tyre touches the ground at ``start``, or is ``drop`` above it."""
    if p.terrain == "polygonal":
        (x, y), angle = corners(p)[0], radians(p.planks[0][1])
        return x + p.edge * cos(angle) - p.radius * sin(angle), y + p.edge * sin(angle) + p.radius * cos(angle)
    angle = atan(slope(p, p.start))
    above = p.drop if p.terrain == "bouncing" else 0.0
    return p.start - p.radius * sin(angle), float(height(p, np.array(p.start))) + p.radius * cos(angle) + above


def build(p: Params) -> Mechanism:
    """The wheel is free, and released at rest on the left."""
    m = Mechanism("terrain_wheel", gravity=(0.0, -p.gravity))
    wheel = m.body("wheel", mass=p.mass, inertia=p.mass * (p.gyration * p.radius) ** 2)
    if p.terrain == "polygonal":
        for k, ((x, y), (_, angle)) in enumerate(zip(corners(p)[:-1], p.planks, strict=True)):
            plank = m.ground.at(x, y, radians(angle))
            m.rigid_contact(f"plank{k + 1}", plank, wheel.origin, p.radius, p.restitution, p.friction)
    else:
        x = np.linspace(-0.84 * p.dales, 0.84 * p.dales, 49)
        hills = np.stack([x, height(p, x)], axis=1).tolist()
        m.rigid_terrain("hills", m.ground.origin, wheel.origin, hills, p.radius, False, p.restitution, p.friction)
    m.trace("P", wheel.origin)
    m.start_near(wheel=(*first_place(p), 0))
    m.start_moving(wheel=(0, 0, 0))
    return m
