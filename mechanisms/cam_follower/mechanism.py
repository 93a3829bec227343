"""Cam and follower: a disc cam lifts a valve through a law without jumps of acceleration.
A cam that only pushes needs a spring behind the valve; where it turns too fast for the spring (a variant) the valve
floats: it leaves the cam while it should slow down, and comes down hard.
"""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from mbsd import Mechanism, constant_rate
from mbsd.cams import Lift, flat_cam, oscillating_roller_cam, roller_cam

VARIANTS = {
    "flat": {"follower": "flat"},
    "oscillating": {"follower": "oscillating"},
    "valve": {"follower": "valve", "speed": 150.0, "DURATION": 0.126},
    "floating": {"follower": "valve", "speed": 210.0, "DURATION": 0.09},
}
RETAINER = (0.034, 0.105)
"""Place where the springs push on the valve: aside of its axis, and over the roller (m)."""
SPRING = 0.065
"""Length of a spring while the valve is closed (m)."""


@dataclass(frozen=True)
class Params:
    """Sizes (m), angles of lift and return (rad), speed of the cam (rad/s) and weight (m/s^2).

    ``follower`` is roller, flat, oscillating or valve; an oscillating one is lifted by an angle, ``lift`` over its arm.
    A valve (kg) is pushed on the cam by springs (N/m) that are pressed in by ``preload`` (m) when it is closed.
    """

    follower: str = "roller"
    base: float = 0.035
    roller: float = 0.012
    lift: float = 0.020
    rise: float = 2 * pi / 3
    arm: float = 0.080
    law: str = "cycloidal"
    speed: float = 2 * pi
    valve: float = 0.20
    stiffness: float = 5000.0
    preload: float = 0.014
    restitution: float = 0.2
    gravity: float = 9.81


def lift_law(p: Params) -> Lift:
    """A rise, a dwell of 60 degrees, a return as long as the rise, and a dwell; m, or rad where it swings."""
    height = p.lift / p.arm if p.follower == "oscillating" else p.lift
    rest = 2 * pi - 2 * p.rise - pi / 3
    return Lift.of((p.rise, height, p.law), (pi / 3, height), (p.rise, 0.0, p.law), (rest, 0.0))


def float_speed(p: Params) -> float:
    """Speed of the cam (rad/s), at which the spring and its weight no longer keep the valve on it."""
    lift = lift_law(p)(np.linspace(0, 2 * pi, 14401))
    falls = lift[:, 2] < 0
    push = p.stiffness * (p.preload + lift[falls, 0]) + p.valve * p.gravity
    return sqrt(float((push / (-p.valve * lift[falls, 2])).min()))


def build(p: Params) -> Mechanism:
    """The cam at the origin turns counter-clockwise; the follower above it moves up and down, or swings."""
    m = Mechanism("cam_follower", gravity=(0.0, -p.gravity))
    cam, follower = m.body("cam"), m.body("follower")
    m.revolute("O", m.ground.at(0, 0), cam.origin)
    m.drive_angle("motor", cam, constant_rate(p.speed))
    if p.follower == "oscillating":
        profile = oscillating_roller_cam(lift_law(p), p.base, p.roller, p.arm, p.arm)
        m.revolute("P", m.ground.at(p.arm, 0), follower.origin)
        m.cam_roller("contact", cam.origin, follower.at(p.arm, 0), profile)
        m.start_near(follower=145)
        return m
    start = p.base + (0.0 if p.follower == "flat" else p.roller)
    guide = start + 0.075
    m.prismatic("guide", m.ground.at(0, guide, pi / 2), follower.at(0, guide - start, pi / 2))
    if p.follower == "flat":
        m.cam_flat("contact", cam.origin, follower.at(0, 0), flat_cam(lift_law(p), p.base))
    elif p.follower == "valve":
        _push(m, p, start)
    else:
        m.cam_roller("contact", cam.origin, follower.at(0, 0), roller_cam(lift_law(p), p.base, p.roller))
    m.start_near(follower=(0, start, 0))
    return m


def _push(m: Mechanism, p: Params, start: float) -> None:
    """The cam only pushes: its roller is free to leave it, and two springs beside the stem push it back."""
    cam, valve = m.bodies["cam"], m.bodies["follower"]
    valve.mass, valve.inertia = p.valve, 1e-4
    outline = roller_cam(lift_law(p), p.base, p.roller).outline
    around = np.linspace(0, len(outline), 241)[:-1].astype(int)
    m.rigid_terrain(
        "contact", cam.origin, valve.origin, outline[around].tolist(), p.roller, closed=True, restitution=p.restitution
    )
    aside, seat = RETAINER
    for side in (-1, 1):
        fixed, moved = m.ground.at(side * aside, start + seat + SPRING), valve.at(side * aside, seat)
        m.spring(f"spring{(side + 3) // 2}", fixed, moved, p.stiffness / 2, free_length=SPRING + p.preload)
