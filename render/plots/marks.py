"""Marks on the plots, over time or angle, what happens at one moment of a motion: dead points, impacts and others."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import blended_transform_factory

from render.plots.horizon import Horizon
from render.plots.style import QUIET
from render.report.transmission import loops
from shared.contract import Motion

MOST = 12
"""Events on a page; of more, the first."""
STEP = 1e-6
"""Of the motion: times that are nearer are one."""
FEW = 6
"""Dead points on a page at most; of a crank that turns and turns they would say nothing."""
APART = 0.09
"""Of the page: nearer marks share the text of the first."""


def marks(motion: Motion) -> list[tuple[float, str]]:
    """Times (s) and words, in their order: dead points of driven cranks, and all events but the end."""
    time = np.asarray(motion.time)
    found = [(at, f"{loop.follower} turns back") for loop in loops(motion) for at, _ in loop.dead_points(time)]
    if motion.period:  # what is at the start of a period is at its end
        close = STEP * (time[-1] - time[0])
        ends = (time[0], time[-1])
        found += [(other, words) for at, words in found for end, other in (ends, ends[::-1]) if abs(at - end) < close]
    found = found if len(found) <= FEW else []
    found += [(event.time, f"{event.name}: {event.what}") for event in motion.events if event.what != "end"]
    return sorted(set(found))


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
