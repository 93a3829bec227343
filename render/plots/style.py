"""The look of every plot: one page, one set of colours, labels beside the lines they name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.transforms import blended_transform_factory
from scipy.optimize import isotonic_regression

SIZE = (10.0, 6.25)
"""Inches; 1600 x 1000 pixels."""
DPI = 160
INK = "#20252b"
QUIET = "#6b747e"
FAINT = "#d9dde1"
# Dark enough for text on white, apart from each other for colour-blind eyes as well.
PALETTE = ("#0b62a8", "#d1500a", "#00805e", "#a83a82", "#8a6d00", "#5a4fcf", "#b3261e", "#3b7d8c")
PARTS = ("#0f766e", "#9d3f86")
"""Colours of two parts of one thing, such as components and energies: no body has them."""
LABELLED = 10
"""Lines that get a label each; of more, the largest are labelled and the others drawn faint."""

RC: dict[Any, Any] = {
    "figure.dpi": DPI,
    "savefig.dpi": DPI,
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "text.color": INK,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.labelsize": 10.0,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.unicode_minus": True,
    "grid.color": "#e9ecef",
    "grid.linewidth": 0.8,
    "lines.linewidth": 1.9,
    "lines.solid_capstyle": "round",
    "xtick.color": QUIET,
    "ytick.color": QUIET,
    "xtick.labelsize": 9.0,
    "ytick.labelsize": 9.0,
    "xtick.major.size": 3.5,
    "ytick.major.size": 0.0,
    "text.parse_math": False,  # names are no formulas
}


LONGEST = 12
"""Letters of a label that has room at the right; longer ones are smaller."""
HALO = [withStroke(linewidth=3, foreground="white")]
"""Keeps text readable over lines."""


@contextmanager
def house_style() -> Iterator[None]:
    """The project's settings alone; a matplotlibrc of the user's does not change a plot."""
    with mpl.rc_context():
        mpl.rcdefaults()
        for key, value in RC.items():
            mpl.rcParams[key] = value
        yield


def page(mechanism: str, title: str, subtitle: str) -> Figure:
    """An empty figure with its title, upper left."""
    figure = Figure(figsize=SIZE)
    FigureCanvasAgg(figure)
    name = mechanism.replace("_", "-").capitalize()
    figure.text(0.035, 0.945, f"{name}: {title}", fontsize=15, fontweight="bold", va="center")
    figure.text(0.035, 0.903, subtitle, fontsize=10, color=QUIET, va="center")
    return figure


def rows(figure: Figure, count: int) -> list[Axes]:
    """Stacked axes that share x; room for labels at the right, titles above."""
    grid = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    figure.subplots_adjust(left=0.095, right=0.885, top=0.855, bottom=0.085, hspace=0.13)
    figure.align_ylabels(list(grid))
    return list(grid)


def colour(index: int) -> str:
    """The colour of the thing with this place in its file."""
    return PALETTE[index % len(PALETTE)]


def label_ends(axes: Axes, x: float, lines: Sequence[tuple[str, float, str]], gap: float = 13.0) -> None:
    """Write (text, y, colour) beside the right ends of lines; texts closer than ``gap`` points are spread apart."""
    if not lines:
        return
    low, high = axes.get_ylim()
    height = axes.get_position().height * SIZE[1] * 72
    wanted = np.array([(y - low) / (high - low) * height for _, y, _ in lines])
    placed = spread(wanted, gap, height)
    beside = blended_transform_factory(axes.transAxes, axes.transAxes)
    size = 9.5 * min(1.0, LONGEST / max(len(text) for text, _, _ in lines))
    for (text, _, ink), from_y, to_y in zip(lines, wanted / height, placed / height, strict=True):
        axes.plot([1.002, 1.014], [from_y, to_y], transform=beside, color=ink, linewidth=0.8, clip_on=False)
        axes.text(1.018, to_y, text, transform=beside, color=ink, va="center", fontsize=size)


def spread(wanted: np.ndarray, gap: float, height: float) -> np.ndarray:
    """Positions in the order of ``wanted``: ``gap`` apart where ``height`` has room, each near its own wish.

    Least squares: with ``gap`` times its rank taken off each wish, the answer need only not fall.
    """
    order = np.argsort(wanted, kind="stable")
    gap = min(gap, height / max(len(wanted) - 1, 1))
    ranks = gap * np.arange(len(wanted))
    placed = np.empty(len(wanted))
    placed[order] = np.clip(isotonic_regression(wanted[order] - ranks).x, 0.0, height - ranks[-1]) + ranks
    return placed
