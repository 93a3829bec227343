"""A pendulum released 150 degrees from where it hangs: its weight alone moves it.
It lingers at the top of its swing and rushes through the bottom, and takes nearly twice as long as a pendulum of
small swings; the variants say how long those take.
"""

from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 4.0

VARIANTS = {
    "small": {"start": 5.0},
    "damped": {"damping": 0.02},
}


@dataclass(frozen=True)
class Params:
    """Length (m) and mass (kg) of a uniform rod, damping (N m s/rad), start (degrees), weight (m/s^2)."""

    length: float = 0.300
    mass: float = 1.0
    damping: float = 0.0
    start: float = 150.0
    gravity: float = 9.81


def build(p: Params) -> Mechanism:
    """The rod's frame begins at its pivot; hanging it stands at -90 degrees."""
    m = Mechanism("pendulum", gravity=(0.0, -p.gravity))
    rod = m.bar("rod", p.length, mass=p.mass)
    m.revolute("pivot", m.ground.at(0, 0), rod.start)
    if p.damping:
        m.torsion_spring("bearing", m.ground, rod, stiffness=0.0, damping=p.damping)
    m.trace("tip", rod.end)
    m.start_near(rod=p.start - 90.0)
    return m
