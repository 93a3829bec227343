"""The compressor: torque of its motor, with and without air, and the load of its crankpin."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GREEN, INK, MOVED, QUIET, note, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
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
