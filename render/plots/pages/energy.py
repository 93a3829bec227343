"""Energy and power of the mechanism, its drivers and its forces, and the energy lost in impacts."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

from render.magnitudes import centre_of_mass, energy_floor, power_floor, without_noise
from render.plots.measures import Horizon, horizon
from render.plots.pages.motion import draw
from render.plots.style import INK, PARTS, QUIET, insight_under, page, rows
from shared.contract import EventMark, Motion
from shared.contract.quantity import counted, written

BALANCED = 2e-3
"""The elastic energy is known at the samples alone; its rate is this good, relative to the largest power."""
ENERGIES = ("power_sign", "losses", "energy_kept", "decay", "no_effort")
"""Kinds of insights under the title of the page."""
MARKED = 12
"""Impacts that are marked with what they take; of more, those that take most."""


def energy(motion: Motion) -> Figure:
    """Return energies (J) from their start, and the power balance (W), with what impacts take at once (J)."""
    over = horizon(motion)
    floor = energy_floor(motion)
    kinetic = without_noise(np.asarray(motion.energy.kinetic), floor)
    gained = without_noise(np.asarray(motion.energy.potential) - motion.energy.potential[0], floor)
    given, rate = powers(motion)
    impacts = sorted(_impacts(motion, floor), key=lambda event: event.energy)
    figure = page(motion.mechanism, "energy and power", statement(motion), insight_under(motion, *ENERGIES))
    upper, lower = rows(figure, 2)
    lines = [("kinetic", kinetic, PARTS[0]), ("Δ potential", gained, PARTS[1])]
    draw(upper, over, "energy", "J", [*lines, ("total", kinetic + gained, INK)], floor=floor)
    lines = [("drivers", given, PARTS[0])] if motion.drivers else []
    others = rate - given
    tolerance = _tolerance(motion, given, rate)
    if np.abs(others).max() > tolerance:
        lines += [("other forces", np.where(np.abs(others) > tolerance, others, 0.0), PARTS[1])]
    draw(lower, over, "power", "W", lines or [("none", given, PARTS[0])], floor=power_floor(motion))
    if motion.drivers:
        lower.lines[0].set(linewidth=5.0, alpha=0.35)
    lower.plot(over.values, rate, color=INK, linewidth=1.2, linestyle=(0, (5, 3)), zorder=4)
    said = "dashed: d(kinetic + potential)/dt" + ("     wide: power of the drivers" if motion.drivers else "")
    lower.text(0.0, 1.02, said, transform=lower.transAxes, color=QUIET, fontsize=9, va="bottom")
    _mark(upper, over, motion, impacts[:MARKED])
    over.dress(lower)
    return figure


def powers(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Return (T,) power of all drivers, and the rate of kinetic and potential energy (W).

    Rounding counts as zero. Rates of the kinetic energy and of weights follow from velocities and accelerations, so
    they are right at either side of an impact; that of elastic energy is the slope between samples, never across an
    event.
    """
    time = np.asarray(motion.time)
    given = np.sum([driver.power for driver in motion.drivers.values()], axis=0) if motion.drivers else 0.0 * time
    rate, weight = 0.0 * time, 0.0 * time
    gx, gy = motion.gravity
    for body in motion.bodies.values():
        at = centre_of_mass(body)
        rate = rate + body.mass * (at.vx * (at.ax - gx) + at.vy * (at.ay - gy))
        rate = rate + body.inertia * np.multiply(body.omega, body.alpha)
        weight = weight - body.mass * (gx * at.x + gy * at.y)
    elastic = np.asarray(motion.energy.potential) - weight
    if np.ptp(elastic) > energy_floor(motion):
        rate = rate + _slope(time, elastic)
    floor = power_floor(motion)
    return without_noise(given, floor), without_noise(rate, floor)


def statement(motion: Motion) -> str:
    """Return the sentence that is true of this motion's energy balance."""
    given, rate = powers(motion)
    others, floor = rate - given, energy_floor(motion)
    largest = float(np.abs(others).max())
    if largest > _tolerance(motion, given, rate):
        givers = "drivers and other forces" if motion.drivers else "forces without potential"
        text = f"power of {givers} (friction, dampers, loads; up to {written(largest, 'W')}) is the rate of the energy"
    elif motion.drivers:
        text = "the drivers' power is the rate of the energy"
    else:
        text = "nothing gives or takes power: the energy stays"
    impacts = _impacts(motion, floor)
    if not impacts:
        return text
    taken = -sum(event.energy for event in impacts)
    takes = "takes" if len(impacts) == 1 else "take"
    return f"{text}, but for {counted(len(impacts), 'impact')} that {takes} {written(taken, 'J')} at once"


def _tolerance(motion: Motion, given: np.ndarray, rate: np.ndarray) -> float:
    """Return the power (W) below which the difference of the two says nothing."""
    largest = max(float(np.abs(given).max()), float(np.abs(rate).max()))
    return max(BALANCED * largest, 10 * power_floor(motion), 10 * motion.diagnostics.power_residual)


def _impacts(motion: Motion, floor: float) -> list[EventMark]:
    """Return marks of events that changed the kinetic energy at once."""
    return [event for event in motion.events if abs(event.energy) > floor]


def _slope(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (T,) derivative, piece by piece between samples that share a time."""
    out = np.zeros(len(time))
    for piece in np.split(np.arange(len(time)), np.flatnonzero(np.diff(time) <= 0) + 1):
        if len(piece) > 1:
            out[piece] = np.gradient(values[piece], time[piece], edge_order=2 if len(piece) > 2 else 1)
    return out


def _mark(axes: Axes, over: Horizon, motion: Motion, impacts: list[EventMark]) -> None:
    """Draw a line at each impact with the energy it takes; where they crowd, only the largest get numbers."""
    placed: list[float] = []
    span = float(over.values[-1] - over.values[0])
    beside = blended_transform_factory(axes.transData, axes.transAxes)
    for event in impacts:
        x = float(np.interp(event.time, motion.time, over.values))
        axes.axvline(x, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1.5)
        if all(abs(x - other) > 0.07 * span for other in placed):
            placed.append(x)
            axes.text(
                x, 1.015, f"{'+' * (event.energy > 0)}{written(event.energy, 'J')}", transform=beside, color=QUIET,
                fontsize=9, ha="center", va="bottom",
            )  # fmt: skip
