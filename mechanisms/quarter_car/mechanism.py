"""One corner of a car at 2.5 m/s: its wheel, on a spring and a damper, rolls over a bump in the road.
The tyre is pressed in and throws the wheel up at once; the body follows slowly, and the damper takes its swing. A worn
damper (a variant) lets it swing on.
"""

from dataclasses import dataclass
from math import pi

import numpy as np

from mbsd import Mechanism, constant_rate, curve
from mbsd.model.laws.curve import Curve

DURATION = 0.9

VARIANTS = {
    "worn": {"damping": 400.0},
    "fast": {"speed": 5.0, "DURATION": 0.45},
}


@dataclass(frozen=True)
class Params:
    """Masses (kg), strut and tyre (N/m, N s/m), sizes (m), speed (m/s), weight (m/s^2)."""

    sprung: float = 250.0
    unsprung: float = 25.0
    wheel: float = 15.0
    stiffness: float = 20000.0
    damping: float = 1500.0
    tyre: float = 180000.0
    tyre_damping: float = 100.0
    radius: float = 0.300
    bump: tuple[float, float] = (0.050, 0.6)  # height, length
    before: float = 0.4  # from the start to the bump
    hub: float = 0.55  # of the body's middle, over the hub at rest
    speed: float = 2.5
    gravity: float = 9.81


def sag(p: Params) -> tuple[float, float]:
    """How far spring and tyre are pressed in at rest (m)."""
    above = p.sprung * p.gravity
    return above / p.stiffness, (above + (p.unsprung + p.wheel) * p.gravity) / p.tyre


def road(p: Params) -> Curve:
    """A bump, 1 - cos, in a level road; it bends less tightly than the wheel, which touches at one point."""
    height, length = p.bump
    x = np.linspace(-0.2, length + 0.2, 101)
    y = height / 2 * (1 - np.cos(2 * pi * np.clip(x / length, 0.0, 1.0)))
    return curve(p.before + x, y, kind="spline")


def build(p: Params) -> Mechanism:
    """The car goes along x; its body stays level, and the carrier of the wheel slides up and down on it."""
    m = Mechanism("quarter_car", gravity=(0.0, -p.gravity))
    body, carrier = m.body("body", p.sprung, inertia=10.0), m.body("carrier", p.unsprung, inertia=0.5)
    wheel = m.body("wheel", p.wheel, inertia=0.6 * p.wheel * p.radius**2)
    m.angle_lock("level", m.ground.origin, body.origin)
    m.prismatic("guide", body.at(0, 0, pi / 2), carrier.at(0, 0.2, pi / 2))
    m.revolute("hub", carrier.origin, wheel.origin)
    m.drive_coordinate("engine", m.ground.origin, body.origin, constant_rate(p.speed))
    spring, tyre = sag(p)
    m.spring("spring", body.at(0, 0), carrier.at(0, 0), p.stiffness, p.damping, free_length=p.hub + spring)
    m.tyre("tyre", m.ground.origin, wheel.origin, p.radius, p.tyre, p.tyre_damping, profile=road(p))
    height = p.radius - tyre
    m.start_near(body=(0, height + p.hub, 0), carrier=(0, height, 0), wheel=(0, height, 0))
    m.start_moving(body=(p.speed, 0, 0), wheel=(p.speed, 0, -p.speed / height))
    m.trace("axle", wheel.origin)
    m.trace("seat", body.origin)
    return m
