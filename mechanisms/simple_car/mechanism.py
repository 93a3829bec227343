"""Simple car: four tyres on struts with springs; rear ones drive, front ones steer. SI units."""

from dataclasses import dataclass
from math import atan2, cos, radians, sin, tan

from mbsd.spatial import Mechanism


@dataclass(frozen=True)
class Params:
    """Lengths (m), masses (kg), tyres and springs (N/m, N s/m), steering (degrees), torque (N m)."""

    base: float = 0.30
    track: float = 0.24
    radius: float = 0.05
    body: float = 3.0
    wheel: float = 0.15
    tyre: tuple[float, float] = (2e4, 40.0)
    spring: tuple[float, float] = (900.0, 25.0)
    steer: float = 18.0
    torque: float = 0.05


DURATION = 3.0


def build(p: Params) -> Mechanism:
    """The car starts at rest along x; its inner front wheel has the larger angle (Ackermann)."""
    m = Mechanism("simple_car", gravity=(0.0, 0.0, -9.81))
    high, middle = 2.2 * p.radius, p.base / tan(radians(p.steer))
    body = m.body("body", p.body, at=(0.0, 0.0, high), inertia=(0.02, 0.03, 0.045))
    load, spring = 9.81 * p.body / 4, {"stiffness": p.spring[0], "damping": p.spring[1]}
    for name, x, y in (("rear_left", -1, 1), ("rear_right", -1, -1), ("front_left", 1, 1), ("front_right", 1, -1)):
        centre = (x * p.base / 2, y * p.track / 2, p.radius)
        turn = atan2(p.base, middle - centre[1]) if x > 0 else 0.0
        axis = (-sin(turn), cos(turn), 0.0)
        strut = tuple(at - 0.045 * y * part for at, part in zip(centre, axis, strict=True))
        hub = m.body(f"hub_{name}", 0.1, at=strut, inertia=(5e-5, 5e-5, 5e-5))
        wheel = m.disc(f"wheel_{name}", centre, axis, p.radius, p.wheel, 0.024)
        top = (strut[0], strut[1], high)
        m.prismatic(f"strut_{name}", hub, body, at=top, axis=(0, 0, 1))
        m.revolute(f"axle_{name}", hub, wheel, at=centre, axis=axis)
        free = high - p.radius + load / p.spring[0]
        m.spring(f"spring_{name}", body, hub, start=top, end=strut, length=free, **spring)
        m.tyre(
            f"tyre_{name}", m.ground, wheel, p.radius, *p.tyre, at=(0, 0, 0), normal=(0, 0, 1), centre=centre, axis=axis
        )
        if x < 0:
            m.torque(f"motor_{name}", f"axle_{name}", p.torque)
    m.trace("P", body, at=(-p.base / 2, 0.0, high))
    return m
