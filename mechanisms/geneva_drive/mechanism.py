"""A Geneva drive: the crank's pin moves the wheel on by one slot each turn and locks it in between."""

from dataclasses import dataclass
from math import pi, sin

from mbsd import Mechanism, constant_rate


@dataclass(frozen=True)
class Params:
    """Slots of the wheel, distance of the centres (m), and the crank's speed (rad/s)."""

    slots: int = 4
    distance: float = 0.100
    speed: float = pi


VARIANTS = {
    "three_slots": {"slots": 3},
    "five_slots": {"slots": 5},
    "six_slots": {"slots": 6},
}


def build(p: Params) -> Mechanism:
    """The radius of the pin's circle lets it enter along the slots."""
    m = Mechanism("geneva_drive")
    crank, wheel = m.body("crank"), m.body("wheel")
    m.revolute("O", m.ground.at(0, 0), crank.origin)
    m.revolute("W", m.ground.at(p.distance, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.at(0, 0), p.slots, p.distance * sin(pi / p.slots))
    m.drive_angle("motor", crank, constant_rate(p.speed, pi))
    m.start_near(crank=180, wheel=180 / p.slots)
    return m
