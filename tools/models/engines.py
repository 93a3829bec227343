"""Engines with gas that burns: of one cylinder upright above its crank, and radial ones."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mbsd import GasCycle, Mechanism, constant_rate, four_stroke

THROW, ROD, BORE = 0.045, 0.14, 0.086
UP = math.pi / 2


def slider_crank(
    cycle: GasCycle | None = None, rate: float | None = 200.0, start: float = UP, mounted: bool = False, **more: Any
) -> Mechanism:
    """Return a crank, a rod and a piston below a head.

    It is driven at ``rate`` (rad/s) from the angle ``start``, or free.

    ``mounted``: in a block on soft mounts.
    """
    m = Mechanism("engine", gravity=None)
    block = m.body("block", 20.0, (0.0, 0.05), 0.4) if mounted else m.ground
    if mounted:
        m.bushing("mounts", m.ground.origin, block.origin, (4e4, 6e4, 900.0), (30.0, 30.0, 1.0))
    crank = m.bar("crank", THROW, 2.0, (0.0, 0.0), 0.05)
    rod, piston = m.bar("rod", ROD, 0.4), m.body("piston", 0.5)
    m.revolute("main", block.origin, crank.start)
    m.revolute("big_end", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston.origin)
    m.prismatic("liner", block.at(0, 0, UP), piston.at(0, 0, UP))
    pin = THROW * math.cos(start), THROW * math.sin(start)
    lean = math.asin(-pin[0] / ROD)
    m.start_near(
        crank=math.degrees(start), rod=90.0 - math.degrees(lean), piston=(0.0, pin[1] + ROD * math.cos(lean), 0.0)
    )
    if rate is not None:
        m.drive_angle("motor", crank, constant_rate(rate, start))
    head = block.at(0, THROW + ROD + 0.03, -UP)
    own: dict[str, Any] = {"bore": BORE} | more
    m.gas_cycle("gas", head, piston.at(0, 0.02), crank, cycle or petrol(), **own)
    return m


def scotch_yoke(cycle: GasCycle, rate: float = 200.0, start: float = UP, sense: float = 1.0) -> Mechanism:
    """A piston that moves as the cosine of its crank's angle, which turns clockwise where ``sense`` is -1."""
    m = Mechanism("yoke", gravity=None)
    crank, piston = m.bar("crank", THROW, 2.0), m.body("piston", 0.5)
    m.revolute("main", m.ground.origin, crank.start)
    m.prismatic("liner", m.ground.at(0, 0, UP), piston.at(0, 0, UP))
    m.pin_in_slot("yoke", piston.origin, crank.end)
    m.drive_angle("motor", crank, constant_rate(sense * rate, start))
    m.start_near(crank=math.degrees(start), piston=(0.0, THROW * math.sin(start), 0.0))
    m.gas_cycle("gas", m.ground.at(0, 0.3, -UP), piston.at(0, 0.1), crank, cycle, bore=BORE, clockwise=sense < 0)
    return m


def petrol(**more: Any) -> GasCycle:
    """A four-stroke cycle at full load."""
    return four_stroke(10.0, **({"heat_density": 2.4e6, "intake": 0.95e5, "exhaust": 1.1e5} | more))


def radial(count: int = 5, rate: float = 200.0, start: float = 0.7, sense: float = 1.0) -> Mechanism:
    """Return a radial engine.

    The upright cylinder's rod carries those of the others by knuckle pins around its big end.
    """
    m, around = Mechanism("radial", gravity=None), 0.035
    crank = m.bar("crank", THROW, 2.0, (0.0, 0.0), 0.05)
    m.revolute("main", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, constant_rate(sense * rate, start))
    pin = THROW * np.array([math.cos(start), math.sin(start)])
    near: dict[str, Any] = {"crank": math.degrees(start)}
    master: Any = None
    for k in range(count):
        bank = UP + 2 * math.pi * k / count
        u, n = np.array([math.cos(bank), math.sin(bank)]), np.array([-math.sin(bank), math.cos(bank)])
        rod = m.bar(f"rod_{k}", ROD if k == 0 else ROD - around, 0.4)
        piston, foot = m.body(f"piston_{k}", 0.5), pin
        if master is None:
            m.revolute(f"big_end_{k}", crank.end, rod.start)
        else:
            lies = math.radians(near["rod_0"]) + bank - UP
            foot = pin + around * np.array([math.cos(lies), math.sin(lies)])
            knuckle = master.at(around * math.cos(bank - UP), around * math.sin(bank - UP))
            m.revolute(f"knuckle_{k}", knuckle, rod.start)
        wrist = (foot @ u + math.sqrt((ROD if k == 0 else ROD - around) ** 2 - (foot @ n) ** 2)) * u
        near[f"rod_{k}"] = math.degrees(math.atan2(*(wrist - foot)[::-1]))
        near[f"piston_{k}"] = (float(wrist[0]), float(wrist[1]), math.degrees(bank))
        m.revolute(f"wrist_{k}", rod.end, piston.origin)
        m.prismatic(f"liner_{k}", m.ground.at(0, 0, bank), piston.origin)
        head = 1.5 * (THROW + ROD) * u
        m.gas_cycle(
            f"gas_{k}", m.ground.at(float(head[0]), float(head[1]), bank + math.pi), piston.at(0.01, 0.0), crank,
            petrol(), BORE, clockwise=sense < 0,
        )  # fmt: skip
        master = master or rod
    m.start_near(**near)
    return m
