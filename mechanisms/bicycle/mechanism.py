"""Bicycle: pushed at 5 m/s it weaves and rights itself, with no hand on the bars. SI units."""

from dataclasses import dataclass
from math import cos, pi, sin

from mbsd.spatial import Mechanism


@dataclass(frozen=True)
class Params:
    """Base, trail, wheels (m), tilt of the head (rad), speed (m/s), rate of the lean (rad/s).

    J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab, Linearized dynamics equations for the balance and steer
    of a bicycle, Proc. R. Soc. A 463, 2007. Axes here are x forward and z up.
    """

    base: float = 1.02
    trail: float = 0.08
    rear: float = 0.30
    front: float = 0.35
    tilt: float = pi / 10
    speed: float = 5.0
    push: float = 0.4


DURATION = 3.0


def build(p: Params) -> Mechanism:
    """Wheels are thin discs that roll on the road z = 0; the frame has the rider's mass."""
    m = Mechanism("bicycle", gravity=(0.0, 0.0, -9.81))
    rear, front = (0.0, 0.0, p.rear), (p.base, 0.0, p.front)
    frame = m.body("frame", 85.0, com=(0.3, 0.0, 0.9), inertia=(9.2, 11.0, 2.8, 0.0, -2.4, 0.0))
    fork = m.body("fork", 4.0, com=(0.9, 0.0, 0.7), inertia=(0.05892, 0.06, 0.00708, 0.0, 0.00756, 0.0))
    rear_wheel = m.disc("rear_wheel", rear, (0, 1, 0), p.rear)
    m.set_mass("rear_wheel", 2.0, (0.0, 0.0, 0.0), (0.12, 0.0603, 0.0603))
    front_wheel = m.disc("front_wheel", front, (0, 1, 0), p.front)
    m.set_mass("front_wheel", 3.0, (0.0, 0.0, 0.0), (0.28, 0.1405, 0.1405))
    up = 0.82
    head = (p.base + p.trail - up * sin(p.tilt) / cos(p.tilt), 0.0, up)
    m.revolute("rear_axle", frame, rear_wheel, at=rear, axis=(0, 1, 0))
    m.revolute("front_axle", fork, front_wheel, at=front, axis=(0, 1, 0))
    m.revolute("head", frame, fork, at=head, axis=(-sin(p.tilt), 0.0, cos(p.tilt)))
    for name, wheel, centre, radius in (("rear", rear_wheel, rear, p.rear), ("front", front_wheel, front, p.front)):
        m.rolling(
            f"{name}_tread", m.ground, wheel, at=(0, 0, 0), normal=(0, 0, 1), centre=centre, axis=(0, 1, 0), ring=radius
        )
    m.start_moving(
        {"rear_axle": p.speed / p.rear, "front_axle": p.speed / p.front, "head": 0.0, "frame": (p.push, 0.0, 0.0)}
    )
    return m
