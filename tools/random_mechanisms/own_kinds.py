"""Kinds that ask more of parts than of the solver: places along the normal, marks, sharp teeth."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Mechanism, constant_rate
from tools.random_mechanisms.subject import Builder, Family, Subject

# Kinds of mechanisms whose bodies have places along the normal of the plane: engines, legs on a shaft, some places.


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


ALONG = {
    family.name: family
    for family in (
        Family("engine with places along its shaft", engine),
        Family("legs at places along a shaft", legs),
        Family("four-bar, some bodies with places", four_bar),
    )
}


# Kinds that ask more of parts than of the solver: marks on rims, welds and masses near pins, sharp teeth, places.


KINDS: dict[str, Family] = dict(ALONG)


def _kind(name: str):
    def enter(build: Builder) -> Builder:
        KINDS[name] = Family(name, build)
        return build

    return enter


def drawn(seed: int) -> tuple[str, Subject]:
    """The mechanism of a seed, and its kind."""
    rng = np.random.default_rng([seed, 72])
    name = str(rng.choice(list(KINDS)))
    return name, KINDS[name].build(rng)


@_kind("traced point of a wheel on a road")
def trochoid(rng: np.random.Generator) -> Subject:
    """On the rim, or within or beyond it."""
    m, radius = Mechanism("trochoid"), float(rng.uniform(0.02, 0.2))
    wheel, turn = m.body("wheel", 1.0, inertia=0.01), 2 * math.pi
    m.rolling_disc("road", m.ground.at(0.0, 0.0, float(rng.uniform(-0.5, 0.5))), wheel.origin, radius)
    m.drive_angle("motor", wheel, constant_rate(-turn))
    away, angle = radius * float(rng.choice([1.0, rng.uniform(0.3, 1.6)])), float(rng.uniform(0, turn))
    m.trace("P", wheel.at(away * math.cos(angle), away * math.sin(angle)))
    return Subject(m, float(rng.uniform(0.3, 2.0)), True, 1.0)


@_kind("traced point of a planet gear")
def planet(rng: np.random.Generator) -> Subject:
    """On the pitch circle, or within it, of a gear that rolls in a ring or round a wheel."""
    m, internal = Mechanism("planet"), bool(rng.random() < 0.5)
    radius = float(rng.uniform(0.02, 0.05))
    fixed = radius * float(rng.choice([3.0, 4.0, rng.uniform(2.2, 5.0)]))
    arm, gear = m.body("arm", 1.0, inertia=0.01), m.body("planet", 1.0, inertia=0.01)
    m.revolute("O", m.ground.origin, arm.origin)
    m.revolute("A", arm.at(fixed - radius if internal else fixed + radius, 0.0), gear.origin)
    m.gear_pair("mesh", m.ground.origin, gear.origin, fixed, radius, internal=internal)
    m.drive_angle("motor", arm, constant_rate(2 * math.pi))
    angle, away = float(rng.uniform(0, 6.3)), radius * float(rng.choice([1.0, rng.uniform(0.4, 1.0)]))
    m.trace("P", gear.at(away * math.cos(angle), away * math.sin(angle)))
    m.start_near(arm=0, planet=0)
    return Subject(m, 1.0, True, 1.0)


@_kind("loads welded or pinned at joints")
def loads(rng: np.random.Generator) -> Subject:
    """A crank-rocker with up to three loads near its joints."""
    m, lengths = Mechanism("loads"), (0.05, 0.15, 0.13, 0.16)
    bars = [m.bar(name, length) for name, length in zip(("crank", "coupler", "rocker"), lengths, strict=False)]
    m.revolute("O", m.ground.origin, bars[0].start)
    m.revolute("A", bars[0].end, bars[1].start)
    m.revolute("B", bars[1].end, bars[2].end)
    m.revolute("D", m.ground.at(lengths[3], 0.0), bars[2].start)
    m.drive_angle("motor", bars[0], constant_rate(2 * math.pi))
    for k in range(int(rng.integers(1, 4))):
        number = int(rng.integers(3))
        body, length = bars[number], lengths[number]
        at = body.at(float(rng.choice([0.0, length, rng.uniform(-0.1, 1.1) * length])), 0.0, float(rng.uniform(0, 3)))
        load = m.body(f"load{k}", float(rng.uniform(0.1, 5.0)), inertia=0.01)
        if rng.random() < 0.7:
            m.weld(f"fix{k}", at, load.origin)
        else:
            m.revolute(f"hang{k}", at, load.origin)
            m.drive_relative_angle(f"hold{k}", body, load, constant_rate(0.0))
    m.start_near(crank=20, coupler=40, rocker=100)
    return Subject(m, 1.0, True, 1.0)


@_kind("closed terrain of many teeth")
def escapement(rng: np.random.Generator) -> Subject:
    """An escape wheel with sharp or round teeth that a lever with a point or a roller touches."""
    m, teeth, radius = Mechanism("escapement"), int(rng.integers(8, 31)), 0.1
    low, steep = float(rng.uniform(0.75, 0.92)), float(rng.uniform(0.08, 0.5))
    turn = [-2 * math.pi * (tooth + part) / teeth for tooth in range(teeth) for part in (0.0, steep)]
    away = [radius * height for _ in range(teeth) for height in (1.0, low)]
    points = [(r * math.cos(t), r * math.sin(t)) for r, t in zip(away, turn, strict=True)]
    wheel, lever = m.body("wheel", 1.0, inertia=0.01), m.body("lever", 0.3, (0.03, 0.0), 0.003)
    m.revolute("O", m.ground.origin, wheel.origin)
    m.revolute("P", m.ground.at(-0.09, 0.11), lever.origin)
    m.rigid_terrain("touch", wheel.origin, lever.at(0.09, 0.0), points, closed=True)
    m.torsion_spring("back", m.ground, lever, 1.0, free_angle=0.0)
    m.start_near(wheel=0, lever=0)
    m.start_moving(wheel=float(rng.uniform(0.2, 2.0)))
    return Subject(m, 0.3, False)
