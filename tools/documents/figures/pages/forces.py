"""Forces as the test bench of the page measures them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GREEN, INK, MOVED, QUIET, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.4, 6.0), layout="constrained")
    axes = figure.subplots(2, 3)
    over_place = (
        (axes[0, 0], page.damper, "spring with damper"),
        (axes[0, 1], page.bumps, "curve of length: bump stops"),
        (axes[0, 2], page.air, "gas"),
        (axes[1, 0], page.wall, "contact with a wall at 40 mm"),
    )
    for ax, (x, _, force), title in over_place:
        _curve(ax, 1000 * x, force, BLUE)
        plain(ax, title=title, xlabel="place, mm", ylabel="force, N")
    _, speed, force = page.rubbing
    _curve(axes[1, 1], speed, force, MOVED)
    plain(axes[1, 1], title="friction of a guide", xlabel="speed, m/s", ylabel="force, N")
    _curve(axes[1, 2], 100 * page.slip, page.pull / 1000, GREEN)
    plain(axes[1, 2], title="tyre", xlabel="slip, %", ylabel="pull, kN")
    return {
        "forces.svg": figure,
        "engine.svg": _engine(page),
        "friction.svg": _friction(page),
        "excavator.svg": _excavator(page),
    }


def _engine(page: SimpleNamespace) -> Figure:
    """The indicator diagram of the engine, its pressure over the crank's angle, and the torque of its shaft."""
    figure = Figure(figsize=(10.4, 3.4), layout="constrained")
    indicated, over, torque = figure.subplots(1, 3)
    gas, crank = page.gas, np.degrees(page.gas.crank_angle)
    indicated.plot(1e6 * gas.volume, 1e-5 * gas.pressure, color=BLUE)
    plain(indicated, title="indicator diagram", xlabel="volume, cm³", ylabel="pressure, bar")
    over.plot(crank, 1e-5 * gas.pressure, color=BLUE)
    plain(over, title="pressure", xlabel="crank after firing, degrees", ylabel="pressure, bar")
    torque.plot(crank, -page.engine.driver("shaft").torque, color=MOVED)
    torque.axhline(0.0, color=INK, linewidth=0.6)
    plain(torque, title="what the shaft gives", xlabel="crank after firing, degrees", ylabel="torque, N m")
    for ax in (over, torque):
        ax.set_xticks(range(0, 721, 180))
    return figure


def _excavator(page: SimpleNamespace) -> Figure:
    """The arm as it starts and ends, pressures of its cylinders, and where the power of its pump goes."""
    figure = Figure(figsize=(10.4, 3.6), layout="constrained")
    arm, pressures, powers = figure.subplots(1, 3)
    sol, rams = page.digger, page.rams
    sol.draw(step=len(sol.t) - 1, ax=arm, names=False)
    for name, colour in zip(rams, (BLUE, GREEN, MOVED), strict=True):
        pressures.plot(sol.t, 1e-5 * rams[name].pressure_a, color=colour, label=name)
        pressures.plot(sol.t, 1e-5 * rams[name].pressure_b, color=colour, linestyle=(0, (4, 3)), linewidth=0.9)
    pressures.legend(frameon=False)
    plain(pressures, title="pressures; dashed: rod side", xlabel="time, s", ylabel="bar", xlim=(0, 5))
    for what, colour, name in (("supply_power", INK, "pump"), ("valve_loss", MOVED, "lost in valves"),
                               ("piston_power", BLUE, "pistons")):  # fmt: skip
        total = np.sum([getattr(ram, what) for ram in rams.values()], axis=0)
        powers.plot(sol.t, 1e-3 * total, color=colour, label=name)
    powers.axhline(0.0, color=INK, linewidth=0.6)
    powers.legend(frameon=False)
    plain(powers, title="power", xlabel="time, s", ylabel="kW", xlim=(0, 5), ylim=(-10, 130))
    return figure


def _friction(page: SimpleNamespace) -> Figure:
    """The gate: angle of both forms, and the torque of the friction of the one that sticks."""
    figure = Figure(figsize=(9.6, 4.2), layout="constrained")
    angle, torque = figure.subplots(1, 2)
    held, creeps, stop = page.held, page.creeps, page.stop.time
    for ax in (angle, torque):
        ax.axvspan(stop, held.t[-1], color=FAINT, linewidth=0)
        ax.axhline(0.0, color=INK, linewidth=0.6)
    for sol, colour, name in ((creeps, QUIET, "slip_speed: it creeps"), (held, BLUE, "sticks")):
        angle.plot(sol.t, np.degrees(sol.body("arm").theta) + 90, color=colour, label=name)
    angle.legend(frameon=False)
    plain(angle, title="grey: the pin sticks", xlabel="time, s", ylabel="angle from the lowest point, deg", xlim=(0, 8))
    for sign in (1, -1):
        torque.plot(held.t, sign * page.limit, color=QUIET, linewidth=0.8, linestyle=(0, (4, 3)))
    torque.plot(held.t, held.friction("rub").force, color=MOVED)
    plain(torque, title="dashed: its limit", xlabel="time, s", ylabel="friction of the pin, N m", xlim=(0, 8))
    return figure


def _curve(ax, x: np.ndarray, y: np.ndarray, colour: str) -> None:
    """A curve, with axes through zero."""
    ax.axhline(0.0, color=INK, linewidth=0.6)
    ax.axvline(0.0, color=INK, linewidth=0.6)
    ax.plot(x, y, color=colour)
