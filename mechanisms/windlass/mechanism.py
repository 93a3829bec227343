"""A differential windlass: a crank lifts a heavy hook.
One drum has two radii. The rope comes off the thin one while it winds on the thick one, so each turn lifts the hook by
half the difference of both circumferences only.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, cycloidal

DURATION = 4.0


@dataclass(frozen=True)
class Params:
    """Radii of the drum (m), mass of the load (kg), turns of the crank."""

    thick: float = 0.055
    thin: float = 0.03
    load: float = 20.0
    turns: float = 3.0


def build(p: Params) -> Mechanism:
    """The drum turns from rest to rest."""
    m = Mechanism("windlass")
    drum, hook = m.body("drum"), m.body("hook", mass=p.load, inertia=0.05)
    middle = (p.thick - p.thin) / 2
    m.revolute("axle", m.ground.at(0, 0), drum.at(0, 0))
    m.prismatic("guide", m.ground.at(middle, 0, -pi / 2), hook.at(0, 0, -pi / 2))
    block = m.over(hook.at(0, 0), (p.thick + p.thin) / 2, clockwise=False, slides=True)
    drums = [m.over(drum.at(0, 0), radius, clockwise=False) for radius in (p.thin, p.thick)]
    m.cable("rope", [drums[0], block, drums[1]])
    m.trace("handle", drum.at(0.09, 0))
    m.start_near(drum=0, hook=(middle, -0.45, 0))
    m.drive_angle("hand", drum, cycloidal(2 * pi * p.turns, DURATION))
    return m
