"""An elevator: its motor lifts only what car and counterweight differ by.
The rope hangs over the driving sheave; the counterweight has the mass of the car and of half its load.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, cycloidal

DURATION = 4.0

# An empty car is lighter than its counterweight: mbsd run elevator-empty.
VARIANTS = {"empty": {"car": 4.0}}


@dataclass(frozen=True)
class Params:
    """Masses (kg), radius of the sheave and height of the way (m)."""

    car: float = 8.0
    counterweight: float = 6.0
    radius: float = 0.08
    height: float = 0.4


def build(p: Params) -> Mechanism:
    """The car rises from rest to rest."""
    m = Mechanism("elevator")
    car = m.body("car", mass=p.car, inertia=0.1)
    weight = m.body("counterweight", mass=p.counterweight, inertia=0.05)
    sheave = m.body("sheave", mass=0.5, inertia=2e-3)
    m.revolute("axle", m.ground.at(0, 0), sheave.at(0, 0))
    m.prismatic("car_rail", m.ground.at(-p.radius, 0, -pi / 2), car.at(0, 0, -pi / 2))
    m.prismatic("weight_rail", m.ground.at(p.radius, 0, -pi / 2), weight.at(0, 0, -pi / 2))
    m.cable("rope", [car.at(0, 0), m.over(sheave.at(0, 0), p.radius), weight.at(0, 0)])
    m.start_near(sheave=0, car=(-p.radius, -0.6, 0), counterweight=(p.radius, -0.2, 0))
    m.drive_angle("motor", sheave, cycloidal(-p.height / p.radius, DURATION))
    return m
