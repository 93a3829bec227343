"""Hydraulic cylinders: pressures in both chambers, flows into them, and where the power of the supply goes."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from render.plots.horizon import horizon
from render.plots.inks import acting_on, apart
from render.plots.pages.rates import Line, draw
from render.plots.style import PARTS, page, rows
from render.report.written import written
from shared.contract import HydraulicMotion, Motion

BAR = 1e5
LITRES_PER_MINUTE = 1e-3 / 60.0
FEW = 4
"""Cylinders that are drawn; of more, those that take most of the supply."""


def hydraulics(motion: Motion) -> Figure:
    """Pressure (bar), flow (l/min) and power (W) over the motion; chamber B is paler."""
    known = [(name, force.hydraulics) for name, force in motion.forces.items() if force.hydraulics is not None]
    known.sort(key=lambda cylinder: -float(np.max(np.abs(cylinder[1].supply_power))))
    inks = apart([acting_on(motion, name) for name, _ in known[:FEW]])
    shown = [(name, cylinder, ink) for (name, cylinder), ink in zip(known, inks, strict=False)]
    over = horizon(motion)
    figure = page(motion.mechanism, "hydraulic cylinders", _subtitle(known))
    pressures, flows, powers = rows(figure, 3)
    draw(pressures, over, "pressure", "bar", _both(shown, "pressure", BAR))
    draw(flows, over, "flow", "l/min", _both(shown, "flow", LITRES_PER_MINUTE))
    lines: list[Line] = []
    for name, cylinder, ink in shown:
        lines.append((f"{name} supply", np.array(cylinder.supply_power), ink))
    if len(shown) == 1:
        [(_, cylinder, _)] = shown
        lines.append(("valve", np.array(cylinder.valve_loss), PARTS[0]))
        lines.append(("piston", np.array(cylinder.piston_power), PARTS[1]))
    draw(powers, over, "power", "W", lines)
    over.dress(powers)
    return figure


def _both(shown: list[tuple[str, HydraulicMotion, str]], what: str, unit: float) -> list[Line]:
    """Lines of chambers A and B of each."""
    lines: list[Line] = []
    for name, cylinder, ink in shown:
        for chamber, tint in (("a", ink), ("b", f"{ink}88")):
            lines.append((f"{name} {chamber.upper()}", np.array(getattr(cylinder, f"{what}_{chamber}")) / unit, tint))
    return lines


def _subtitle(known: list[tuple[str, HydraulicMotion]]) -> str:
    words = []
    for name, cylinder in known[:2]:
        highest = max(max(cylinder.pressure_a), max(cylinder.pressure_b))
        words.append(f"{name}: up to {written(highest, 'Pa')}")
    return "; ".join(words) + (f", and {len(known) - 2} more" if len(known) > 2 else "")
