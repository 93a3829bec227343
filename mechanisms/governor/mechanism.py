"""Governor: two balls swing out as their spindle speeds up, and lift a sleeve. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd.spatial import Mechanism, function


@dataclass(frozen=True)
class Params:
    """Arm, link, pivot beside the spindle (m), masses (kg), the damper (N s/m), speeds (rad/s).

    The speed swings about its mean at the rate ``slow``; ``lean`` is that of the arms at the start (degrees).
    """

    arm: float = 0.16
    link: float = 0.08
    beside: float = 0.03
    ball: float = 0.4
    rod: float = 0.01
    sleeve: float = 0.05
    damper: float = 4.0
    mean: float = 9.0
    swing: float = 1.3
    slow: float = pi / 3
    lean: float = 42.0


DURATION = 12.0


def build(p: Params) -> Mechanism:
    """The spindle turns about z; arms and links are those of a rhombus, cut by the spindle."""
    m = Mechanism("governor")
    out, down = p.link * sin(radians(p.lean)), p.link * cos(radians(p.lean))
    spindle = m.shaft("spindle", (0.0, 0.0, -2.9 * p.link), (0.0, 0.0, 0.1 * p.link), 0.1 * p.beside, mass=0.1)
    sleeve = m.body("sleeve", p.sleeve, inertia=(1e-5, 1e-5, 1e-5), at=(0.0, 0.0, -2 * down))
    m.revolute("bearing", m.ground, spindle, at=(0.0, 0.0, -2.6 * p.link), axis=(0, 0, 1))
    m.cylindrical("slide", spindle, sleeve, at=(0.0, 0.0, -2 * down), axis=(0, 0, 1))
    for side, way in (("left", -1.0), ("right", 1.0)):
        pivot, knee = (way * p.beside, 0.0, 0.0), (way * (p.beside + out), 0.0, -down)
        foot = (way * p.beside, 0.0, -2 * down)
        tip = (way * (p.beside + out * p.arm / p.link), 0.0, -down * p.arm / p.link)
        arm = m.body(f"arm_{side}", p.ball, inertia=(1e-4, 1e-4, 1e-4), at=tip)
        half = ((knee[0] + foot[0]) / 2, 0.0, -1.5 * down)
        link = m.body(f"link_{side}", p.rod, inertia=(5e-6, 5e-6, 5e-6), at=half)
        m.revolute(f"pivot_{side}", arm, spindle, at=pivot, axis=(0, 1, 0))
        m.revolute(f"knee_{side}", arm, link, at=knee, axis=(0, 1, 0))
        m.revolute(f"foot_{side}", sleeve, link, at=foot, axis=(0, 1, 0))
    m.drag("damper", sleeve, p.damper)
    turn = function(
        lambda t: p.mean * t - p.swing / p.slow * sin(p.slow * t),
        lambda t: p.mean - p.swing * cos(p.slow * t),
        lambda t: p.swing * p.slow * sin(p.slow * t),
    )
    m.drive_turn("motor", "bearing", turn)
    return m
