"""Kinds of mechanisms whose bodies have places along the normal of the plane: engines, legs on a shaft, some places."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, constant_rate
from tools.hunt.subject import Family, Subject

TURN = 2 * math.pi


def engine(rng: np.random.Generator) -> Subject:
    """Up to six cylinders in one or two banks, or all round, on throws of their own or in pairs on one."""
    m, throw = Mechanism("engine"), float(rng.uniform(0.01, 0.1))
    rod, spacing = throw * float(rng.uniform(2.8, 5.0)), throw * float(rng.uniform(1.6, 3.0))
    angle = float(rng.choice([0.0, 60.0, 90.0, 120.0, 180.0, rng.uniform(40.0, 180.0)]))
    upright, aside = float(rng.uniform(0, 360)), float(rng.choice([0.0, 0.0, rng.uniform(-0.1, 0.1)])) * throw
    crank, number = m.body("crank"), 0
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k in range(int(rng.integers(1, 4))):
        turn = float(rng.choice([0.0, 90.0, 120.0, 180.0, 240.0, rng.uniform(0.0, 360.0)]))
        apart = spacing * float(rng.uniform(0.18, 0.3))
        for side in (-1, 1) if angle else (0,):
            number += 1
            z = k * spacing + side * apart / 2
            bank = math.radians(upright + side * angle / 2)
            a = math.radians(turn)
            link, piston = m.bar(f"rod_{number}", rod, z=z), m.body(f"piston_{number}", z=z)
            m.revolute(f"pin_{number}", crank.at(throw * math.cos(a), throw * math.sin(a), z=z), link.start)
            m.revolute(f"wrist_{number}", link.end, piston.origin)
            place = m.ground.at(-aside * math.sin(bank), aside * math.cos(bank), bank, z=z)
            m.prismatic(f"bore_{number}", place, piston.origin)
            m.start_near(**{link.name: math.degrees(bank), piston.name: math.degrees(bank)})
    m.drive_angle("motor", crank, constant_rate(TURN))
    m.start_near(crank=0)
    return Subject(m, 1.0, True, 1.0)


def legs(rng: np.random.Generator) -> Subject:
    """Lambda legs of Chebyshev on one shaft; some rockers have no place."""
    m, a = Mechanism("legs"), float(rng.uniform(0.01, 0.1))
    spacing, beside = a * float(rng.uniform(1.0, 3.0)), a * float(rng.uniform(0.3, 0.9))
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k in range(int(rng.integers(1, 5))):
        turn, z = float(rng.uniform(0, TURN)), k * spacing
        leg = m.bar(f"leg_{k}", 5 * a, z=z)
        rocker = m.bar(f"rocker_{k}", 2.5 * a, z=None if rng.random() < 0.3 else z + beside)
        m.revolute(f"pin_{k}", crank.at(a * math.cos(turn), a * math.sin(turn), z=z), leg.start)
        m.revolute(f"knee_{k}", leg.at(2.5 * a, 0), rocker.end)
        m.revolute(f"hip_{k}", m.ground.at(2 * a, 0), rocker.start)
        m.trace(f"foot_{k}", leg.end)
        m.start_near(**{leg.name: -50, rocker.name: -110})
    m.drive_angle("motor", crank, constant_rate(TURN))
    m.start_near(crank=0)
    return Subject(m, 1.0, True, 1.0)


def four_bar(rng: np.random.Generator) -> Subject:
    """A crank-rocker, some of whose bodies have a place."""
    m, size = Mechanism("places"), float(rng.uniform(0.02, 0.3))
    lengths = [size * length for length in (1.0, 3.0, 2.6)]
    given = rng.random(3) < 0.6
    given[int(rng.integers(3))] = True
    order = rng.permutation(3)
    bars = [
        m.bar(name, length, z=float(order[k] * size * rng.uniform(0.3, 0.6)) if given[k] else None)
        for k, (name, length) in enumerate(zip(("crank", "coupler", "rocker"), lengths, strict=True))
    ]
    m.revolute("O", m.ground.origin, bars[0].start)
    m.revolute("A", bars[0].end, bars[1].start)
    m.revolute("B", bars[1].end, bars[2].end)
    m.revolute("D", m.ground.at(3.2 * size, 0.0), bars[2].start)
    m.drive_angle("motor", bars[0], constant_rate(TURN))
    m.start_near(crank=20, coupler=40, rocker=100)
    return Subject(m, 1.0, True, 1.0)


KINDS = {
    family.name: family
    for family in (
        Family("engine with places along its shaft", engine),
        Family("legs at places along a shaft", legs),
        Family("four-bar, some bodies with places", four_bar),
    )
}
