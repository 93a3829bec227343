"""A block slides on an arm that turns at constant rate, and a spring holds it to the pivot.
Seen from the arm it swings about a point further out than its spring's rest, more slowly the faster the arm turns;
without the spring (a variant) it flies out.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate

DURATION = 6.0

VARIANTS = {
    "slow": {"rate": pi / 2, "start": 0.140},
    "loose": {"stiffness": 0.0, "rate": 0.5, "DURATION": 4.0},
}


@dataclass(frozen=True)
class Params:
    """Mass (kg), stiffness (N/m), free length and start (m from the pivot), rate of the arm (rad/s)."""

    mass: float = 0.50
    stiffness: float = 12.0
    free: float = 0.080
    start: float = 0.090
    rate: float = pi


def build(p: Params) -> Mechanism:
    """The block starts at rest on the arm; no weight acts, as on a table."""
    m = Mechanism("rotating_constraint", gravity=None)
    arm, block = m.body("arm"), m.body("block", p.mass)
    m.revolute("pivot", m.ground.origin, arm.origin)
    m.prismatic("slot", arm.origin, block.origin)
    if p.stiffness:
        m.spring("spring", m.ground.origin, block.origin, p.stiffness, free_length=p.free)
    m.drive_angle("motor", arm, constant_rate(p.rate))
    m.start_near(arm=0, block=(p.start, 0, 0))
    m.start_moving(block=(0, p.start * p.rate, p.rate))
    m.trace("path", block.origin)
    return m
