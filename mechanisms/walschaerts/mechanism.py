"""A locomotive's engine with Walschaerts gear, which adds two motions to that of its valve.
The crosshead gives lap and lead by a lever; the return crank swings a link. The lower the radius rod hangs in the link,
the longer steam is let in, and above its trunnion the engine runs astern.
"""

from dataclasses import dataclass
from math import atan2, cos, degrees, hypot, pi, sin, sqrt

from mbsd import Mechanism, constant_rate

DURATION = 1.0


@dataclass(frozen=True)
class Params:
    """Lengths (m), among them how low the radius rod hangs; pressure of the steam (Pa), speed (rad/s)."""

    crank: float = 0.05
    rod: float = 0.2
    stem: float = 0.15
    eccentric: float = 0.018
    gear: float = 0.035
    lap: float = 0.0065
    bore: float = 0.045
    supply: float = 4e5
    speed: float = 4 * pi


def build(p: Params) -> Mechanism:
    """The crank turns evenly; its driver takes what the steam gives."""
    m = Mechanism("walschaerts")
    x, link_x, link_y, foot, top, hang, sling = -p.rod - p.crank, -0.12, 0.09, 0.055, 0.022, 0.065, 0.04
    to_foot, length = hypot(link_x, link_y - foot), hypot(x - link_x, p.gear)
    ahead, slope = atan2(link_y - foot, link_x) - pi / 2, degrees(atan2(p.gear, x - link_x))
    low = p.gear * (1 - sling / (link_x - x))  # of the sling below the trunnion
    crank, rod, crosshead = m.bar("crank", p.crank), m.bar("rod", p.rod), m.body("crosshead")
    piston_rod, piston = m.bar("piston_rod", p.stem), m.body("piston")
    eccentric_rod, link = m.bar("eccentric_rod", hypot(to_foot, p.eccentric)), m.body("link")
    radius_rod, hanger = m.bar("radius_rod", length), m.bar("hanger", hang)
    lever, union, valve = m.body("lever"), m.bar("union", 0.05), m.body("valve")
    m.revolute("shaft", m.ground.at(0, 0), crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, crosshead.at(0, 0))
    m.prismatic("guide", m.ground.at(x, 0), crosshead.at(0, 0))
    m.revolute("cotter", crosshead.at(-0.02, 0), piston_rod.start)
    m.revolute("stem", piston_rod.end, piston.at(0, 0))
    m.prismatic("cylinder", m.ground.at(x - 0.02 - p.stem, 0), piston.at(0, 0))
    m.revolute("return_crank", crank.at(p.eccentric * cos(ahead), p.eccentric * sin(ahead)), eccentric_rod.start)
    m.revolute("foot", eccentric_rod.end, link.at(0, -foot))
    m.revolute("trunnion", m.ground.at(link_x, link_y), link.at(0, 0))
    slot = [(x - link_x + sqrt(length**2 - y**2), y) for y in (0.0075 * k for k in range(-6, 7))]
    m.point_on_curve("die", link.at(0, 0), radius_rod.start, slot)
    m.revolute("lift", m.ground.at(link_x - sling, link_y + hang - low), hanger.start)
    m.revolute("sling", hanger.end, radius_rod.at(sling, 0))
    m.revolute("front", radius_rod.end, lever.at(0, 0))
    m.revolute("drop", lever.at(0, -0.14), union.end)
    m.revolute("arm", crosshead.at(0, -0.05), union.start)
    m.revolute("spindle", lever.at(0, top), valve.at(0, 0))
    m.prismatic("seat", m.ground.at(x, link_y + top), valve.at(0, 0))
    m.double_acting_cylinder(
        "steam", m.ground.at(x - 0.02 - p.stem, 0), piston.at(0, 0), p.bore, 2 * p.crank, "seat", p.supply, width=0.02,
        lap=p.lap, rod=0.01,
    )  # fmt: skip
    m.start_near(crank=0, rod=180, crosshead=(p.crank - p.rod, 0, 0), piston_rod=180, eccentric_rod=164)
    m.start_near(piston=(p.crank - p.rod - p.stem, 0, 0), link=(link_x, link_y, 0), radius_rod=slope, hanger=-90)
    m.start_near(lever=(x, link_y, 10), union=180, valve=(x, link_y + top, 0))
    m.drive_angle("load", crank, constant_rate(p.speed))
    return m
