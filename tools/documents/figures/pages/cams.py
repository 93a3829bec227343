"""The valve train, three lift laws, and the force of the cam at three speeds."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from mbsd.cams import RISES
from tools.documents.figures.look import BLUE, GREEN, INK, MOVED, WRONG, plain

LAWS = (("cycloidal", BLUE), ("3-4-5", GREEN), ("modified_sine", MOVED))


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(11.0, 4.8), layout="constrained")
    grid = figure.add_gridspec(3, 3, width_ratios=(0.75, 1.0, 1.15))
    skeleton = figure.add_subplot(grid[:, 0])
    page.runs[500].draw(step=80, ax=skeleton, frames=False)
    skeleton.set_title("40 degrees into the rise")
    laws = [figure.add_subplot(grid[k, 1]) for k in range(3)]
    _laws(laws)
    _force(figure.add_subplot(grid[:, 2]), page)
    return {"cams.svg": figure}


def _laws(axes: list) -> None:
    """Lift and derivatives of a unit rise over a unit angle."""
    u = np.linspace(0.0, 1.0, 201)
    for order, (ax, label) in enumerate(zip(axes, ("lift", "speed", "acceleration"), strict=True)):
        for name, colour in LAWS:
            ax.plot(u, RISES[name](u)[:, order], color=colour, linewidth=1.5, label=name.replace("_", " "))
        plain(ax, xlim=(0, 1), ylabel=label)
        ax.axhline(0.0, color=INK, linewidth=0.6)
        if order < 2:
            ax.tick_params(labelbottom=False)
    axes[0].set_title("laws, for a unit rise")
    axes[0].legend(loc="lower right", fontsize=8.5, handlelength=1.4, borderaxespad=0.1)
    axes[2].set_xlabel("part of the rise")


def _force(ax, page: SimpleNamespace) -> None:
    for (rpm, sol), colour in zip(page.runs.items(), (GREEN, BLUE, MOVED), strict=True):
        angle = np.degrees(sol.body("cam").theta - sol.body("cam").theta[0])
        shown = angle <= 140.0
        ax.plot(angle[shown], sol.joint("contact").fy[shown], color=colour, label=f"{rpm} rpm")
    ax.axhline(0.0, color=INK, linewidth=0.8)
    low = ax.get_ylim()[0]
    ax.axhspan(low, 0.0, color=WRONG, alpha=0.08, linewidth=0)
    ax.text(60.0, 0.93 * low, "here it would have to pull: the valve floats", color=WRONG, ha="center", fontsize=9)
    plain(ax, xlim=(0, 140), xticks=range(0, 141, 20), xlabel="cam angle, degrees", ylabel="cam on the valve, N")
    ax.set_ylim(bottom=low)
    ax.set_title("force of the cam")
    ax.legend(loc="upper center")
