"""A slider-crank in reverse: the slider's motion is given, the torque at the crank is computed.
The slider rests, moves out and comes back softly; a motor on the crank makes it do so.
"""

from dataclasses import dataclass
from math import cos, pi
from typing import TYPE_CHECKING

from mbsd import Mechanism, function

if TYPE_CHECKING:  # a result loads the compiler
    from mbsd import Solution


@dataclass(frozen=True)
class Params:
    """Lengths (m), masses (kg), the slider's places (m), the time of out and back (s)."""

    crank: float = 0.040
    rod: float = 0.110
    masses: tuple[float, float, float] = (0.15, 0.20, 0.40)  # crank, rod, slider
    near: float = 0.090
    far: float = 0.140
    time: float = 2.0


def build(p: Params) -> Mechanism:
    """Crank, rod and slider; the driver gives the motion, the torque its effort."""
    m = Mechanism("inverse_slider_crank")
    crank, rod = m.bar("crank", p.crank, mass=p.masses[0]), m.bar("rod", p.rod, mass=p.masses[1])
    slider = m.body("slider", mass=p.masses[2])
    m.revolute("O", m.ground.at(0, 0), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0), slider.origin)
    m.drive_coordinate("wish", m.ground.at(0, 0), slider.origin, function(lambda t: place(p, t), period=p.time))
    m.torque("motor", crank, 0.0)
    m.start_near(crank=90, rod=-20, slider=0)
    return m


def place(p: Params, t: float) -> float:
    """A soft rise and return: the square of a sine, squared."""
    return p.near + (p.far - p.near) * ((1 - cos(2 * pi * t / p.time)) / 2) ** 2


def motion(m: Mechanism, p: Params) -> "Solution":
    """The sweep with the motor's torque in place of the driver's force."""
    return m.inverse_dynamics(m.sweep(), ["motor"]).solution
