"""Marks on the plots, over time or angle, what happens at one moment of a motion: dead points, impacts and others."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from render.plots.horizon import Horizon
from render.plots.style import QUIET
from render.report.moments import marks
from shared.contract import Motion

MOST = 12
"""Events on a page; of more, the first."""
SIZE, LETTER = 8.5, 0.56
"""Size of the words (points), and the width of a letter in it."""
SPACE = 8.0
"""Points between the words of two marks at least; where there is less, the first has words alone."""


def mark(figure: Figure, over: Horizon, motion: Motion) -> None:
    """A dotted line through all axes at each mark, with its words above the first axes where there is room."""
    first, *_ = figure.axes
    width = first.get_position().width * figure.get_size_inches()[0] * 72.0
    low, high = first.get_xlim()
    taken: list[tuple[float, float]] = []
    for at, words in marks(motion)[:MOST]:
        x = float(np.interp(at, motion.time, over.values))
        for axes in figure.axes:
            axes.axvline(x, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1.5)
        begin, end = _within(width, width * (x - low) / (high - low), LETTER * SIZE * len(words))
        if all(end + SPACE < start or begin > stop + SPACE for start, stop in taken):
            taken.append((begin, end))
            _write(first, 0.5 * (begin + end) / width, words)


def _within(width: float, middle: float, length: float) -> tuple[float, float]:
    """Return where words of this length about ``middle`` begin and end, moved into the width of the axes (points)."""
    begin = max(min(middle - 0.5 * length, width - length), 0.0)
    return begin, begin + length


def _write(axes: Axes, middle: float, words: str) -> None:
    axes.text(
        middle, 1.015, words.replace("_", " "), transform=axes.transAxes, color=QUIET, fontsize=SIZE,
        ha="center", va="bottom",
    )  # fmt: skip
