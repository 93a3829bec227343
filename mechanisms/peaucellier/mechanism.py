"""Peaucellier's straight line of 1864: seven bars, no slide, and an end that runs exactly straight.
Two long bars and a rhombus invert the circle of the crank's pin, which goes through the fixed pivot, into a line.
"""

from dataclasses import dataclass

from mbsd import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """Lengths between pin centres (m), swing of the crank (rad), its rate (rad/s)."""

    long: float = 0.160
    side: float = 0.070  # of the rhombus
    crank: float = 0.050  # and the distance of its pivot from that of the long bars
    swing: float = 0.80
    rate: float = 1.5707963267948966


def build(p: Params) -> Mechanism:
    """The long bars turn about the origin; P runs along x = (long^2 - side^2) / (2 crank)."""
    m = Mechanism("peaucellier")
    upper, lower, crank = m.bar("upper", p.long), m.bar("lower", p.long), m.bar("crank", p.crank)
    inner = m.bar("inner_upper", p.side), m.bar("inner_lower", p.side)
    outer = m.bar("outer_upper", p.side), m.bar("outer_lower", p.side)
    m.revolute("O_upper", m.ground.at(0, 0), upper.start)
    m.revolute("O_lower", m.ground.at(0, 0), lower.start)
    m.revolute("crank_pivot", m.ground.at(p.crank, 0), crank.start)
    for side, long, near, far in zip(("upper", "lower"), (upper, lower), inner, outer, strict=True):
        m.revolute(f"Q_{side}", crank.end, near.start)
        m.revolute(f"near_{side}", near.end, long.end)
        m.revolute(f"far_{side}", long.end, far.start)
    m.revolute("P", outer[0].end, outer[1].end)
    m.drive_angle("motor", crank, harmonic(p.swing, p.rate))
    m.trace("P", outer[0].end)
    m.start_near(upper=22, lower=-22, inner_upper=58, inner_lower=-58, outer_upper=-58, outer_lower=58)
    return m
