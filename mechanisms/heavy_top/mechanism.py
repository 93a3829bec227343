"""Heavy symmetric top: it spins on a ball, leans over, and precesses and nods under its weight. SI units."""

from dataclasses import dataclass
from math import cos, radians, sin

from mbsd.spatial import Mechanism


@dataclass(frozen=True)
class Params:
    """The disc (m, kg), its distance from the ball (m), how far it leans (degrees), and its spin (rad/s)."""

    radius: float = 0.05
    thickness: float = 0.012
    mass: float = 0.5
    stem: float = 0.07
    lean: float = 30.0
    spin: float = 300.0


DURATION = 2.0


def build(p: Params) -> Mechanism:
    """The tip stands at the origin; the top leans towards x and starts without precession."""
    m = Mechanism("heavy_top")
    axis = (sin(radians(p.lean)), 0.0, cos(radians(p.lean)))
    centre = tuple(p.stem * part for part in axis)
    top = m.disc("top", centre, axis, p.radius, p.mass, p.thickness)
    m.spherical("tip", m.ground, top, at=(0.0, 0.0, 0.0))
    m.start_moving({"top": tuple(p.spin * part for part in axis)})
    m.trace("P", top, at=tuple(1.25 * part for part in centre))
    return m
