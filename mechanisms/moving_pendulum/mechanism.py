"""A pendulum on a cart that is free on its rail: the cart moves against the swing of the bob.
Nothing pushes them sideways, so their common centre of mass only goes up and down. In the variant the cart is driven
instead, and the bob is thrown over the top again and again.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, harmonic

DURATION = 4.0

VARIANTS = {
    "small": {"start": 8.0},
    "driven": {"stroke": 0.16, "length": 0.12, "start": 0.0, "damping": 0.003, "rate": 8.8},
}


@dataclass(frozen=True)
class Params:
    """Length (m), masses of cart and bob (kg), start (degrees from hanging), drag of the bob (N s/m).

    With a ``stroke`` (m) the cart is driven as stroke * sin(rate * t), rate in rad/s.
    """

    length: float = 0.200
    masses: tuple[float, float] = (0.30, 0.20)
    start: float = 110.0
    damping: float = 0.0
    stroke: float = 0.0
    rate: float = 2.5
    gravity: float = 9.81


def build(p: Params) -> Mechanism:
    """The rod has no mass; its frame begins on the cart, and it hangs at -90 degrees."""
    m = Mechanism("moving_pendulum", gravity=(0.0, -p.gravity))
    cart, rod = m.body("cart", p.masses[0]), m.bar("rod", p.length, p.masses[1], com=(p.length, 0), inertia=0.0)
    m.prismatic("rail", m.ground.origin, cart.origin)
    m.revolute("pivot", cart.origin, rod.start)
    if p.damping:
        m.bushing("air", m.ground.origin, rod.end, (0, 0, 0), damping=(p.damping, p.damping, 0))
    m.start_near(cart=(0, 0, 0), rod=p.start - 90.0)
    if p.stroke:
        m.drive_coordinate("push", m.ground.origin, cart.origin, harmonic(p.stroke, p.rate))
        m.start_moving(cart=(p.stroke * p.rate, 0, 0), rod=0.0)
    m.trace("bob", rod.end)
    return m


def small_period(p: Params) -> float:
    """Period of small swings (s)."""
    cart, bob = p.masses
    return 2 * pi * (p.length * cart / (p.gravity * (cart + bob))) ** 0.5
