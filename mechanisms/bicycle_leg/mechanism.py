"""A leg that pedals: the muscles of hip and knee drive thigh and shank, and these drive the crank.
The bicycle keeps 60 turns a minute, and what it takes from the leg is the torque at the crank: large where the leg
stretches, and below zero while the muscles rest and the leg has to be lifted.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd import Mechanism, constant_rate
from mbsd.machines.body.figure import Figure

SPECTRA = ("bicycle",)
VARIANTS = {"no_muscles": {"strength": 0.0}}


@dataclass(frozen=True)
class Params:
    """Sizes of bicycle and rider, cadence and muscles.

    Lengths between the axes (m), slope of the seat tube and angle between shank and sole (degrees), cadence (turns a
    minute), mass (kg) and height (m) of the rider, from which the leg's lengths and masses follow.

    Muscles: peak (N m) of a pulse of torque between two places of the crank (degrees from the top of its turn). They do
    the work that M. O. Ericson et al. measured (Eur. J. Appl. Physiol. 55, 1986: 120 W, 60 turns a minute); that of the
    ankle is left out.
    """

    crank: float = 0.170
    hip: float = 0.618
    calf: tuple[float, float] = (0.220, 0.073)
    slope: float = 73.0
    cadence: float = 60.0
    rider: float = 75.0
    height: float = 1.62
    ankle: float = 72.0
    crank_mass: float = 0.7
    hip_extensors: tuple[float, float, float] = (28.6, 20.0, 190.0)
    hip_flexors: tuple[float, float, float] = (6.1, 250.0, 365.0)
    knee_extensors: tuple[float, float, float] = (29.4, -20.0, 160.0)
    knee_flexors: tuple[float, float, float] = (7.66, 165.0, 340.0)
    strength: float = 1.0  # of all muscles together

    @property
    def figure(self) -> Figure:
        """The rider."""
        return Figure(self.height, self.rider)

    @property
    def thigh(self) -> float:
        """From the hip to the knee (m)."""
        return self.figure.length("thigh")

    @property
    def shank(self) -> float:
        """From the knee to the ball of the foot, which is on the pedal (m)."""
        return self.figure.lower_leg(radians(self.ankle))[0]


def build(p: Params) -> Mechanism:
    """The rider faces right and pedals clockwise; the foot is stiff on the shank."""
    m = Mechanism("bicycle_leg", gravity=(0.0, -9.81))
    crank = m.bar("crank", p.crank, mass=p.crank_mass)
    _, lower = p.figure.lower_leg(radians(p.ankle))
    upper = p.figure.limb("thigh").times(0.5)  # of one side
    thigh = m.bar("thigh", p.thigh, upper.mass, upper.com, upper.inertia)
    shank = m.bar("shank", p.shank, lower.mass, lower.com, lower.inertia)
    hip = m.ground.at(-p.hip * cos(radians(p.slope)), p.hip * sin(radians(p.slope)))
    m.revolute("bracket", m.ground.at(0, 0), crank.start)
    m.revolute("pedal", crank.end, shank.start)
    m.revolute("knee", shank.end, thigh.end)
    m.revolute("hip", hip, thigh.start)
    m.drive_angle("bicycle", crank, constant_rate(-2 * pi * p.cadence / 60, start=pi / 2))
    # The hip stretches where the thigh turns clockwise, the knee where the shank turns counter-clockwise against it.
    m.trace("calf", shank.at(*p.calf))
    m.torque("hip_extensors", thigh, pulse(p, *p.hip_extensors, -1))
    m.torque("hip_flexors", thigh, pulse(p, *p.hip_flexors, 1))
    m.torque("knee_extensors", shank, pulse(p, *p.knee_extensors, 1), against=thigh)
    m.torque("knee_flexors", shank, pulse(p, *p.knee_flexors, -1), against=thigh)
    m.start_near(shank=90, thigh=-20)
    return m


def pulse(p: Params, peak: float, start: float, end: float, sign: int) -> Callable[[float], float]:
    """A smooth pulse of torque (N m) while the crank goes from ``start`` to ``end`` degrees after its top."""

    def torque(t: float) -> float:
        turned = (360 * p.cadence / 60 * t - start) % 360
        width = end - start
        return sign * p.strength * peak * sin(pi * turned / width) ** 2 if turned < width else 0.0

    return torque
