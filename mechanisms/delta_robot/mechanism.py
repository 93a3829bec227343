"""Delta robot: three arms with pairs of rods carry a platform that never turns. SI units."""

from dataclasses import dataclass
from math import acos, atan2, cos, hypot, pi, sin

from mbsd.spatial import Mechanism, function

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Params:
    """Base, platform, arm, rods, half a pair, height and circle (m), and the speed (rad/s).

    R. Clavel, Delta, a fast robot with parallel geometry, 18th Int. Symp. on Industrial Robots, 1988.
    """

    base: float = 0.20
    platform: float = 0.05
    arm: float = 0.20
    rod: float = 0.45
    half: float = 0.035
    height: float = -0.40
    circle: float = 0.08
    speed: float = 2 * pi / 3


def angle(p: Params, at: Place, azimuth: float) -> float:
    """Return how far below the horizontal the arm at an azimuth stands where the platform is at a place (rad)."""
    along, aside = at[0] * cos(azimuth) + at[1] * sin(azimuth), at[1] * cos(azimuth) - at[0] * sin(azimuth)
    x, z = along + p.platform - p.base, at[2]
    reach = (x * x + aside * aside + z * z + p.arm**2 - p.rod**2) / (2 * p.arm)
    return -acos(reach / hypot(x, z)) - atan2(z, x)


def build(p: Params) -> Mechanism:
    """The platform runs round a circle about z; laws of the arms are those that take it there."""
    m = Mechanism("delta_robot")
    home = angle(p, (0.0, 0.0, p.height), 0.0)
    platform = m.body("platform", 0.4, at=(0.0, 0.0, p.height), inertia=(2e-4, 2e-4, 4e-4))
    for name, azimuth in (("1", 0.0), ("2", 2 * pi / 3), ("3", 4 * pi / 3)):
        c, s = cos(azimuth), sin(azimuth)
        out = p.base + p.arm * cos(home)
        hinge, knee = (p.base * c, p.base * s, 0.0), (out * c, out * s, -p.arm * sin(home))
        arm = m.rod(f"arm_{name}", hinge, knee, mass=0.2, radius=0.0)
        m.revolute(f"motor_{name}", m.ground, arm, at=hinge, axis=(-s, c, 0.0))
        for side in (-1, 1):
            x, y = -side * p.half * s, side * p.half * c
            start, end = (knee[0] + x, knee[1] + y, knee[2]), (p.platform * c + x, p.platform * s + y, p.height)
            m.distance(f"rod_{name}_{'ab'[side > 0]}", arm, platform, start=start, end=end, length=p.rod)

        def law(t: float, azimuth: float = azimuth) -> float:
            at = (p.circle * cos(p.speed * t), p.circle * sin(p.speed * t), p.height)
            return angle(p, at, azimuth) - home

        m.drive_turn(f"drive_{name}", f"motor_{name}", function(law, period=2 * pi / p.speed))
    m.trace("P", platform, at=(0.0, 0.0, p.height))
    return m
