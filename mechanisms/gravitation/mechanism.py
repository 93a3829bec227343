"""A sun and a planet that attract each other move on similar ellipses about their centre of mass.
In the variant three equal bodies chase each other for ever along one figure of eight.
"""

from dataclasses import dataclass
from itertools import combinations
from math import pi, sqrt

from mbsd import Mechanism

DURATION = 8.0

VARIANTS = {
    "circle": {"eccentricity": 0.0},
    "eight": {"masses": (0.2, 0.2, 0.2), "eight": True, "period": 6.0, "DURATION": 12.0},
}
EIGHT_PLACE, EIGHT_SPEED, EIGHT_PERIOD = (0.97000436, -0.24308753), (-0.93240737, -0.86473146), 6.32591398
"""Place of the first of three unit masses, velocity of the third, and period (Chenciner, Montgomery 2000; G = 1)."""


@dataclass(frozen=True)
class Params:
    """Masses (kg), semi-major axis of the relative ellipse (m) and its period (s)."""

    masses: tuple[float, ...] = (0.50, 0.05)
    axis: float = 0.15
    eccentricity: float = 0.5
    period: float = 4.0
    eight: bool = False


def build(p: Params) -> Mechanism:
    """Start the bodies farthest apart, with their centre of mass at rest in the origin."""
    m = Mechanism("gravitation", gravity=None)
    names = ("sun", "planet") if len(p.masses) == 2 else tuple(f"body{k + 1}" for k in range(len(p.masses)))
    bodies = [m.body(name, mass, inertia=1e-4) for name, mass in zip(names, p.masses, strict=True)]
    for a, b in combinations(bodies, 2):
        m.gravitation(f"{a.name}_{b.name}", a.origin, b.origin, -strength(p) * a.mass * b.mass)
    for body, (x, y), (vx, vy) in zip(bodies, *start(p), strict=True):
        m.start_near(**{body.name: (x, y, 0)})
        m.start_moving(**{body.name: (vx, vy, 0)})
        if body.name != "sun":
            m.trace(body.name, body.origin)
    return m


def strength(p: Params) -> float:
    """The constant of gravitation (m^3/(kg s^2)) with which the period is as wished: Kepler's third law."""
    if p.eight:
        return (EIGHT_PERIOD / p.period) ** 2 * p.axis**3 / p.masses[0]
    return (2 * pi / p.period) ** 2 * p.axis**3 / sum(p.masses)


def start(p: Params) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Places (m) and velocities (m/s)."""
    if p.eight:
        (x, y), (vx, vy) = EIGHT_PLACE, EIGHT_SPEED
        pace = p.axis * EIGHT_PERIOD / p.period
        places = [(p.axis * x, p.axis * y), (-p.axis * x, -p.axis * y), (0.0, 0.0)]
        return places, [(-pace * vx / 2, -pace * vy / 2)] * 2 + [(pace * vx, pace * vy)]
    e, whole = p.eccentricity, sum(p.masses)
    far, slow = p.axis * (1 + e), 2 * pi * p.axis / p.period * sqrt((1 - e) / (1 + e))
    shares = -p.masses[1] / whole, p.masses[0] / whole
    return [(share * far, 0.0) for share in shares], [(0.0, share * slow) for share in shares]
