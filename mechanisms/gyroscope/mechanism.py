"""Gyroscope: a disc that spins on a beam makes it precess instead of fall. SI units."""

from dataclasses import dataclass
from math import pi

from mbsd.spatial import Mechanism


@dataclass(frozen=True)
class Params:
    """Disc (m, kg) and its arm (m), counterweight (kg) and its arm (m), and the spin (rad/s).

    The counterweight is too light, so the disc's side would sink.
    """

    radius: float = 0.06
    thickness: float = 0.014
    mass: float = 1.2
    arm: float = 0.10
    weight: float = 0.9
    back: float = 0.11
    height: float = 0.12
    spin: float = 60 * pi


DURATION = 6.0


def precession(p: Params) -> float:
    """Return the rate at which the level beam turns (rad/s): torque over momentum."""
    torque = 9.80665 * (p.mass * p.arm - p.weight * p.back)
    return torque / (0.5 * p.mass * p.radius**2 * p.spin)


def build(p: Params) -> Mechanism:
    """The beam lies along x on a hinge; its spindle turns about z."""
    m = Mechanism("gyroscope")
    spindle = m.body("spindle", 0.1, at=(0.0, 0.0, -p.height), inertia=(2e-5, 2e-5, 2e-5))
    beam = m.body("beam", p.weight, com=(-p.back, 0.0, 0.0), inertia=(4e-4, 4e-4, 4e-4))
    disc = m.disc("disc", (p.arm, 0.0, 0.0), (1, 0, 0), p.radius, p.mass, p.thickness)
    m.revolute("post", m.ground, spindle, at=(0.0, 0.0, -p.height), axis=(0, 0, 1))
    m.revolute("hinge", spindle, beam, at=(0, 0, 0), axis=(0, 1, 0))
    m.revolute("axle", beam, disc, at=(p.arm, 0.0, 0.0), axis=(1, 0, 0))
    m.start_moving({"post": precession(p), "hinge": 0.0, "axle": p.spin})
    m.trace("P", disc, at=(p.arm, 0.0, 0.0))
    return m
