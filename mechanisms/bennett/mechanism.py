"""Bennett linkage: four bars and four hinges, none parallel, that move all the same. SI units."""

from dataclasses import dataclass
from math import atan, cos, pi, radians, sin, tan

import numpy as np

from mbsd.spatial import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """A bar (m), both twists, the middle and the swing (degrees), and the speed (rad/s).

    G. T. Bennett, A new mechanism, Engineering 76, 1903: lengths are as the sines of twists.
    """

    bar: float = 0.10
    twist: float = 40.0
    other: float = 70.0
    middle: float = 95.0
    swing: float = 40.0
    speed: float = pi


def build(p: Params) -> Mechanism:
    """Hinges stand as Denavit and Hartenberg place them; the bar from the fourth to the first is ground."""
    m = Mechanism("bennett")
    alpha, beta, theta = radians(p.twist), radians(p.other), radians(p.middle)
    phi = 2 * atan(sin((beta + alpha) / 2) / sin((beta - alpha) / 2) / tan(theta / 2))
    long = p.bar * sin(beta) / sin(alpha)
    place, axes = np.zeros(3), np.eye(3)
    hinges = []
    for turn, length, twist in ((theta, p.bar, alpha), (phi, long, beta), (-theta, p.bar, alpha), (-phi, long, beta)):
        hinges.append((place, axes[:, 2]))
        axes = axes @ np.array([[cos(turn), -sin(turn), 0], [sin(turn), cos(turn), 0], [0, 0, 1]])
        place = place + length * axes[:, 0]
        axes = axes @ np.array([[1, 0, 0], [0, cos(twist), -sin(twist)], [0, sin(twist), cos(twist)]])
    bars = [m.ground, *(m.body(name) for name in ("crank", "coupler", "rocker")), m.ground]
    for k, (at, axis) in enumerate(hinges):
        m.revolute(f"hinge_{k + 1}", bars[k], bars[k + 1], at=at, axis=axis)
    m.drive_turn("motor", "hinge_1", harmonic(radians(p.swing), p.speed))
    m.trace("P", "coupler", at=hinges[2][0])
    return m
