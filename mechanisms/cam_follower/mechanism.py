"""Cam and follower: a disc cam lifts a valve through a law without jumps of acceleration. SI units."""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, flat_cam, oscillating_roller_cam, roller_cam


@dataclass(frozen=True)
class Params:
    """Sizes (m), angles of the cam over which it lifts and lowers (rad), the cam's speed (rad/s).

    ``follower`` is roller, flat or oscillating; an oscillating one is lifted by an angle, ``lift`` over its arm.
    """

    follower: str = "roller"
    base: float = 0.035
    roller: float = 0.012
    lift: float = 0.020
    rise: float = 2 * pi / 3
    arm: float = 0.080
    law: str = "cycloidal"
    speed: float = 2 * pi


VARIANTS = {
    "flat": {"follower": "flat"},
    "oscillating": {"follower": "oscillating"},
}


def lift_law(p: Params) -> Lift:
    """A rise, a dwell of 60 degrees, a return as long as the rise, and a dwell; m, or rad where it swings."""
    height = p.lift / p.arm if p.follower == "oscillating" else p.lift
    rest = 2 * pi - 2 * p.rise - pi / 3
    return Lift.of((p.rise, height, p.law), (pi / 3, height), (p.rise, 0.0, p.law), (rest, 0.0))


def build(p: Params) -> Mechanism:
    """The cam at the origin turns counter-clockwise; the follower above it moves up and down, or swings."""
    m = Mechanism("cam_follower")
    cam, follower = m.body("cam"), m.body("follower")
    m.revolute("O", m.ground.at(0, 0), cam.origin)
    m.drive_angle("motor", cam, constant_rate(p.speed))
    if p.follower == "oscillating":
        profile = oscillating_roller_cam(lift_law(p), p.base, p.roller, p.arm, p.arm)
        m.revolute("P", m.ground.at(p.arm, 0), follower.origin)
        m.cam_roller("contact", cam.origin, follower.at(p.arm, 0), profile)
        m.start_near(follower=145)
        return m
    start = p.base + (p.roller if p.follower == "roller" else 0.0)
    guide = start + 0.075
    m.prismatic("guide", m.ground.at(0, guide, pi / 2), follower.at(0, guide - start, pi / 2))
    if p.follower == "flat":
        m.cam_flat("contact", cam.origin, follower.at(0, 0), flat_cam(lift_law(p), p.base))
    else:
        m.cam_roller("contact", cam.origin, follower.at(0, 0), roller_cam(lift_law(p), p.base, p.roller))
    m.start_near(follower=(0, start, 0))
    return m
