"""A slider-crank: the crank turns evenly, the rod takes the slider to and fro.
The slider spends less than half a turn on the outer half of its stroke, because the rod leans. Gravity acts across
the guide: it leaves the motion as it is, but the motor must lift crank and rod and is paid back on the way down.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate

# The same mechanism with other values: make run-slider-crank-offset, make compare-slider-crank.
VARIANTS = {
    "offset": {"offset": 0.020},
    "no_gravity": {"gravity": 0.0},
}


@dataclass(frozen=True)
class Params:
    """Lengths between pin centres (m), speed (rad/s), weight (m/s^2)."""

    crank: float = 0.040
    rod: float = 0.120
    offset: float = 0.0  # height of the slider's line above the crank's pivot
    speed: float = 2 * pi
    gravity: float = 9.81


def build(p: Params) -> Mechanism:
    """Crank on ground, rod, slider in its guide."""
    m = Mechanism("slider_crank", gravity=(0.0, -p.gravity))
    crank, rod, slider = m.bar("crank", p.crank), m.bar("rod", p.rod), m.body("slider")
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, p.offset), slider.origin)
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.trace("M", rod.at(p.rod / 2, 0))
    m.start_near(crank=0, rod=0, slider=0)
    return m
