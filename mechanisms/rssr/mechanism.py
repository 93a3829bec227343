"""RSSR four-bar: a crank moves a rocker about an axis at right angles to its own, by a rod with balls. SI units."""

from dataclasses import dataclass
from math import pi

from mbsd.spatial import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Crank, coupler and rocker (m), the place of the rocker's axis (m), and the speed (rad/s).

    E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, 1989, section 10.3, at one fiftieth.
    """

    crank: float = 0.04
    coupler: float = 0.244
    rocker: float = 0.148
    beside: tuple[float, float] = (-0.08, -0.17)
    speed: float = pi


def build(p: Params) -> Mechanism:
    """The crank turns about x and starts upwards, the rocker about y."""
    m = Mechanism("rssr")
    x, y = p.beside
    pin, pivot = (0.0, 0.0, p.crank), (x, y, 0.0)
    end = meeting(p)
    crank = m.body("crank")
    rocker = m.body("rocker", at=pivot)
    m.revolute("shaft", m.ground, crank, at=(0, 0, 0), axis=(1, 0, 0))
    m.revolute("pivot", m.ground, rocker, at=pivot, axis=(0, 1, 0))
    m.distance("coupler", crank, rocker, start=pin, end=end, length=p.coupler)
    m.drive_turn("motor", "shaft", constant_rate(p.speed))
    m.trace("P", rocker, at=end)
    return m


def meeting(p: Params) -> tuple[float, float, float]:
    """The end of the rocker, a coupler's length from the crank's pin (0, 0, crank)."""
    x, y = p.beside
    far = (p.coupler**2 - p.rocker**2 - y**2 - x**2 - p.crank**2) / 2  # x u - crank w for an end at (x + u, y, w)
    size = x**2 + p.crank**2
    side = (p.rocker**2 * size - far**2) ** 0.5
    return x + (x * far - p.crank * side) / size, y, (-x * side - p.crank * far) / size
