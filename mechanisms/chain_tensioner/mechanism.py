"""A chain drive with a tensioner: the wheel swings, and a sprung arm keeps the chain tight.
The chain has one length. As the swing arm moves the large sprocket, the small one on the tensioner gives way.
"""

from dataclasses import dataclass
from math import pi, radians

from mbsd import Mechanism, constant_rate, harmonic


@dataclass(frozen=True)
class Params:
    """Radii of the sprockets and lengths of the arms (m), stiffness of the spring (N m/rad)."""

    driver: float = 0.03
    wheel: float = 0.055
    idler: float = 0.02
    swing: float = 0.22
    arm: float = 0.08
    stiffness: float = 2.0


def build(p: Params) -> Mechanism:
    """The driver turns evenly while the swing arm goes up and down."""
    m = Mechanism("chain_tensioner")
    driver, wheel, idler = m.body("driver"), m.body("wheel", mass=0.3, inertia=5e-4), m.body("idler")
    swing, arm = m.bar("swing", p.swing), m.bar("arm", p.arm)
    m.revolute("axle", m.ground.at(0, 0), driver.at(0, 0))
    m.revolute("pivot", m.ground.at(0.05, 0.03), swing.start)
    m.revolute("hub", swing.end, wheel.at(0, 0))
    m.revolute("hinge", m.ground.at(0.07, -0.01), arm.start)
    m.revolute("tension", arm.end, idler.at(0, 0))
    way = [m.over(driver.at(0, 0), p.driver), m.over(wheel.at(0, 0), p.wheel)]
    m.cable("chain", [*way, m.over(idler.at(0, 0), p.idler)], closed=True)
    m.torsion_spring("spring", m.ground, arm, stiffness=p.stiffness, free_angle=radians(-120))
    m.start_near(swing=0, arm=-45)
    m.drive_angle("motor", driver, constant_rate(-2 * pi))
    m.drive_angle("road", swing, harmonic(radians(8), 2 * pi))
    return m
