"""The shaper, and its ram over one turn of the crank."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GREEN, INK, MOVED, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(9.6, 5.0), layout="constrained")
    skeleton, *curves = _axes(figure)
    page.sol.draw(t=0.1, ax=skeleton)
    skeleton.set_title("at t = 0.1 s")
    degrees = page.sol.t * 360.0
    ram = page.stroke
    for ax, values, colour, label in zip(
        curves,
        (1000 * ram.x, ram.vx, ram.ax),
        (BLUE, GREEN, MOVED),
        ("place, mm", "speed, m/s", "acceleration, m/s²"),
        strict=True,
    ):
        ax.axvspan(degrees[page.left], degrees[page.right], color=FAINT, linewidth=0)
        ax.plot(degrees, values, color=colour)
        ax.axhline(0.0, color=INK, linewidth=0.6)
        plain(ax, xlim=(0, 360), xticks=np.arange(0, 361, 60))
        ax.set_ylabel(label, color=colour)
        ax.margins(y=0.08)
    curves[0].set_title("the ram; grey: the fast return, to the right")
    curves[-1].set_xlabel("crank angle, degrees")
    figure.align_ylabels(curves)
    return {"kinematics.svg": figure}


def _axes(figure: Figure) -> list:
    grid = figure.add_gridspec(3, 2, width_ratios=(0.9, 1.25))
    curves = [figure.add_subplot(grid[0, 1])]
    curves += [figure.add_subplot(grid[k, 1], sharex=curves[0]) for k in (1, 2)]
    for ax in curves[:2]:
        ax.tick_params(labelbottom=False)
    return [figure.add_subplot(grid[:, 0]), *curves]
