"""Machines whose bodies have places along the normal of the plane: engines by hand, and legs on a shaft."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mbsd import Mechanism, constant_rate

THROW, ROD = 0.04, 0.145
"""m."""

type Cylinder = tuple[float, float, float]
"""Bank, counted from upright, and throw (degrees); place along the shaft (m)."""

SINGLE: Sequence[Cylinder] = [(0, 90, 0.0)]
INLINE_TWO: Sequence[Cylinder] = [(0, 90, -0.05), (0, 270, 0.05)]
INLINE_FOUR: Sequence[Cylinder] = [(0, 90, -0.15), (0, 270, -0.05), (0, 270, 0.05), (0, 90, 0.15)]
V_TWO: Sequence[Cylinder] = [(45, 90, -0.0115), (-45, 90, 0.0115)]
V_FOUR: Sequence[Cylinder] = [(45, 90, -0.0615), (-45, 90, -0.0385), (45, 270, 0.0385), (-45, 270, 0.0615)]


def engine(cylinders: Sequence[Cylinder], mass: float | None = None) -> Mechanism:
    """A crank, and for each cylinder a rod and a piston; ``mass`` (kg) of each piston, None for that of its parts."""
    m = Mechanism("engine")
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, (bank, throw, z) in enumerate(cylinders, start=1):
        rod, piston = m.bar(f"rod_{k}", ROD, z=z), m.body(f"piston_{k}", mass=mass, z=z)
        a, along = math.radians(throw), math.radians(90 + bank)
        m.revolute(f"pin_{k}", crank.at(THROW * math.cos(a), THROW * math.sin(a), z=z), rod.start)
        m.revolute(f"wrist_{k}", rod.end, piston.origin)
        m.prismatic(f"bore_{k}", m.ground.at(0, 0, along, z=z), piston.origin)
        m.start_near(**{f"rod_{k}": 90 + bank, f"piston_{k}": 90 + bank})
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0)
    return m


def legs(
    throws: Sequence[tuple[float, float]] = ((0, -0.06), (180, 0.0), (120, 0.06)), beside: float = 0.014
) -> Mechanism:
    """Chebyshev's lambda legs on one shaft: throw (degrees) and place (m) of each; its rocker is ``beside`` it (m)."""
    m, a = Mechanism("legs"), 0.03
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, (throw, z) in enumerate(throws, start=1):
        turn = math.radians(throw)
        leg, rocker = m.bar(f"leg_{k}", 5 * a, z=z), m.bar(f"rocker_{k}", 2.5 * a, z=z + beside)
        m.revolute(f"pin_{k}", crank.at(a * math.cos(turn), a * math.sin(turn), z=z), leg.start)
        m.revolute(f"knee_{k}", leg.at(2.5 * a, 0), rocker.end)
        m.revolute(f"hip_{k}", m.ground.at(2 * a, 0), rocker.start)
        m.trace(f"foot_{k}", leg.end)
        m.start_near(**{f"leg_{k}": -50, f"rocker_{k}": -110})
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0)
    return m


def press(places: Sequence[float] = (-0.03, 0.03), rod_z: bool = True, ram_z: float | None = None) -> Mechanism:
    """A crank that pushes one ram by rods at several places (m); with ``rod_z`` False the markers alone tell them."""
    m = Mechanism("press")
    crank, ram = m.body("crank"), m.body("ram", z=ram_z)
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, z in enumerate(places, start=1):
        rod = m.bar(f"rod_{k}", 5 * THROW, z=z if rod_z else None)
        m.revolute(f"pin_{k}", crank.at(THROW, 0, z=z), rod.start)
        m.revolute(f"wrist_{k}", rod.end, ram.origin)
        m.start_near(**{f"rod_{k}": -90})
    m.prismatic("guide", m.ground.at(0, 0, -math.pi / 2), ram.origin)
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=-90, ram=(0, -6 * THROW, -90))
    return m
