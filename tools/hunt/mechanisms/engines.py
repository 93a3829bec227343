"""Engines of one cylinder with gas that burns: driven or free, offset, either way round, upright or lying."""

from __future__ import annotations

import math

import numpy as np

from mbsd import GasCycle, Mechanism, constant_rate, pressure_table, two_stroke
from mbsd.arrays.chambers import chambers
from mbsd.results.fluids import GasView
from mbsd.results.solution import Solution
from tools.hunt.subject import Subject, family

SLACK = 1e-8
"""Fraction of a stroke."""


@family("engines with gas that burns")
def engines(rng: np.random.Generator) -> Subject:
    """A slider-crank whose gas repeats after each turn, so that it does not matter in which turn its world stands."""
    m, driven = Mechanism("engine", gravity=(float(rng.normal()), -9.81)), bool(rng.random() < 0.5)
    throw = float(rng.uniform(0.02, 0.06))
    rod, offset = float(rng.uniform(2.5, 4.5)) * throw, float(rng.choice([0.0, rng.uniform(-0.3, 0.3)])) * throw
    lies, ahead = float(rng.uniform(-math.pi, math.pi)), float(rng.uniform(-math.pi, math.pi))
    along, across = np.array([math.cos(lies), math.sin(lies)]), np.array([-math.sin(lies), math.cos(lies)])
    pin = throw * np.array([math.cos(ahead), math.sin(ahead)])
    wrist = (pin @ along + math.sqrt(rod**2 - (offset - pin @ across) ** 2)) * along + offset * across
    lean = math.atan2(*(wrist - pin)[::-1])
    crank, link = m.bar("crank", throw, 1.0, (0.0, 0.0), float(rng.uniform(0.02, 0.2))), m.bar("rod", rod, 0.3)
    piston = m.body("piston", float(rng.uniform(0.2, 0.6)))
    m.revolute("main", m.ground.origin, crank.start)
    m.revolute("big_end", crank.end, link.start)
    m.revolute("wrist", link.end, piston.origin)
    beside, head = offset * across, 1.5 * (rod + throw) * along
    m.prismatic("liner", m.ground.at(float(beside[0]), float(beside[1]), lies), piston.origin)
    m.start_near(crank=math.degrees(ahead), rod=math.degrees(lean), piston=(*map(float, wrist), math.degrees(lies)))
    clockwise = bool(rng.random() < 0.5)
    speed = float(rng.uniform(60.0, 200.0)) * (-1.0 if clockwise else 1.0)
    m.gas_cycle(
        "gas", m.ground.at(float(head[0]), float(head[1]), lies + math.pi), piston.at(0.3 * throw, 0.0), crank,
        _cycle(rng), bore=1.9 * throw, clockwise=clockwise, outside=float(rng.choice([0.0, 101325.0])),
    )  # fmt: skip
    if driven:
        m.drive_angle("motor", crank, constant_rate(speed, ahead))
    else:
        m.start_moving(crank=speed)
    turn = 2 * math.pi / abs(speed)
    return Subject(m, turn * (1.0 if driven else 1.5), driven, None if driven else turn, _judge)


def _cycle(rng: np.random.Generator) -> GasCycle:
    if rng.random() < 0.3:
        angles = np.radians(np.arange(-180.0, 180.0, 15.0))
        return pressure_table(angles, 1e5 * (1.0 + 20.0 * np.exp(-((angles - 0.2) ** 2) / 0.3)), 1, compression=9.0)
    return two_stroke(
        float(rng.uniform(6.0, 12.0)), heat_density=float(rng.choice([0.0, rng.uniform(2e5, 1e6)])),
        start=float(rng.uniform(-0.4, 0.2)), duration=float(rng.uniform(0.6, 1.2)), n=float(rng.uniform(1.5, 4.0)),
        ports_open=float(rng.uniform(1.7, 2.2)), passage=float(rng.choice([0.0, 0.3])),
    )  # fmt: skip


def _judge(sol: Solution) -> list[str]:
    """Volumes by the angle of the crank, as numbers of the slider-crank have them."""
    out = []
    for placed in chambers(sol.packed):
        view, cycle = sol.force(placed.name), placed.chamber.cycle
        assert isinstance(view, GasView)
        assert view.crank_angle is not None
        if cycle is None or cycle.height is None:
            continue
        gap = np.abs(view.volume / placed.chamber.area - cycle.height(view.crank_angle))
        if not gap.max() < SLACK * cycle.displaced / placed.chamber.area:
            out.append(f"volume: '{placed.name}' is off by {gap.max():.3g} m at t = {sol.t[int(gap.argmax())]:.6g} s")
    return out
