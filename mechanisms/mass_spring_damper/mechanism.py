"""A block between a spring and a damper, released 45 mm from rest, swings and comes to rest.
The variants have no damper, or just so much that it no longer swings past, or a hand that shakes it in its own rhythm
until the swing is five times as wide as the push.
"""

from dataclasses import dataclass
from math import sqrt

from mbsd import Mechanism, harmonic

DURATION = 3.0

VARIANTS = {
    "undamped": {"damping": 0.0},
    "critical": {"damping": 40.0},
    "resonance": {"damping": 4.0, "start": 0.0, "force": 2.4, "DURATION": 8.0},
}


@dataclass(frozen=True)
class Params:
    """Mass (kg), spring (N/m), damper (N s/m), start (m from rest), force amplitude (N), positions (m)."""

    mass: float = 1.0
    stiffness: float = 400.0
    damping: float = 4.0
    start: float = 0.045
    force: float = 0.0
    rest: float = 0.130  # from the wall to the block
    apart: float = 0.026  # spring and damper, from the middle of the rail


def build(p: Params) -> Mechanism:
    """The block's place is its distance from rest; the force is in tune with the undamped block."""
    m = Mechanism("mass_spring_damper")
    block = m.body("block", p.mass)
    m.prismatic("rail", m.ground.origin, block.origin)
    side = p.apart if p.damping else 0.0
    m.spring("spring", m.ground.at(-p.rest, side), block.at(0, side), p.stiffness, free_length=p.rest)
    if p.damping:
        m.spring("damper", m.ground.at(-p.rest, -side), block.at(0, -side), 0.0, damping=p.damping)
    if p.force:
        m.force("hand", block.origin, harmonic(p.force, sqrt(p.stiffness / p.mass)))
    m.start_near(block=(p.start, 0, 0))
    return m
