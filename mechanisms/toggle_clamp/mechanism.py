"""A toggle clamp: the handle brings its pin and the link into line, and the arm presses on the work.
Shortly past that line the clamp holds by itself: the workpiece pushes with 100 N, yet the handle needs no hand, and
opens only when it is lifted.
"""

from dataclasses import dataclass
from math import acos, atan2, hypot, pi, radians

from mbsd import Mechanism, harmonic


@dataclass(frozen=True)
class Params:
    """Places and lengths (m), angles of the handle (degrees from the dead point), rate (rad/s), force (N)."""

    handle_pivot: tuple[float, float] = (-0.070, 0.0)
    handle: float = 0.034
    grip: tuple[float, float] = (0.080, 0.080)  # on the handle
    link: float = 0.050
    arm: float = 0.050
    pad: tuple[float, float] = (-0.005, -0.110)  # on the arm, whose x axis points to its pin
    locked: float = -3.0
    opened: float = 80.0
    rate: float = pi / 2
    force: float = 100.0


def build(p: Params) -> Mechanism:
    """The arm turns about the origin; the handle swings to and fro between locked and opened."""
    m = Mechanism("toggle_clamp")
    handle, link, arm = m.body("handle"), m.bar("link", p.link), m.body("arm")
    m.revolute("pivot", m.ground.at(*p.handle_pivot), handle.origin)
    m.revolute("knee", handle.at(p.handle, 0), link.start)
    m.revolute("pin", link.end, arm.at(p.arm, 0))
    m.revolute("hinge", m.ground.at(0, 0), arm.origin)
    m.force("workpiece", arm.at(*p.pad), p.force, (0.0, 1.0))
    locked, opened = dead_point(p) + radians(p.locked), dead_point(p) + radians(p.opened)
    m.drive_angle("hand", handle, harmonic((locked - opened) / 2, p.rate, pi / 2, (locked + opened) / 2))
    m.trace("grip", handle.at(*p.grip))
    m.trace("pad", arm.at(*p.pad))
    m.start_near(handle=10, link=15, arm=90)
    return m


def dead_point(p: Params) -> float:
    """Angle of the handle (rad) at which it is in line with the link."""
    x, y = p.handle_pivot
    apart, line = hypot(x, y), p.handle + p.link
    return atan2(-y, -x) + acos((apart**2 + line**2 - p.arm**2) / (2 * apart * line))
