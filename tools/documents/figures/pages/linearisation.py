"""The modes of the hanging chain, and its answer to a kick."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GREEN, INK, MOVED, QUIET, plain

NAMES = ("upper", "middle", "lower")


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
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
