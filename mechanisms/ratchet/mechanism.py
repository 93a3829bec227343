"""A ratchet: a lever swings to and fro; one pawl on it pushes the wheel on, another one keeps what is gained.
Wheel and pawls are outlines that collide: the pawls ride up the slopes of the teeth, fall off their tips and hold
their faces.
"""

from dataclasses import dataclass
from math import cos, hypot, pi, sin

from mbsd import Mechanism, harmonic

DURATION = 4.0


@dataclass(frozen=True)
class Params:
    """Teeth, radii (m), swing of the lever (rad) and its rate (rad/s), where the pawls turn (m)."""

    teeth: int = 18
    tip: float = 0.050
    root: float = 0.044
    swing: float = 0.30
    rate: float = 2 * pi * 0.75
    pawl: tuple[float, float] = (-0.055, 0.056)


PAWL = [(-0.006, -0.004), (0.034, -0.005), (0.0455, -0.004), (0.034, 0.004), (-0.006, 0.005)]


def wheel_path(p: Params) -> list[tuple[float, float]]:
    """Return the outline of the wheel: a face and a slope for each tooth."""
    turns = [2 * pi * k / p.teeth for k in range(p.teeth)]
    return [(r * cos(a), r * sin(a)) for a in turns for r in (p.tip, p.root)]


def build(p: Params) -> Mechanism:
    """The catch turns on ground, the pusher on the lever."""
    m = Mechanism("ratchet")
    wheel, lever = m.body("wheel", mass=0.15, inertia=1.7e-4), m.bar("lever", 0.12, mass=0.03)
    m.revolute("axle", m.ground.at(0, 0), wheel.origin)
    m.revolute("hub", m.ground.at(0, 0), lever.start)
    m.drive_angle("hand", lever, harmonic(p.swing, p.rate, mean=1.9))
    m.outline(wheel, wheel_path(p))
    x, y = p.pawl
    places = {"catch": (m.ground.at(-x, -y), 3.2), "pusher": (lever.at(hypot(x, y), 0), -2.27)}
    for name, (pin, angle) in places.items():
        pawl = m.body(name, mass=0.02, com=(0.02, 0), inertia=8e-6)
        m.revolute(f"{name}_pin", pin, pawl.origin)
        m.outline(pawl, PAWL)
        m.outline_contact(f"{name}_click", wheel, pawl)
        m.torsion_spring(f"{name}_spring", pin.body, pawl, 0.01, damping=2e-5, free_angle=angle - 1.0)
    m.torsion_spring("drag", m.ground, wheel, 0.0, damping=2e-3)
    m.start_near(wheel=4, lever=109, catch=190, pusher=-10)
    return m
