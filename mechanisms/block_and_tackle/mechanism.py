"""A block and tackle: a counterweight lifts nearly twice its own weight, half as far.
One rope runs from the beam down round the loose block, up over the fixed pulley and down to the counterweight. Each of
its strands pulls nearly alike, so two of them carry the block.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism

DURATION = 0.55

# A counterweight of half the load balances it: make run-block-and-tackle-balanced.
VARIANTS = {"balanced": {"counterweight": 2.0}}


@dataclass(frozen=True)
class Params:
    """Masses of the load and the counterweight (kg), radius of both pulleys (m)."""

    load: float = 4.0
    counterweight: float = 2.4
    radius: float = 0.04


def build(p: Params) -> Mechanism:
    """The counterweight falls from rest."""
    m = Mechanism("block_and_tackle")
    load = m.body("load", mass=p.load, inertia=0.01)
    weight = m.body("counterweight", mass=p.counterweight, inertia=0.01)
    block, pulley = m.body("block", mass=0.2, inertia=2e-4), m.body("pulley", mass=0.2, inertia=2e-4)
    m.revolute("A", m.ground.at(3 * p.radius, 0), pulley.origin)
    m.revolute("B", load.origin, block.origin)
    m.prismatic("left", m.ground.at(p.radius, 0, -pi / 2), load.at(0, 0, -pi / 2))
    m.prismatic("right", m.ground.at(4 * p.radius, 0, -pi / 2), weight.at(0, 0, -pi / 2))
    m.start_near(load=(p.radius, -0.6, 0), counterweight=(4 * p.radius, -0.25, 0))
    around, over = m.over(block.origin, p.radius, clockwise=False), m.over(pulley.origin, p.radius)
    m.cable("rope", [m.ground.at(0, 0), around, over, weight.origin])
    return m
