"""A scotch yoke: the crank's pin runs in a slot across the yoke, which moves exactly as a cosine.
With a spring against the yoke that is in tune with the crank (variant spring), the motor need not shake the yoke any
more: the spring does. Without a motor (free) a harder spring speeds the crank up twice a turn and slows it down again.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate

VARIANTS = {
    "spring": {"tuned": True},
    "free": {"tuned": True, "tune": 1.6, "driven": False, "DURATION": 4.0},
}


@dataclass(frozen=True)
class Params:
    """Lengths (m), mass of the yoke (kg) and speed (rad/s).

    ``tuned`` adds a spring of tune * mass * speed^2.
    """

    crank: float = 0.040
    guide: float = 0.140  # from the slot to the block in the guide
    beyond: float = 0.060  # from there to the spring
    rest: float = 0.120  # free length of the spring
    mass: float = 0.5
    speed: float = 2 * pi
    flywheel: float = 1.0e-3  # inertia of the balanced crank where nothing drives it (kg m^2)
    tune: float = 1.0
    tuned: bool = False
    driven: bool = True  # else it starts with its speed


def build(p: Params) -> Mechanism:
    """It lies flat, so weights do not count. The yoke slides along x; its slot stands along y."""
    m = Mechanism("scotch_yoke", gravity=None)
    yoke = m.body("yoke", mass=p.mass)
    crank = m.bar("crank", p.crank) if p.driven else m.bar("crank", p.crank, 0.5, com=(0, 0), inertia=p.flywheel)
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.pin_in_slot("slot", yoke.at(0, 0, pi / 2), crank.end)
    m.prismatic("guide", m.ground.at(0, 0), yoke.at(p.guide, 0))
    if p.driven:
        m.drive_angle("motor", crank, constant_rate(p.speed))
    else:
        m.start_moving(crank=p.speed)
    if p.tuned:
        end, stiffness = p.guide + p.beyond, p.tune * p.mass * p.speed**2
        m.spring("spring", m.ground.at(end + p.rest, 0), yoke.at(end, 0), stiffness, free_length=p.rest)
    m.start_near(crank=0, yoke=0)
    return m
