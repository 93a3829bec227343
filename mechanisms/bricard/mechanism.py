"""Bricard linkage: six equal bars with hinges at right angles, which turn inside out. SI units."""

from dataclasses import dataclass
from math import acos, cos, pi, radians, sin

import numpy as np

from mbsd.spatial import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """A bar (m), middle and swing of the driven hinge (degrees), and the speed (rad/s).

    R. Bricard, Lecons de cinematique II, 1927: cos a + cos b + cos a cos b = 0, for the turns of every other hinge.
    """

    bar: float = 0.12
    middle: float = 60.0
    swing: float = 50.0
    speed: float = pi


def build(p: Params) -> Mechanism:
    """Hinges stand as Denavit and Hartenberg place them; the bar from the sixth to the first is ground."""
    m = Mechanism("bricard", gravity=(0.0, -9.80665, 0.0))
    first = radians(p.middle)
    second = acos(-cos(first) / (1 + cos(first)))
    place, axes = np.zeros(3), np.eye(3)
    hinges = []
    for k in range(6):
        hinges.append((place, axes[:, 2]))
        turn, twist = second if k % 2 else first, -pi / 2 if k % 2 else pi / 2
        axes = axes @ np.array([[cos(turn), -sin(turn), 0], [sin(turn), cos(turn), 0], [0, 0, 1]])
        place = place + p.bar * axes[:, 0]
        axes = axes @ np.array([[1, 0, 0], [0, cos(twist), -sin(twist)], [0, sin(twist), cos(twist)]])
    bars = [m.ground, *(m.body(f"bar_{k + 1}") for k in range(5)), m.ground]
    for k, (at, axis) in enumerate(hinges):
        m.revolute(f"hinge_{k + 1}", bars[k], bars[k + 1], at=at, axis=axis)
    m.drive_turn("motor", "hinge_1", harmonic(radians(p.swing), p.speed))
    m.trace("P", "bar_3", at=hinges[3][0])
    return m
