"""A scotch yoke: the crank's pin runs in a slot across the yoke, so the yoke moves exactly as a cosine.
With a spring against the yoke that is in tune with the crank (the variant), the motor need not shake the yoke any
more: the spring does.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate

VARIANTS = {"spring": {"tuned": True}}


@dataclass(frozen=True)
class Params:
    """Lengths (m), mass of the yoke (kg) and speed (rad/s); ``tuned`` adds a spring of mass * speed^2."""

    crank: float = 0.040
    guide: float = 0.140  # from the slot to the block in the guide
    mass: float = 0.5
    speed: float = 2 * pi
    tuned: bool = False


def build(p: Params) -> Mechanism:
    """The yoke slides along x; its slot stands along y."""
    m = Mechanism("scotch_yoke")
    crank, yoke = m.bar("crank", p.crank), m.body("yoke", mass=p.mass)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.pin_in_slot("slot", yoke.at(0, 0, pi / 2), crank.end)
    m.prismatic("guide", m.ground.at(0, 0), yoke.at(p.guide, 0))
    m.drive_angle("motor", crank, constant_rate(p.speed))
    if p.tuned:
        wall = 2 * p.guide
        m.spring("spring", m.ground.at(wall, 0), yoke.origin, p.mass * p.speed**2, free_length=wall)
    m.start_near(crank=0, yoke=0)
    return m
