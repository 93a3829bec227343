"""Forces as the test bench of the page measures them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.figures.look import BLUE, GREEN, INK, MOVED, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """See tools/figures/__main__.py."""
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
    return {"forces.svg": figure}


def _curve(ax, x: np.ndarray, y: np.ndarray, colour: str) -> None:
    """A curve, with axes through zero."""
    ax.axhline(0.0, color=INK, linewidth=0.6)
    ax.axvline(0.0, color=INK, linewidth=0.6)
    ax.plot(x, y, color=colour)
