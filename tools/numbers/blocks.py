"""Mechanisms whose bodies Newton-Raphson places, left to themselves: in both formulations."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

from mbsd import Mechanism, Solution, harmonic
from mbsd.cams import Lift, oscillating_roller_cam

LIFT = Lift.of((2.1, math.radians(16), "modified_sine"), (2.1, 0.0, "cycloidal"), (2 * math.pi - 4.2, 0.0))


def runs() -> Iterator[tuple[str, partial[Solution]]]:
    """By name."""
    for make in (cam, geneva, rack, triad):
        for formulation in ("independent", "reference"):
            yield f"{formulation} {make.__name__}", partial(_simulated, make, formulation)


def _simulated(make: Callable[[], Mechanism], formulation: str) -> Solution:
    return make().simulate(1.0, steps=40, tolerance=1e-9, formulation=formulation)


def cam() -> Mechanism:
    """A cam that turns on, with a lever on a roller."""
    m = Mechanism("cam")
    wheel, lever = m.body("wheel", 2.0, (0.02, 0.0), 0.1), m.body("lever", 0.8, (0.5, 0.02), 0.05)
    m.revolute("A", m.ground.origin, wheel.origin)
    m.revolute("B", m.ground.at(1.0, 0.0), lever.origin)
    profile = oscillating_roller_cam(LIFT, 0.3, 0.12, 1.0, 1.0)
    m.cam_roller("mesh", wheel.origin, lever.at(1.0, 0.0), profile)
    m.torsion_spring("spring", m.ground, lever, 2.0)
    m.start_near(wheel=20, lever=math.degrees(math.pi - 2 * math.asin(0.21)))
    m.start_moving(wheel=7.0)
    return m


def geneva() -> Mechanism:
    """A crank that indexes a wheel of four slots."""
    m = Mechanism("geneva", gravity=(0.0, 0.0))
    crank, wheel = m.body("crank", 1.0, (0.03, 0.0), 0.02), m.body("wheel", 0.5, (0.0, 0.01), 0.01)
    m.revolute("A", m.ground.origin, crank.origin)
    m.revolute("B", m.ground.at(0.3, 0.0), wheel.origin)
    m.geneva("mesh", crank.origin, wheel.origin, slots=4, radius=0.3 * math.sin(math.pi / 4))
    m.start_near(crank=120, wheel=45)
    m.start_moving(crank=9.0)
    return m


def rack() -> Mechanism:
    """A rack under gravity that turns a pinion with a weight beside its axis."""
    m = Mechanism("rack")
    bar, pinion = m.body("bar", 1.0, inertia=0.01), m.body("pinion", 0.6, (0.05, 0.02), 0.004)
    m.prismatic("guide", m.ground.at(0.0, -0.1, 0.4), bar.origin)
    m.revolute("A", m.ground.origin, pinion.origin)
    m.rack_and_pinion("mesh", bar.origin, pinion.origin, radius=0.1 * math.cos(0.4))
    return m


def triad() -> Mechanism:
    """A plate on three bars, one of them on a driven crank, and a pendulum on it."""
    m = Mechanism("triad")
    crank, plate = m.bar("crank", 0.1, 0.5), m.body("plate", 1.0, (0.0, 0.0), 0.02)
    m.revolute("O", m.ground.origin, crank.start)
    bases = crank.end, m.ground.at(0.67, -0.5), m.ground.at(0.55, 0.6)
    for k, (base, corner) in enumerate(zip(bases, ((-0.1, -0.05), (0.12, -0.04), (0.0, 0.12)), strict=True)):
        bar = m.bar(f"bar{k}", (0.36, 0.46, 0.48)[k], 0.4)
        m.revolute(f"A{k}", base, bar.start)
        m.revolute(f"B{k}", bar.end, plate.at(*corner))
    bob = m.bar("bob", 0.2, 0.5)
    m.revolute("hang", plate.origin, bob.start)
    m.start_near(crank=30, plate=0, bar0=-5, bar1=90, bar2=-90, bob=-60)
    m.drive_angle("motor", crank, harmonic(0.2, 6.0, 0.0, 0.5))
    return m
