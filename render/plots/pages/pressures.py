"""Pages of gas and hydraulic pressures."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from render.plots.measures import horizon
from render.plots.pages.motion import Line, draw
from render.plots.style import PARTS, QUIET, acting_on, apart, label_ends, page, rows
from render.report.written import written
from shared.contract import GasMotion, HydraulicMotion, Motion
from shared.contract.quantity import angle_step, labelled

# The gas behind pistons: pressure over volume, the indicator diagram, and over the angle of the crank or the time.

BAR = 1e5
CUBIC_CENTIMETRE = 1e-6
FEW = 4
"""Chambers, of which the diagram has the lines of all; of more it has the first's."""


def gas(motion: Motion) -> Figure:
    """Return the indicator diagram of the first chambers, and the pressure in all of them.

    It is that of each chamber's last cycle.
    """
    known = list(_chambers(motion))
    inks = apart([acting_on(motion, name.removesuffix(BEHIND)) for name, _ in known])
    chambers = [(name, chamber, ink) for (name, chamber), ink in zip(known, inks, strict=True)]
    figure = page(motion.mechanism, "gas in the cylinders", _subtitle(chambers))
    indicated, over = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    figure.subplots_adjust(left=0.075, right=0.9, top=0.845, bottom=0.095, wspace=0.2)
    for name, chamber, ink in chambers[:FEW] if len(chambers) <= FEW else chambers[:1]:
        rows = _last_cycle(chamber)
        indicated.plot(
            np.array(chamber.volume)[rows] / CUBIC_CENTIMETRE,
            np.array(chamber.pressure)[rows] / BAR,
            color=ink,
            label=name,
        )
    outside = chambers[0][1].outside
    indicated.axhline(outside / BAR, color=QUIET, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
    indicated.set_xlabel(labelled("volume", "cm³"))
    indicated.set_ylabel(labelled("pressure", "bar"))
    indicated.set_ylim(bottom=min(0.0, indicated.get_ylim()[0]))
    _over_crank(over, motion, chambers)
    return figure


BEHIND = " (rod side)"


def _chambers(motion: Motion) -> Iterator[tuple[str, GasMotion]]:
    """Yield all chambers; of a double-acting cylinder both."""
    for name, force in motion.forces.items():
        if force.gas is not None:
            yield name, force.gas
        if force.gas_behind is not None:
            yield f"{name}{BEHIND}", force.gas_behind


def _over_crank(axes: Axes, motion: Motion, chambers: list[tuple[str, GasMotion, str]]) -> None:
    """Draw pressure over the angle since the firing, one cycle; over time if no crank is known."""
    turning = [chamber for _, chamber, _ in chambers if chamber.crank_angle is not None]
    ends = []
    for name, chamber, ink in chambers:
        pressure = np.array(chamber.pressure) / BAR
        if len(turning) < len(chambers) or chamber.crank_angle is None or chamber.cycle_angle is None:
            axes.plot(motion.time, pressure, color=ink, label=name)
            ends.append((name, float(pressure[-1]), ink))
            continue
        rows = _last_cycle(chamber)
        angle = np.degrees(np.array(chamber.crank_angle)[rows])
        period = math.degrees(chamber.cycle_angle)
        shown = (angle + period / 2) % period - period / 2
        order = np.flatnonzero(np.abs(np.diff(shown)) > period / 2) + 1
        for part in np.split(np.arange(len(shown)), order):
            axes.plot(shown[part], pressure[rows][part], color=ink, label=name)
        axes.set_xlim(-period / 2, period / 2)
        axes.xaxis.set_major_locator(MultipleLocator(angle_step(period)))
        ends.append((name, float(pressure[rows][np.argmax(shown)]), ink))
    over_angle = len(turning) == len(chambers)
    axes.set_xlabel(labelled("crank after firing", "°") if over_angle else labelled("time", "s"))
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    label_ends(axes, 0.0, ends)


def _last_cycle(chamber: GasMotion) -> np.ndarray:
    """Return rows of the last whole cycle, or of all where there is none."""
    everything = np.arange(len(chamber.pressure))
    if chamber.crank_angle is None or chamber.cycle_angle is None:
        return everything
    angle = np.array(chamber.crank_angle)
    return everything[np.abs(angle - angle[-1]) <= chamber.cycle_angle * (1.0 + 1e-9)]


def _subtitle(chambers: list[tuple[str, GasMotion, str]]) -> str:
    """Return the work of the first chambers in words."""
    words = []
    for name, chamber, _ in chambers[:2]:
        if chamber.indicated_work and chamber.displaced:
            work = float(np.mean(chamber.indicated_work))
            words.append(
                f"{name}: {written(work, 'J')} a cycle, "
                f"mean effective pressure {written(work / chamber.displaced, 'Pa')}"
            )
    more = f", and {len(chambers) - 2} more" if len(chambers) > 2 and words else ""
    return "; ".join(words) + more if words else "pressure over volume, and in time"


# Hydraulic cylinders: pressures in both chambers, flows into them, and where the power of the supply goes.

LITRES_PER_MINUTE = 1e-3 / 60.0


def hydraulics(motion: Motion) -> Figure:
    """Return the pressure (bar), flow (l/min) and power (W) over the motion; chamber B is paler."""
    known = [(name, force.hydraulics) for name, force in motion.forces.items() if force.hydraulics is not None]
    known.sort(key=lambda cylinder: -float(np.max(np.abs(cylinder[1].supply_power))))
    inks = apart([acting_on(motion, name) for name, _ in known[:FEW]])
    shown = [(name, cylinder, ink) for (name, cylinder), ink in zip(known, inks, strict=False)]
    over = horizon(motion)
    figure = page(motion.mechanism, "hydraulic cylinders", _oil_subtitle(known))
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
    """Return lines of chambers A and B of each."""
    lines: list[Line] = []
    for name, cylinder, ink in shown:
        for chamber, tint in (("a", ink), ("b", f"{ink}88")):
            lines.append((f"{name} {chamber.upper()}", np.array(getattr(cylinder, f"{what}_{chamber}")) / unit, tint))
    return lines


def _oil_subtitle(known: list[tuple[str, HydraulicMotion]]) -> str:
    words = []
    for name, cylinder in known[:2]:
        highest = max(max(cylinder.pressure_a), max(cylinder.pressure_b))
        words.append(f"{name}: up to {written(highest, 'Pa')}")
    return "; ".join(words) + (f", and {len(known) - 2} more" if len(known) > 2 else "")
