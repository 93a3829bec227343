"""Sarrus linkage: two pairs of hinged plates at right angles move a platform straight up. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd.spatial import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """Length of the links (m), how far their hinges stand from the middle (m), and the swing (degrees, rad/s).

    P. T. Sarrus, Note sur la transformation des mouvements rectilignes alternatifs, Comptes rendus 36, 1853.
    """

    link: float = 0.10
    beside: float = 0.05
    middle: float = 40.0
    swing: float = 22.0
    speed: float = pi


def build(p: Params) -> Mechanism:
    """One pair of links in the x-z plane, one in the y-z plane; a lower link turns."""
    m = Mechanism("sarrus")
    out, up = p.link * cos(radians(p.middle)), p.link * sin(radians(p.middle))
    top = m.body("platform", at=(0.0, 0.0, 2 * up))
    for name, (x, y) in {"x": (1.0, 0.0), "y": (0.0, 1.0)}.items():
        axis = (-y, x, 0.0)
        foot = (p.beside * x, p.beside * y, 0.0)
        knee = ((p.beside + out) * x, (p.beside + out) * y, up)
        head = (p.beside * x, p.beside * y, 2 * up)
        lower, upper = m.body(f"lower_{name}", at=foot), m.body(f"upper_{name}", at=knee)
        m.revolute(f"foot_{name}", m.ground, lower, at=foot, axis=axis)
        m.revolute(f"knee_{name}", lower, upper, at=knee, axis=axis)
        m.revolute(f"head_{name}", upper, top, at=head, axis=axis)
    m.drive_turn("motor", "foot_x", harmonic(radians(p.swing), p.speed))
    m.trace("P", top, at=(0.0, 0.0, 2 * up))
    return m
