"""The crane: where trolley and load are, and where the work of the motor goes."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GOLD, GREEN, INK, MOVED, QUIET, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(9.6, 6.4), layout="constrained")
    snaps, place, energy = figure.subplots(3, 1, height_ratios=(0.95, 0.75, 1.1))
    _snapshots(snaps, page)
    _places(place, page)
    _energy(energy, page)
    place.sharex(energy)
    return {"forward_dynamics.svg": figure}


def _snapshots(ax, page: SimpleNamespace) -> None:
    """Trolley and load at whole seconds."""
    sol = page.sol
    x, angle = sol.body("trolley").x, sol.body("load").theta
    ax.plot([-1.0, 7.0], [0.0, 0.0], color=INK, linewidth=1.2)
    for time in (0.0, 1.0, 1.5, 2.0, 2.5, 3.0):
        k = int(np.searchsorted(sol.t, time))
        end = x[k] + 2.0 * np.cos(angle[k]), 2.0 * np.sin(angle[k])
        ax.plot([x[k], end[0]], [0.0, end[1]], color=QUIET, linewidth=1.2)
        ax.plot(x[k], 0.0, "s", color=BLUE, markersize=9)
        ax.plot(*end, "o", color=MOVED, markersize=11)
        ax.annotate(f"{time:g} s", (x[k], 0.0), (0, 9), textcoords="offset points", ha="center", fontsize=8.5)
    ax.set(xlim=(-0.9, 6.5), ylim=(-2.3, 0.5), title="trolley and load; lengths in m")
    ax.set_aspect("equal")
    ax.set_yticks([0, -2])
    ax.spines[["top", "right", "left"]].set_visible(False)


def _places(ax, page: SimpleNamespace) -> None:
    sol = page.sol
    trolley, load = sol.body("trolley").x, sol.body("load")
    for low, high in ((0.2, 1.8), (2.2, 3.8)):
        ax.axvspan(low, high, color=FAINT, linewidth=0)
    ax.plot(sol.t, trolley, color=BLUE, label="trolley")
    ax.plot(sol.t, load.x + 2.0 * np.cos(load.theta), color=MOVED, label="load")
    ax.legend(loc="lower right", ncols=2)
    top = ax.get_ylim()[1] * 1.05
    ax.set_ylim(top=top * 1.12)
    ax.text(1.0, top, "motor pushes", ha="center", va="top", fontsize=9, color=QUIET)
    ax.text(3.0, top, "motor brakes", ha="center", va="top", fontsize=9, color=QUIET)
    plain(ax, ylabel="x, m")
    ax.tick_params(labelbottom=False)


def _energy(ax, page: SimpleNamespace) -> None:
    sol = page.sol
    height = sol.energy.potential - sol.energy.potential[0]
    parts = (sol.energy.kinetic, height, page.heat)
    names = ("kinetic energy", "potential energy", "heat of wheels and pin")
    ax.stackplot(sol.t, *parts, colors=(BLUE, GOLD, GREEN), alpha=0.35, labels=names, linewidth=0)
    ax.plot(sol.t, sol.work + page.heat, color=INK, linewidth=1.4, label="work of the motor")
    plain(ax, xlim=(0, sol.t[-1]), ylabel="J", xlabel="time, s")
    ax.set_ylim(bottom=0)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles[::-1], labels[::-1], loc="upper right")
