"""A leg on a bicycle: crank, shank and thigh are a four-bar between bottom bracket and hip.
The crank goes round at 60 turns a minute, so the thigh must rock: watch how fast the knee turns back at the top and how
gently at the bottom.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths between the axes (m), the seat tube's slope (degrees), cadence (turns a minute)."""

    crank: float = 0.170
    shank: float = 0.440  # the coupler, from pedal to knee
    thigh: float = 0.400  # the rocker, from hip to knee
    hip: float = 0.618  # from bottom bracket to hip: the ground link
    calf: tuple[float, float] = (0.220, 0.073)  # a point of the shank, from the pedal towards the knee and backwards
    slope: float = 73.0
    cadence: float = 60.0


def build(p: Params) -> Mechanism:
    """The rider faces right and pedals forwards, that is, clockwise."""
    m = Mechanism("four_bar_bicycle")
    crank, shank, thigh = m.bar("crank", p.crank), m.bar("shank", p.shank), m.bar("thigh", p.thigh)
    hip = m.ground.at(-p.hip * cos(radians(p.slope)), p.hip * sin(radians(p.slope)))
    m.revolute("bracket", m.ground.at(0, 0), crank.start)
    m.revolute("pedal", crank.end, shank.start)
    m.revolute("knee", shank.end, thigh.end)
    m.revolute("hip", hip, thigh.start)
    m.drive_angle("rider", crank, constant_rate(-2 * pi * p.cadence / 60, start=pi / 2))
    m.trace("calf", shank.at(*p.calf))
    m.start_near(shank=90, thigh=-20)
    return m
