"""Four-bar crank-rocker A-B-C-D: the crank turns, the rocker swings, P on the coupler draws. SI units."""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths between pin centres, the point P on the coupler (m), and the crank's speed (rad/s)."""

    ground: float = 0.120
    crank: float = 0.040
    coupler: float = 0.120
    rocker: float = 0.090
    tracer: tuple[float, float] = (0.060, 0.030)
    speed: float = 2 * pi


def build(p: Params) -> Mechanism:
    """The linkage; masses come from the parts."""
    m = Mechanism("four_bar")
    crank, coupler, rocker = m.bar("crank", p.crank), m.bar("coupler", p.coupler), m.bar("rocker", p.rocker)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(p.ground, 0), rocker.start)
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.trace("P", coupler.at(*p.tracer))
    m.start_near(crank=0, coupler=45, rocker=100)  # degrees; picks the assembly branch
    return m
