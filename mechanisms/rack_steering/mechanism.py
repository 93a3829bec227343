"""Rack-and-pinion steering: the rack moves two tie rods that turn the wheels about their kingpins.
The inner wheel turns further than the outer one: at 32 degrees the outer is within 0.5 degrees of Ackermann's condition
cot(outer) - cot(inner) = track / wheelbase, by which all wheels roll about one point.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin

from mbsd import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """Lengths (m) of a car at a sixth of its size; angles in radians, the rate in rad/s."""

    track: float = 0.240  # from kingpin to kingpin
    wheelbase: float = 0.380  # to the rear axle, for Ackermann's condition alone
    arm: float = 0.045  # of the knuckles, from kingpin to tie rod
    arm_angle: float = radians(15.0)  # by which the arms point inwards
    rack: float = 0.100  # between the tie rods' inner joints
    behind: float = 0.050  # the rack lies behind the axle
    module: float = 0.0015
    teeth: int = 20  # of the pinion
    pinion: float = -0.012  # where it is along the rack
    travel: float = 0.0183  # of the rack to either side
    rate: float = pi / 2


def build(p: Params) -> Mechanism:
    """Seen from above, the car drives along y.

    Markers of the knuckles are given in the world, wheels straight.
    """
    m = Mechanism("rack_steering", gravity=None)
    pinion, rack = m.body("pinion"), m.body("rack")
    radius = p.module * p.teeth / 2
    m.prismatic("guide", m.ground.at(0, -p.behind), rack.origin)
    m.revolute("S", m.ground.at(p.pinion, -p.behind + radius), pinion.origin)
    m.rack_and_pinion("mesh", rack.origin, pinion.origin, teeth=p.teeth, module=p.module)
    m.start_near(rack=(0, -p.behind, 0), pinion=0)
    for name, side in (("left", -1), ("right", 1)):
        knuckle, rod = m.body(f"knuckle_{name}"), m.body(f"rod_{name}")
        end = (side * (p.track / 2 - p.arm * sin(p.arm_angle)), -p.arm * cos(p.arm_angle))
        inner = side * p.rack / 2, -p.behind
        m.revolute(f"K{name[0].upper()}", m.ground.at(side * p.track / 2, 0), knuckle.origin)
        m.revolute(f"outer_{name}", knuckle.at(end[0] - side * p.track / 2, end[1]), rod.origin)
        m.revolute(f"inner_{name}", rod.at(inner[0] - end[0], inner[1] - end[1]), rack.at(inner[0], 0))
        m.start_near(**{knuckle.name: 0, rod.name: (*end, 0)})
    m.drive_angle("wheel", pinion, harmonic(p.travel / radius, p.rate))
    return m
