"""Schatz mixer: two shafts and three bars throw a vessel about, as in the Turbula. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin, sqrt

import numpy as np

from mbsd.spatial import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Bar, vessel and shafts (m), the mass of the vessel (kg), and the speed (rad/s).

    P. Schatz, Mechanism producing wavering and rotating movements of receptacles, US patent 2302804, 1942.
    """

    bar: float = 0.12
    vessel: float = 0.034
    shaft: float = 0.10
    mass: float = 0.5
    speed: float = pi


def build(p: Params) -> Mechanism:
    """Hinges stand as Denavit and Hartenberg place them; the shafts are parallel, sqrt(3) bars apart."""
    m = Mechanism("schatz_mixer")
    place, axes = np.zeros(3), np.eye(3)
    hinges = []
    for turn, length in ((0, 0.0), (150, p.bar), (0, p.bar), (-120, p.bar), (-90, 0.0), (90, sqrt(3) * p.bar)):
        hinges.append((place, axes[:, 2]))
        c, s = cos(radians(turn)), sin(radians(turn))
        axes = axes @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        place = place + length * (axes @ (1, 0, 0))
    down, middle = np.array([0.0, 0.0, -p.shaft]), (hinges[2][0] + hinges[3][0]) / 2
    bodies = [
        m.body("input", at=hinges[0][0] + down),
        m.body("arm_in", at=hinges[1][0]),
        m.ball("vessel", middle, p.vessel, p.mass),
    ]
    bodies = [m.ground, *bodies, m.body("arm_out", at=hinges[4][0]), m.body("output", at=hinges[5][0] + down), m.ground]
    for k, name in enumerate(("bearing_in", "fork_in", "hinge_in", "hinge_out", "fork_out", "bearing_out")):
        at, axis = hinges[k]
        m.revolute(name, bodies[k], bodies[k + 1], at=at + down if k in (0, 5) else at, axis=axis)
    m.drive_turn("motor", "bearing_in", constant_rate(p.speed))
    m.trace("P", "vessel", at=middle)
    return m
