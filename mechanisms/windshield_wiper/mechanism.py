"""The two wipers of a windscreen: a motor's rod rocks the first wiper, a bar takes the second along.
The four-bar of motor, rod and lever makes the swing; the bar between the levers is a parallelogram, so both blades stay
parallel.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Lengths between axes (m), speed (rad/s), the angle between a wiper and its lever (degrees)."""

    crank: float = 0.042
    rod: float = 0.250
    lever: float = 0.060
    span: float = 0.420  # between the wipers' pivots
    motor: tuple[float, float] = (0.250, -0.060)
    wiper: float = 0.320
    between: float = 165.0
    speed: float = pi


def build(p: Params) -> Mechanism:
    """The origin is the first wiper's pivot; a wiper's frame has its x axis along the blade."""
    m = Mechanism("windshield_wiper")
    crank, rod, bar = m.bar("crank", p.crank), m.bar("rod", p.rod), m.bar("bar", p.span)
    m.revolute("motor_shaft", m.ground.at(*p.motor), crank.start)
    m.revolute("A", crank.end, rod.start)
    for k, name in enumerate(("first", "second")):
        wiper = m.body(name)
        lever = wiper.at(p.lever * cos(radians(p.between)), -p.lever * sin(radians(p.between)))
        m.revolute(f"pivot_{name}", m.ground.at(k * p.span, 0), wiper.origin)
        m.revolute(f"bar_{name}", bar.end if k else bar.start, lever)
        if k == 0:
            m.revolute("B", rod.end, lever)
        m.trace(f"tip_{name}", wiper.at(p.wiper, 0))
    m.drive_angle("motor", crank, constant_rate(p.speed))
    m.start_near(rod=180, bar=0, first=75, second=75)
    return m
