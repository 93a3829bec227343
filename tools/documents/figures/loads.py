"""Pictures of pages about forces: drives, springs, gas, balance of engines, equilibrium and vibration."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from mbsd.machines.engines.bank_angles import NOTHING
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.vibration_slider_crank.mechanism import Params, build
from render.plots.pages.spectra import spectrum_page
from render.plots.style import house_style
from tools.documents.figures.look import BLUE, FAINT, GREEN, INK, MOVED, QUIET, WRONG, note, plain


def inverse_dynamics(page: SimpleNamespace) -> dict[str, Figure]:
    """The compressor: torque of its motor, with and without air, and the load of its crankpin."""
    sol = page.sol
    figure = Figure(figsize=(10.2, 5.0), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.1, 1.0), height_ratios=(0.8, 1.0))
    skeleton, torque = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    _polar(figure.add_subplot(grid[:, 1]), page)
    page.m.with_efforts(push=None).sweep(steps=720).draw(t=0.006, ax=skeleton)
    skeleton.set_title("at 54 degrees")
    degrees = sol.t / sol.t[-1] * 360.0
    alone = page.m.with_efforts(air=None)
    alone.drivers["motor"] = page.m.drivers["motor"]
    inertia = alone.sweep(steps=720).driver("motor").torque
    torque.plot(degrees, inertia, color=GREEN, linewidth=1.4, linestyle=(0, (5, 2)), label="to move the masses")
    torque.plot(degrees, page.motor.torque, color=BLUE, label="and to compress the air")
    torque.axhline(0.0, color=INK, linewidth=0.6)
    plain(torque, xlim=(0, 360), xticks=np.arange(0, 361, 60), title="torque of the motor")
    torque.set(xlabel="crank angle, degrees", ylabel="torque, N m")
    torque.set_ylim(-21, 29)
    torque.legend(loc="upper center", ncols=2, handlelength=2.6)
    return {"inverse_dynamics.svg": figure}


def _polar(ax, page: SimpleNamespace) -> None:
    """The force on the rod as a curve, with the crank angle along it."""
    fx, fy = page.pin.fx, page.pin.fy
    ax.plot(fx, fy, color=MOVED)
    ax.axhline(0.0, color=QUIET, linewidth=0.6)
    ax.axvline(0.0, color=QUIET, linewidth=0.6)
    for k in range(0, 720, 120):
        ax.plot(fx[k], fy[k], "o", color=MOVED, markersize=4)
        away = np.array([fx[k] - fx.mean(), fy[k]])
        away = 22.0 * away / np.hypot(*away)
        note(ax, f"{k // 2}°", (fx[k], fy[k]), (away[0], away[1]), INK)
    plain(ax, title="crankpin: force on the rod", xlabel="x, N", ylabel="y, N")
    ax.set(xlim=(-60, 1340), ylim=(-480, 480))
    ax.set_aspect("equal", adjustable="box")


def forces(page: SimpleNamespace) -> dict[str, Figure]:
    """Forces as the test bench of the page measures them."""
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
    """Draw the engine's indicator diagram, its pressure over the crank angle, and the shaft's torque."""
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


def engines(page: SimpleNamespace) -> dict[str, Figure]:
    """Unbalanced forces of V engines over their bank angle, and the angles that fire evenly."""
    figure = Figure(figsize=(9.6, 8.4), layout="constrained")
    axes = figure.subplots(4, 3, sharex=True)
    for ax, chart in zip(axes.ravel(), page.maps, strict=True):
        left = chart.left(counterweights=True)
        for row, colour, words in ((0, MOVED, "first order"), (1, BLUE, "second order")):
            values = np.where(left.rank(row) < NOTHING, 0.0, left.rank(row))
            ax.plot(chart.angle, values, color=colour, label=words, clip_on=False)
        even = chart.angle[chart.uneven < 1e-3]
        ax.plot(
            even, 0 * even, "|", color=GREEN, markersize=9, markeredgewidth=1.6, label="fires evenly", clip_on=False
        )
        ax.axvline(chart.best, color=QUIET, linewidth=0.9, linestyle=(0, (3, 3)))
        beside = {"x": chart.best - 3, "ha": "right"} if chart.best > 150 else {"x": chart.best + 3, "ha": "left"}
        place = ax.get_xaxis_transform()
        ax.text(y=0.97, s=f"{chart.best:g}°", transform=place, va="top", color=QUIET, fontsize=9, **beside)
        top = max(left.rank(0).max(), left.rank(1).max())
        plain(ax, xlim=(0, 180), ylim=(0, 1.05 * top if top > NOTHING else 1.0), xticks=range(0, 181, 45))
        ax.set_title(chart.family.name)
    for ax in axes[-1]:
        ax.set_xlabel("between the banks, degrees")
    for ax in axes[:, 0]:
        ax.set_ylabel("m r ω²")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return {"engines.svg": figure, "engine_mounts.svg": _mounts(page)}


def _mounts(page: SimpleNamespace) -> Figure:
    """The steady response on soft and stiff mounts; two run-ups; the part of the peak that is reached."""
    figure = Figure(figsize=(9.6, 6.4), layout="constrained")
    (moved, turned), (passing, left) = figure.subplots(2, 2)
    rpm = page.RPM * page.speeds
    for colour, (frequency, response) in zip((MOVED, BLUE), page.response.items(), strict=True):
        words = f"{frequency:g} Hz mounts"
        moved.plot(rpm, 1000 * response.largest_displacement(), color=colour, label=words)
        turned.plot(rpm, 1000 * response.largest_angle(), color=colour, label=words)
    for ax, title, unit in (
        (moved, "displacement at constant speed", "mm"),
        (turned, "angle at constant speed", "mrad"),
    ):
        plain(ax, xlim=(0, 2000), xlabel="rpm", ylabel=unit)
        ax.set_ylim(bottom=0)
        ax.set_title(title)
        ax.legend()
    for colour, (rate, run) in zip((GREEN, MOVED), page.runs.items(), strict=True):
        speed, y = page.RPM * run.body("crank").omega, 1000 * run.body("block").y
        passing.plot(speed[::3], y[::3], color=colour, linewidth=1.0, label=f"{rate:g} rpm/s")
    steady = 1000 * page.response[8.0].largest_displacement()
    for side in (-1, 1):
        passing.plot(rpm, side * steady, color=QUIET, linewidth=1.0, linestyle=(0, (3, 3)))
    plain(passing, xlim=(100, 700), xlabel="rpm", ylabel="mm")
    passing.set_title("run-ups on 8 Hz mounts, steady dashed")
    passing.legend(loc="upper right")
    rates = np.geomspace(20, 10_000, 40)
    mode = page.response[8.0].modes[0]
    for colour, damping_ratio in zip((MOVED, BLUE, GREEN), (0.05, 0.1, 0.2), strict=True):
        reached = [page.run_up(mode.frequency, damping_ratio, rate / page.RPM, order=2).reached for rate in rates]
        left.plot(rates, reached, color=colour, label=f"damping ratio {damping_ratio:g}")
    plain(left, xscale="log", xlim=(20, 10_000), ylim=(0, 1.15), xlabel="rpm/s", ylabel="peak over steady peak")
    left.set_title("second order through 7.8 Hz")
    left.legend()
    return figure


def statics(page: SimpleNamespace) -> dict[str, Figure]:
    """The switch: its potential energy and equilibria, and how it snaps under load."""
    figure = Figure(figsize=(10.6, 4.2), layout="constrained")
    skeleton, energy, snap = figure.subplots(1, 3, width_ratios=(0.85, 1.0, 1.0))
    page.right.start(page.pushed)
    page.pushed.draw(ax=skeleton, frames=False)
    skeleton.set_title("the lever on the right")
    _energy(energy, page)
    _snap(snap, page)
    return {"statics.svg": figure}


def _potential(angle: np.ndarray) -> np.ndarray:
    """J, of the lever and the spring of the page."""
    length = np.hypot(0.2 * np.cos(angle), 0.2 * np.sin(angle) - 0.3)
    return 0.5 * 800.0 * (length - 0.16) ** 2 + 0.4 * 9.80665 * 0.1 * np.sin(angle)


def _energy(ax, page: SimpleNamespace) -> None:
    angle = np.linspace(45.0, 135.0, 181)
    ax.plot(angle, _potential(np.radians(angle)), color=INK)
    for pose, colour in ((page.right, GREEN), (page.middle, WRONG), (page.left, GREEN)):
        at = np.degrees(pose.body("lever").theta), pose.energy.potential
        ax.plot(*at, "o", color=colour, markersize=8)
        note(ax, pose.stability, at, (0, 26), colour)
    plain(ax, xlim=(135, 45), ylim=(0.25, 2.1), xticks=np.arange(45, 136, 15), xlabel="angle of the lever, degrees")
    ax.set(ylabel="potential energy, J", title="three poses balance")


def _snap(ax, page: SimpleNamespace) -> None:
    angles, jump = np.array(page.angles), page.jump
    every = np.linspace(45.0, 135.0, 721)
    slope = np.gradient(_potential(np.radians(every)), np.radians(every))
    stable = np.gradient(slope, every) > 0
    for holds, style in ((stable, "-"), (~stable, (0, (4, 3)))):
        part = np.where(holds, slope, np.nan)
        ax.plot(part, every, color=QUIET, linewidth=1.1, linestyle=style)
    ax.plot(page.torques, angles, "o", color=BLUE, markersize=3.6)
    ax.annotate(
        "",
        xy=(page.torques[jump + 1], angles[jump + 1]),
        xytext=(page.torques[jump], angles[jump]),
        arrowprops={"arrowstyle": "-|>", "color": MOVED, "linewidth": 1.4, "shrinkA": 4, "shrinkB": 4},
    )
    ax.text(page.torques[jump] + 0.2, 95.0, "snaps", color=MOVED, va="center", rotation=90)
    plain(ax, xlim=(-6, 6), ylim=(45, 135), yticks=np.arange(45, 136, 15))
    ax.set(xlabel="torque of the hand, N m", ylabel="angle of rest, degrees", title="pushed until it snaps")


NAMES = ("upper", "middle", "lower")


def linearisation(page: SimpleNamespace) -> dict[str, Figure]:
    """The modes of the hanging chain, and its answer to a kick."""
    figure = Figure(figsize=(10.4, 4.6), layout="constrained")
    grid = figure.add_gridspec(1, 4, width_ratios=(1, 1, 1, 2.6))
    for k, (mode, colour) in enumerate(zip(page.linear.modes, (BLUE, GREEN, MOVED), strict=True)):
        _shape(figure.add_subplot(grid[k]), mode, colour, k)
    _response(figure.add_subplot(grid[3]), page)
    return {"linearisation.svg": figure}


def _chain(turns: np.ndarray) -> np.ndarray:
    """(4, 2) pins of the chain whose links are turned from hanging (rad)."""
    steps = 0.5 * np.stack([np.sin(turns), -np.cos(turns)], axis=1)
    return np.vstack([np.zeros(2), np.cumsum(steps, axis=0)])


def _shape(ax, mode, colour: str, number: int) -> None:
    turns = np.array([np.real(mode.of(name)[2]) for name in NAMES])
    turns *= np.sign(turns[0]) * 0.42 / np.abs(turns).max()
    ax.plot(*_chain(np.zeros(3)).T, color=QUIET, linewidth=1.0, linestyle=(0, (4, 3)))
    for part in np.linspace(-1.0, 1.0, 9)[1:-1]:
        ax.plot(*_chain(part * turns).T, color=FAINT, linewidth=1.2)
    ax.plot(*_chain(-turns).T, "-o", color=colour, alpha=0.35, markersize=4)
    ax.plot(*_chain(turns).T, "-o", color=colour, linewidth=2.6, markersize=5)
    ax.plot(0, 0, "^", color=INK, markersize=9)
    ax.set(xlim=(-0.62, 0.62), ylim=(-1.6, 0.1), xticks=[], yticks=[])
    ax.set_aspect("equal")
    ax.spines[:].set_visible(False)
    ax.set_title(
        f"mode {number + 1}: {mode.frequency:.2f} Hz\nζ = {mode.damping_ratio:.3f}", loc="center", color=colour
    )


def _response(ax, page: SimpleNamespace) -> None:
    sol = page.sol
    ax.plot(sol.t, np.degrees(page.swing), color=BLUE, label="simulated")
    predicted = np.degrees(page.predicted[:, 2])
    ax.plot(sol.t, predicted, color=MOVED, linewidth=1.4, linestyle=(0, (4, 3)), label="from A and B")
    ax.axhline(0.0, color=INK, linewidth=0.6)
    plain(ax, xlim=(0, sol.t[-1]), xlabel="time, s", ylabel="lower link, degrees")
    ax.set_title("after a kick at the upper link")
    ax.legend(loc="upper right", ncols=2)
    ax.margins(y=0.16)


def mechanisms(page: SimpleNamespace) -> dict[str, Figure]:
    """A spectrum as ``make plot-<name>`` draws it, of the slider-crank that shakes its machine.

    No joint of this mechanism needs masses other than its own.
    """
    m = build(Params())
    motion = to_motion(m.sweep(), None, "", {}, dict.fromkeys(m.bodies, "mechanism"))
    with house_style():
        return {"spectrum.svg": spectrum_page(motion, "shaking force")}


PAGES = (inverse_dynamics, forces, engines, statics, linearisation, mechanisms)
