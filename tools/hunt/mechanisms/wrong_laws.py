"""Laws of drivers whose given derivatives are not those of their values: every analysis must refuse them."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, function
from tools.hunt.subject import Subject, family


def _taken(sol: object) -> list[str]:
    return ["a law whose derivatives are not its own was taken"]


@family("law with wrong derivatives", weight=0.3)
def wrong(rng: np.random.Generator) -> Subject:
    """A crank with a bob or a slider whose law errs in f' or f'' by a factor, a sign, or a part of 1e-5 to 1."""
    m, rate, size = Mechanism("wrong law", gravity=(0.0, -9.81)), float(10 ** rng.uniform(-0.5, 1.5)), 0.7
    off = 1.0 + float(rng.choice([-2.0, 1.0, -1.0, *(10.0 ** rng.uniform(-5, 0, 3) * rng.choice([-1, 1], 3))]))
    slope, bend = (off, off) if rng.random() < 0.5 else (1.0, off)
    law = function(
        lambda t: size * math.sin(rate * t),
        lambda t: slope * size * rate * math.cos(rate * t),
        lambda t: -bend * size * rate**2 * math.sin(rate * t),
    )
    crank, duration = m.bar("crank", 0.3, 1.0), 2 * math.pi / rate
    m.revolute("O", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, law)
    if rng.random() < 0.5:
        rod, block = m.bar("rod", 1.0, 1.0), m.body("block", 1.0, inertia=0.1)
        m.revolute("A", crank.end, rod.start)
        m.revolute("B", rod.end, block.origin)
        m.prismatic("rail", m.ground.origin, block.origin)
        m.start_near(rod=0.0, block=(1.3, 0.0, 0.0))
        return Subject(m, duration, bool(rng.random() < 0.5), duration, _taken, possible=False)
    bob = m.bar("bob", 0.4, 0.5)
    m.revolute("A", crank.end, bob.start)
    m.start_near(bob=-60.0)
    return Subject(m, duration, False, truth=_taken, possible=False)
