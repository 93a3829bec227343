"""Rolling coin: a disc with a round rim leans and rolls round a circle, without slip. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin, sqrt

from mbsd.spatial import Mechanism


@dataclass(frozen=True)
class Params:
    """Radii of ring, rim and circle (m), mass (kg), and how far the coin leans inwards (degrees)."""

    ring: float = 0.06
    rim: float = 0.005
    mass: float = 0.2
    lean: float = 20.0
    circle: float = 0.15


STEPS = 480
GRAVITY = 9.80665


def rates(p: Params) -> tuple[float, float]:
    """Return how fast it goes round and how fast it spins in its plane (rad/s): the steady motion."""
    c, s = cos(radians(p.lean)), sin(radians(p.lean))
    axial, cross = 0.5 * p.mass * p.ring**2, p.mass * (3 * p.ring**2 + 4 * p.rim**2) / 12
    spin = -(p.circle + p.ring * s) / (p.ring + p.rim * c)
    left = (axial * (spin + s) - cross * s) * c - (p.ring * c + p.rim) * p.mass * p.circle
    turn = sqrt(-p.mass * GRAVITY * p.ring * s / left)
    return turn, spin * turn


def build(p: Params) -> Mechanism:
    """The coin starts at x, its top leans towards z, the axis of its circle."""
    m = Mechanism("rolling_coin", gravity=(0.0, 0.0, -GRAVITY))
    c, s = cos(radians(p.lean)), sin(radians(p.lean))
    centre, axis = (p.circle, 0.0, p.ring * c + p.rim), (c, 0.0, s)
    coin = m.disc("coin", centre, axis, p.ring, p.mass, 2 * p.rim)
    m.rolling(
        "table", m.ground, coin, at=(0, 0, 0), normal=(0, 0, 1), centre=centre, axis=axis, ring=p.ring, radius=p.rim
    )
    turn, spin = rates(p)
    m.start_moving({"coin": (spin * c, 0.0, turn + spin * s)})
    m.trace("P", coin, at=centre)
    return m


DURATION = 2 * pi / rates(Params())[0]
