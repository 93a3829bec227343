"""Marks on the plots, over time or angle, what happens at one moment of a motion: dead points, impacts and others."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

from render.plots.horizon import Horizon
from render.plots.style import QUIET
from render.report.moments import marks
from shared.contract import Motion

MOST = 12
"""Events on a page; of more, the first."""
APART = 0.09
"""Fraction of the page: nearer marks share the text of the first."""


def mark(figure: Figure, over: Horizon, motion: Motion) -> None:
    """A dotted line through all axes at each mark, with its words above the first axes where there is room."""
    first, *_ = figure.axes
    span = abs(float(over.values[-1] - over.values[0]))
    placed: list[float] = []
    for at, words in marks(motion)[:MOST]:
        x = float(np.interp(at, motion.time, over.values))
        for axes in figure.axes:
            axes.axvline(x, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1.5)
        if all(abs(x - other) > APART * span for other in placed):
            placed.append(x)
            _write(first, x, words)


def _write(axes: Axes, x: float, words: str) -> None:
    """Above the axes, within their width."""
    low, high = axes.get_xlim()
    part = (x - low) / (high - low)
    side = "left" if part < 0.08 else "right" if part > 0.92 else "center"
    above = blended_transform_factory(axes.transData, axes.transAxes)
    axes.text(x, 1.015, words.replace("_", " "), transform=above, color=QUIET, fontsize=8.5, ha=side, va="bottom")
