"""A cam swings an arm: its flat shoe lies on the disc, and a spring at the arm's end keeps it there.
The point of contact wanders to and fro along the shoe, and the tip draws the arc that the law prescribes: a rise, a
dwell and a return.
"""

from dataclasses import dataclass
from math import asin, cos, degrees, pi, radians, sin

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, oscillating_flat_cam, oscillating_roller_cam

VARIANTS = {
    "roller": {"follower": "roller"},
    "quick_return": {"rise": 2.5, "fall": 1.8, "swing": 11.0},
}


@dataclass(frozen=True)
class Params:
    """Sizes (m), swing (degrees), angles of rise, dwell and return (rad), spring, rate (rad/s).

    ``follower`` is flat or roller.
    """

    follower: str = "flat"
    base: float = 0.030
    roller: float = 0.012
    pivot: float = 0.100  # from the cam's shaft
    tip: float = 0.170  # of the arm, from its pivot
    swing: float = 16.0
    rise: float = 2.1
    dwell: float = 0.6
    fall: float = 2.1
    law: str = "modified_sine"
    mass: float = 0.20
    stiffness: float = 600.0
    preload: float = 0.010
    speed: float = 2 * pi


def lift_law(p: Params) -> Lift:
    """Angle of the arm above where it rests (rad)."""
    rest, top = 2 * pi - p.rise - p.dwell - p.fall, radians(p.swing)
    return Lift.of((p.rise, top, p.law), (p.dwell, top), (p.fall, 0.0, p.law), (rest, 0.0))


def build(p: Params) -> Mechanism:
    """The cam turns about the origin.

    The arm's pivot is right of it, and its axis runs from the pivot over the cam.
    """
    m = Mechanism("cam_follower_angular")
    cam, arm = m.body("cam"), m.body("arm", p.mass, (p.tip / 2, 0.0), p.mass * p.tip**2 / 12)
    m.revolute("O", m.ground.at(0, 0), cam.origin)
    m.revolute("P", m.ground.at(p.pivot, 0), arm.origin)
    m.drive_angle("motor", cam, constant_rate(p.speed))
    if p.follower == "flat":
        profile = oscillating_flat_cam(lift_law(p), p.base, p.pivot)
        m.cam_flat("contact", cam.origin, arm.at(0, 0, pi), profile)
        rest = asin(p.base / p.pivot)
    else:
        profile = oscillating_roller_cam(lift_law(p), p.base, p.roller, p.pivot, p.pivot)
        m.cam_roller("contact", cam.origin, arm.at(p.pivot, 0), profile)
        rest = 2 * asin((p.base + p.roller) / (2 * p.pivot))
    angle = pi - rest
    x, y = p.pivot + p.tip * cos(angle), p.tip * sin(angle)
    below = m.ground.at(x, y - 0.09)
    m.spring("spring", below, arm.at(p.tip, 0), p.stiffness, free_length=0.09 - p.preload)
    m.trace("tip", arm.at(p.tip, 0))
    m.start_near(arm=degrees(angle))
    return m
