"""A pumpjack: the horsehead of its beam keeps the rod of the pump upright.
The bridle lies on an arc about the beam's bearing and leaves it straight down, wherever the beam stands.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths (m), mass of rod and oil (kg), turns a second."""

    crank: float = 0.06
    pitman: float = 0.24
    back: float = 0.15
    horsehead: float = 0.16
    load: float = 6.0
    speed: float = 0.25


def build(p: Params) -> Mechanism:
    """The crank turns evenly."""
    m = Mechanism("pumpjack")
    crank, pitman, beam = m.bar("crank", p.crank), m.bar("pitman", p.pitman), m.body("beam")
    rod = m.body("rod", mass=p.load, inertia=0.05)
    m.revolute("gearbox", m.ground.at(-p.back, -p.pitman), crank.start)
    m.revolute("wrist", crank.end, pitman.start)
    m.revolute("tail", pitman.end, beam.at(-p.back, 0))
    m.revolute("bearing", m.ground.at(0, 0), beam.at(0, 0))
    m.prismatic("well", m.ground.at(p.horsehead, -0.4, -pi / 2), rod.at(0, 0, -pi / 2))
    m.cable("bridle", [m.over(beam.at(0, 0), p.horsehead), rod.at(0, 0)])
    m.start_near(crank=0, pitman=90, beam=0, rod=(p.horsehead, -0.3, 0))
    m.drive_angle("motor", crank, constant_rate(2 * pi * p.speed))
    return m
