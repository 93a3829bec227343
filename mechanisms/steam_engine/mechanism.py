"""A steam engine: steam pushes its piston both ways, let in by a slide valve that an eccentric moves.
The valve cuts the steam off early; from then on it expands, and an indicator draws pressure over volume.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd import Mechanism, constant_rate

DURATION = 1.0


@dataclass(frozen=True)
class Params:
    """Lengths (m), pressure of the steam (Pa), angle of the eccentric ahead of the crank (degrees), speed (rad/s)."""

    crank: float = 0.04
    rod: float = 0.16
    eccentric: float = 0.014
    ahead: float = 108.0
    lap: float = 0.006
    bore: float = 0.04
    supply: float = 4e5
    speed: float = 4 * pi


def build(p: Params) -> Mechanism:
    """The crank turns evenly; its driver takes what the steam gives."""
    m = Mechanism("steam_engine")
    crank, rod, piston = m.bar("crank", p.crank), m.bar("rod", p.rod), m.body("piston")
    valve_rod, valve = m.bar("valve_rod", p.rod), m.body("valve")
    m.revolute("shaft", m.ground.at(0, 0), crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("crosshead", rod.end, piston.at(0, 0))
    m.prismatic("guide", m.ground.at(-p.rod - p.crank, 0), piston.at(0, 0))
    ahead = radians(p.ahead)
    m.revolute("eccentric", crank.at(p.eccentric * cos(ahead), p.eccentric * sin(ahead)), valve_rod.start)
    m.revolute("spindle", valve_rod.end, valve.at(0, 0))
    m.prismatic("seat", m.ground.at(-p.rod, 0.05), valve.at(0, 0))
    m.double_acting_cylinder(
        "steam", m.ground.at(-p.rod - p.crank, 0), piston.at(0, 0), p.bore, 2 * p.crank, "seat", p.supply, width=0.02,
        lap=p.lap, rod=0.01, middle=0.008,
    )  # fmt: skip
    m.start_near(crank=0, rod=180, piston=(p.crank - p.rod, 0, 0), valve_rod=160, valve=(-p.rod, 0.05, 0))
    m.drive_angle("load", crank, constant_rate(p.speed))
    return m
