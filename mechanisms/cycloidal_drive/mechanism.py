"""A cycloidal drive: a crank carries a lobed disc round in a ring of pins, one more than it has lobes.
Each turn of the crank turns the disc back by one lobe. The pins push the disc's outline; nothing else turns it.
"""

from dataclasses import dataclass
from math import atan2, cos, pi, sin

from mbsd import Mechanism, circle, constant_rate, spline_through

DURATION = 2.0
STIFFNESS = 2e5


@dataclass(frozen=True)
class Params:
    """Lobes, radius of the ring of pins, of a pin, and of the crank (m), turns per second, brake (N m s/rad)."""

    lobes: int = 9
    ring: float = 0.070
    pin: float = 0.008
    crank: float = 0.0045
    rate: float = 1.0
    load: float = 0.25


def disc_path(p: Params, points: int = 12) -> list[tuple[float, float]]:
    """Return points of the curve that runs on all pins: a parallel curve of an epitrochoid."""
    pins = p.lobes + 1
    path = []
    for k in range(p.lobes * points):
        a = 2 * pi * k / (p.lobes * points)
        turn = atan2(sin(-p.lobes * a), p.ring / (p.crank * pins) - cos(p.lobes * a))
        x = p.ring * cos(a) - p.pin * cos(a + turn) - p.crank * cos(pins * a)
        path.append((x, p.ring * sin(a) - p.pin * sin(a + turn) - p.crank * sin(pins * a)))
    return path


def build(p: Params) -> Mechanism:
    """The load brakes the disc; the pins are outlines of ground."""
    m = Mechanism("cycloidal_drive")
    crank, disc = m.body("crank", mass=0.1, inertia=1e-5), m.body("disc", mass=0.3, inertia=6e-4)
    m.revolute("axle", m.ground.at(0, 0), crank.origin)
    m.revolute("journal", crank.at(p.crank, 0), disc.origin)
    m.drive_angle("motor", crank, constant_rate(2 * pi * p.rate))
    m.outline(disc, [spline_through(disc_path(p))], tolerance=5e-6)
    for k in range(p.lobes + 1):
        a = 2 * pi * k / (p.lobes + 1)
        m.outline(m.ground, circle(p.pin, (p.ring * cos(a), p.ring * sin(a))), name=f"pin {k + 1}")
    m.yielding_outline_contact("mesh", disc, m.ground, STIFFNESS, exponent=1.0, damping=1.0)
    m.torsion_spring("load", m.ground, disc, 0.0, damping=p.load)
    m.trace("lobe", disc.at(p.ring - p.pin - p.crank - 0.003, 0))
    m.start_near(crank=0, disc=0)
    return m
