"""Spatial slider-crank: a crank that turns about x moves a slider along x by a rod with two balls. SI units."""

from dataclasses import dataclass
from math import pi, sqrt

from mbsd.spatial import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Crank, rod, and the place of the crank's axis beside the slider (m), the slider (kg), and the speed (rad/s).

    E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, 1989, section 10.2.
    """

    crank: float = 0.08
    rod: float = 0.30
    beside: tuple[float, float] = (0.10, 0.12)
    slider: float = 0.5
    speed: float = 2 * pi


def build(p: Params) -> Mechanism:
    """The crank starts at z above its axis; the rod is massless."""
    m = Mechanism("spatial_slider_crank")
    y, z = p.beside
    pin = (0.0, y, z + p.crank)
    start = (sqrt(p.rod**2 - y**2 - (z + p.crank) ** 2), 0.0, 0.0)
    crank = m.body("crank", at=(0.0, y, z))
    slider = m.body("slider", mass=p.slider, inertia=(2e-4, 2e-4, 2e-4), at=start)
    m.revolute("shaft", m.ground, crank, at=(0.0, y, z), axis=(1, 0, 0))
    m.distance("rod", crank, slider, start=pin, end=start, length=p.rod)
    m.prismatic("guide", m.ground, slider, at=(start[0], 0.0, -0.06), axis=(1, 0, 0))
    m.drive_turn("motor", "shaft", constant_rate(p.speed))
    m.trace("pin", crank, at=pin)
    return m
