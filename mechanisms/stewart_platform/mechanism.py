"""Stewart platform: six legs of changing length hold and tilt a platform. SI units."""

from dataclasses import dataclass
from math import cos, pi, radians, sin

import numpy as np

from mbsd.spatial import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """Base, platform, height, stroke (m), half the angle of a pair (degrees), and the speed.

    V. E. Gough and S. G. Whitehall, Universal tyre test machine, FISITA 1962; D. Stewart, Proc. IMechE 180, 1965.
    """

    base: float = 0.20
    platform: float = 0.13
    height: float = 0.24
    pair: float = 12.0
    stroke: float = 0.032
    speed: float = pi
    mass: float = 3.0


def build(p: Params) -> Mechanism:
    """Cylinders stand in crosses, their rods have balls on the platform; strokes follow a wave."""
    m = Mechanism("stewart_platform")
    inertia = p.mass * p.platform**2 / 4
    top = m.body("platform", p.mass, at=(0.0, 0.0, p.height), inertia=(inertia, inertia, 2 * inertia))
    for k in range(6):
        pair, way = radians(120 * (k // 2)), (-1) ** k
        low, high = pair - way * radians(p.pair), pair - way * (pi / 3 - radians(p.pair))
        foot = np.array([p.base * cos(low), p.base * sin(low), 0.0])
        head = np.array([p.platform * cos(high), p.platform * sin(high), p.height])
        along = (head - foot) / np.linalg.norm(head - foot)
        across = np.cross(along, (0, 0, 1))
        cylinder, rod = m.body(f"cylinder_{k + 1}", 0.2, tuple(foot)), m.body(f"rod_{k + 1}", 0.1, tuple(head))
        m.universal(f"cross_{k + 1}", m.ground, cylinder, at=foot, first=across, second=np.cross(along, across))
        m.prismatic(f"slide_{k + 1}", cylinder, rod, at=(foot + head) / 2, axis=along)
        m.spherical(f"ball_{k + 1}", rod, top, at=head)
        m.drive_slide(f"drive_{k + 1}", f"slide_{k + 1}", harmonic(p.stroke, p.speed, -pair))
    m.trace("P", top, at=(p.platform, 0.0, p.height))
    return m
