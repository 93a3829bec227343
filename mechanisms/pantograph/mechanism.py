"""A pantograph: four bars round a parallelogram, one end of them pinned to the table.
Its small stylus is led along a heart, and the pen at the far end draws the same heart enlarged.
"""

from dataclasses import dataclass
from math import cos, pi, sin

from mbsd import Mechanism, function


@dataclass(frozen=True)
class Params:
    """Lengths (m), the scale of the copy, time of one heart (s)."""

    arm: float = 0.160  # both long bars
    scale: float = 2.5
    centre: tuple[float, float] = (0.075, 0.012)  # of the small heart, from the fixed pivot
    size: float = 0.0009  # of the small heart; it is 32 of these wide
    time: float = 4.0


def build(p: Params) -> Mechanism:
    """Stylus and pen are in line with the fixed pivot, at distances 1 : scale."""
    m = Mechanism("pantograph", gravity=None)
    short, rest, turn = p.arm / p.scale, p.arm - p.arm / p.scale, 2 * pi / p.time
    first, second = m.bar("first", p.arm), m.bar("second", p.arm)
    low, high = m.bar("low", short), m.bar("high", rest)
    m.revolute("O", m.ground.at(0, 0), first.start)
    m.revolute("A", first.at(short, 0), low.start)
    m.revolute("B", first.end, second.start)
    m.revolute("C", second.at(short, 0), high.start)
    m.revolute("stylus", high.end, low.end)

    def x(t: float) -> float:
        return p.centre[0] + p.size * 16 * sin(turn * t) ** 3

    def y(t: float) -> float:
        s = turn * t
        return p.centre[1] + p.size * (13 * cos(s) - 5 * cos(2 * s) - 2 * cos(3 * s) - cos(4 * s))

    m.drive_coordinate("x", m.ground.origin, low.end, function(x, period=p.time))
    m.drive_coordinate("y", m.ground.at(0, 0, pi / 2), low.end, function(y, period=p.time))
    m.trace("drawn", low.end)
    m.trace("copy", second.end)
    m.start_near(first=80, second=-60, low=-60, high=-100)
    return m
