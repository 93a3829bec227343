"""A planetary gear: the sun drives three planets that roll in the fixed ring and turn the carrier.
The carrier turns at a quarter of the sun's speed; with another member held it is another gear: a carrier that stands
still turns the ring backwards, a sun that stands still lets the ring drive the carrier.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd import Mechanism, constant_rate

# Which member stands still: make run-planetary-gear-carrier-fixed.
VARIANTS = {
    "carrier_fixed": {"fixed": "carrier"},
    "sun_fixed": {"fixed": "sun"},
}


@dataclass(frozen=True)
class Params:
    """Teeth of sun and planets (the ring follows), their module (m), the driven member's speed (rad/s).

    Equal planets stand evenly where the teeth of sun and ring together divide by their number: 18 + 54 by three.
    """

    sun: int = 18
    planet: int = 18
    planets: int = 3
    module: float = 0.002
    speed: float = 2 * pi
    fixed: str = "ring"  # or "carrier" or "sun"

    @property
    def ring(self) -> int:
        """Teeth of the ring, in which sun and planets fit beside each other."""
        return self.sun + 2 * self.planet


def build(p: Params) -> Mechanism:
    """All about the origin. A ring that stands still is part of ground; other members are held by a lock."""
    m = Mechanism("planetary_gear")
    sun, carrier = m.body("sun"), m.body("carrier")
    ring = m.ground if p.fixed == "ring" else m.body("ring")
    m.revolute("S", m.ground.at(0, 0), sun.origin)
    m.revolute("C", m.ground.at(0, 0), carrier.origin)
    if ring is not m.ground:
        m.revolute("R", m.ground.at(0, 0), ring.origin)
        m.angle_lock("brake", m.ground.origin, {"carrier": carrier, "sun": sun}[p.fixed].origin)
        m.start_near(ring=0)
    radius = p.module * (p.sun + p.planet) / 2
    for k in range(1, p.planets + 1):
        planet, turn = m.body(f"planet{k}"), radians(90) + 2 * pi * (k - 1) / p.planets
        m.revolute(f"P{k}", carrier.at(radius * cos(turn), radius * sin(turn)), planet.origin)
        m.gear_pair(f"sun{k}", sun.origin, planet.origin, teeth=(p.sun, p.planet), module=p.module)
        m.gear_pair(f"ring{k}", ring.at(0, 0), planet.origin, teeth=(p.ring, p.planet), module=p.module, internal=True)
        m.start_near(**{planet.name: 0})
    m.drive_angle("motor", ring if p.fixed == "sun" else sun, constant_rate(p.speed))
    m.start_near(sun=0, carrier=0)
    return m
