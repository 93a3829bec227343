"""Laws of drivers with given derivatives: those of rises between dwells are taken, wrong ones refused by all."""

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


@family("rise with given derivatives", weight=0.3)
def rise(rng: np.random.Generator) -> Subject:
    """A cycloidal or 3-4-5 rise between dwells, right or with f' or f'' that errs on a part of the rise."""
    m, begin, length = (
        Mechanism("rise", gravity=(0.0, -9.81)),
        float(rng.uniform(0, 0.5)),
        float(10 ** rng.uniform(-2, -0.4)),
    )
    size, turn = float(rng.uniform(0.1, 2.0)), 2 * math.pi
    laws = (
        (
            lambda u: u - math.sin(turn * u) / turn,
            lambda u: 1 - math.cos(turn * u),
            lambda u: turn * math.sin(turn * u),
        )
        if rng.random() < 0.5
        else (
            lambda u: 10 * u**3 - 15 * u**4 + 6 * u**5,
            lambda u: 30 * (u**2 - 2 * u**3 + u**4),
            lambda u: 60 * u - 180 * u**2 + 120 * u**3,
        )
    )
    errs, off = int(rng.integers(0, 3)), 1.0 + float(10 ** rng.uniform(-3, 0))

    def of_order(order: int):
        def law(t: float) -> float:
            u = min(max((t - begin) / length, 0.0), 1.0)
            wrong = order > 0 and order == errs and 0.3 < u < 0.7
            return size / length**order * laws[order](u) * (off if wrong else 1.0)

        return law

    crank, bob = m.bar("crank", 0.3, 1.0), m.bar("bob", 0.4, 0.5)
    m.revolute("O", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, function(of_order(0), of_order(1), of_order(2)))
    m.start_near(bob=-60.0)
    if rng.random() < 0.5:
        m.weld("A", crank.end, bob.start)
        return Subject(m, 1.0, True, 1.0, _taken if errs else None, possible=not errs)
    m.revolute("A", crank.end, bob.start)
    return Subject(m, 1.0, False, truth=_taken if errs else None, possible=not errs)
