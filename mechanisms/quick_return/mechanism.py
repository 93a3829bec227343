"""The quick return of a shaper: a crank's pin runs in the slot of a long arm, which pushes the ram.
The crank turns evenly, yet the ram cuts slowly and comes back fast: the arm swings back while the crank passes the
short arc near the arm's pivot.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths between axes (m) and the crank's speed (rad/s)."""

    crank: float = 0.040
    height: float = 0.100  # of the crank's axis above the arm's
    arm: float = 0.200
    link: float = 0.080
    ram: float = 0.192  # height of the ram's line above the arm's axis
    speed: float = pi / 2


def build(p: Params) -> Mechanism:
    """The arm stands upright on its pivot at the origin."""
    m = Mechanism("quick_return")
    crank, arm, link = m.bar("crank", p.crank), m.bar("arm", p.arm), m.bar("link", p.link)
    ram = m.body("ram")
    m.revolute("pivot", m.ground.at(0, 0), arm.start)
    m.revolute("shaft", m.ground.at(0, p.height), crank.start)
    m.pin_in_slot("slot", arm.start, crank.end)
    m.revolute("top", arm.end, link.start)
    m.revolute("wrist", link.end, ram.origin)
    m.prismatic("guide", m.ground.at(0, p.ram), ram.origin)
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.start_near(crank=0, arm=70, link=0, ram=0)
    return m
