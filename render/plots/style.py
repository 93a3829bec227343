"""The style of plots: colours, inks and labels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.transforms import blended_transform_factory
from scipy.optimize import isotonic_regression

from render.insights import insights
from shared.contract import Motion

# The look of every plot: one page, one set of colours, labels beside the lines they name.

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


LETTERS = 118
"""Letters of a sentence under a title, at most."""
LONGEST = 12
"""Letters of a label that has room at the right; longer ones are smaller."""
HALO = [withStroke(linewidth=3, foreground="white")]
"""Keeps text readable over lines."""


@contextmanager
def house_style() -> Iterator[None]:
    """Return the project's settings alone; a matplotlibrc of the user's does not change a plot."""
    with mpl.rc_context():
        mpl.rcdefaults()
        for key, value in RC.items():
            mpl.rcParams[key] = value
        yield


def page(mechanism: str, title: str, subtitle: str, shows: str = "") -> Figure:
    """Return an empty figure with its title, upper left, and under it a sentence on what it shows."""
    figure = Figure(figsize=SIZE)
    FigureCanvasAgg(figure)
    name = mechanism.replace("_", "-").capitalize()
    heights = (0.96, 0.922, 0.891) if shows else (0.945, 0.922, 0.903)
    figure.text(0.035, heights[0], f"{name}: {title}", fontsize=15, fontweight="bold", va="center")
    figure.text(0.035, heights[1], shows, fontsize=10, va="center")
    figure.text(0.035, heights[2], subtitle, fontsize=10, color=QUIET, va="center")
    return figure


def insight_under(motion: Motion, *kinds: str) -> str:
    """Return the sentence of the most telling insight of these kinds that fits under a title; empty without any."""
    sentences = (each.sentence() for each in insights(motion) if each.kind in kinds)
    return next((sentence for sentence in sentences if len(sentence) <= LETTERS), "")


def rows(figure: Figure, count: int) -> list[Axes]:
    """Return stacked axes that share x; room for labels at the right, titles above."""
    grid = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    figure.subplots_adjust(left=0.095, right=0.885, top=0.855, bottom=0.085, hspace=0.13)
    figure.align_ylabels(list(grid))
    return list(grid)


def colour(index: int) -> str:
    """Return the colour of the thing with this place in its file."""
    return PALETTE[index % len(PALETTE)]


def label_ends(axes: Axes, x: float, lines: Sequence[tuple[str, float, str]], gap: float = 13.0) -> None:
    """Write (text, y, colour) beside the right ends of lines.

    Texts closer than ``gap`` points are spread apart.
    """
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
    """Return positions at least ``gap`` apart, as ``height`` allows, each near its ``wanted`` one.

    They keep the order of ``wanted``. Least squares: with ``gap`` times its rank taken off each wish, the answer need
    only not fall.
    """
    order = np.argsort(wanted, kind="stable")
    gap = min(gap, height / max(len(wanted) - 1, 1))
    ranks = gap * np.arange(len(wanted))
    placed = np.empty(len(wanted))
    placed[order] = np.clip(isotonic_regression(wanted[order] - ranks).x, 0.0, height - ranks[-1]) + ranks
    return placed


# Colours of curves: that of the body it belongs to, as in every other picture (data.json).


def ink_of(motion: Motion, bodies: Sequence[str]) -> str:
    """Return the colour of the last of these bodies that moves.

    It is the one that a joint, driver or force acts on.
    """
    moving = [body for body in bodies if body in motion.bodies]
    return motion.bodies[moving[-1]].colour if moving else INK


def acting_on(motion: Motion, name: str) -> str:
    """Return the colour of the body that the force ``name`` acts on."""
    return ink_of(motion, [action.body for action in motion.forces[name].actions])


def apart(inks: Sequence[str]) -> list[str]:
    """Return these colours, each once.

    A second thing of one colour gets one that nothing has yet. Where there are no more, colours repeat.
    """
    free = [ink for ink in (*PARTS, *PALETTE) if ink not in inks]
    out: list[str] = []
    for ink in inks:
        out.append(free.pop(0) if ink in out and free else ink)
    return out


# Names beside the points they belong to, each on the side where most room is. Where points lie so close that names
# would cover each other, some stand farther away, at the end of a thin line.

DISTANCE = 15.0
"""Pixels between a point and its name."""
DIRECTIONS = np.radians(np.arange(45, 405, 45))
NEAR, FAR = (1.0, 2.0), (3.5, 5.0, 7.0, 9.0, 12.0, 16.0)
"""Distances of names, in steps: as a rule, and where there is no room."""
CLASH, OUTSIDE = 1000.0, 500.0
"""Costs of a name over another, and over the frame's edge, beside which points of lines under a name count one each."""


@dataclass(frozen=True)
class _Label:
    text: str
    at: tuple[float, float]
    colour: str
    size: float
    weight: str
    clearance: float


class Labels:
    """Collects names and what they must not cover, then places them one by one."""

    def __init__(self, axes: Axes) -> None:
        self.axes = axes
        self.labels: list[_Label] = []
        self.lines: list[np.ndarray] = []

    def add(
        self,
        text: str,
        at: tuple[float, float],
        colour: str,
        size: float = 10.5,
        weight: str = "normal",
        clearance: float = 0.0,
    ) -> None:
        """Add a name for the point ``at``, ``clearance`` away from it at least (data coordinates)."""
        self.labels.append(_Label(text, at, colour, size, weight, clearance))

    def avoid_lines(self, corners: list[tuple[float, float]]) -> None:
        """Add a line that the names should leave free (data coordinates)."""
        self.lines.append(np.asarray(corners, dtype=float))

    def write(self) -> None:
        """Place every name; the limits of the axes must be final in all but their aspect."""
        self.axes.apply_aspect()
        to_pixels = self.axes.transData.transform
        obstacles = np.concatenate(
            [_sampled(to_pixels(line)) for line in self.lines] + [to_pixels([label.at]) for label in self.labels]
            or [np.empty((0, 2))]
        )
        frame = self.axes.get_window_extent()
        boxes: list[np.ndarray] = []
        scale = self.axes.get_figure(root=True).dpi / 72  # type: ignore[union-attr]
        for label in self.labels:
            half = np.array([0.32 * label.size * len(label.text) + 2.0, 0.55 * label.size + 1.0]) * scale
            origin = to_pixels(label.at)
            away = max(DISTANCE, 4.0 + float(to_pixels((label.clearance, 0))[0] - to_pixels((0, 0))[0]))

            def cost(middle: np.ndarray, half: np.ndarray = half) -> float:
                return _cost(middle, half, obstacles, boxes, np.asarray(frame.extents))

            middle = min(_around(origin, half, [far * away for far in NEAR]), key=cost)
            if cost(middle) >= OUTSIDE:
                near = middle
                middle = min([near, *_around(origin, half, [far * DISTANCE for far in FAR])], key=cost)
                if middle is not near:
                    self._lead(origin, middle, half, label.colour)
            boxes.append(np.array([middle - half, middle + half]))
            x, y = self.axes.transData.inverted().transform(middle)
            self.axes.text(
                x, y, label.text, ha="center", va="center", color=label.colour, fontsize=label.size,
                fontweight=label.weight, path_effects=HALO, zorder=10,
            )  # fmt: skip

    def _lead(self, origin: np.ndarray, middle: np.ndarray, half: np.ndarray, colour: str) -> None:
        """Draw a thin line from a point to its name (pixels)."""
        way = origin - middle
        part = float(np.min(half / np.maximum(np.abs(way), 1e-9)))
        ends = self.axes.transData.inverted().transform([middle + min(part, 1.0) * way, origin])
        self.axes.plot(*ends.T, color=colour, linewidth=0.7, alpha=0.8, zorder=9, scalex=False, scaley=False)


def _around(origin: np.ndarray, half: np.ndarray, distances: Sequence[float]) -> list[np.ndarray]:
    """Return middles of names of a ``half`` size around a point at distances (pixels), the nearest first."""
    ways = [np.array([np.cos(a), np.sin(a)]) for a in DIRECTIONS]
    return [origin + way * (distance + half * np.abs(way)) for distance in distances for way in ways]


def _cost(
    middle: np.ndarray, half: np.ndarray, obstacles: np.ndarray, boxes: list[np.ndarray], frame: np.ndarray
) -> float:
    """Return how bad a place is: 1 for each point of a line under the name, much more for names and edges."""
    covered = float((np.abs(obstacles - middle) < half).all(axis=1).sum())
    near = float((np.abs(obstacles - middle) < half + 6.0).all(axis=1).sum())
    low, high = middle - half, middle + half
    clashes = sum(bool((low < box[1]).all() and (high > box[0]).all()) for box in boxes)
    outside = bool((low < frame[:2]).any() or (high > frame[2:]).any())
    return covered + 0.3 * near + CLASH * clashes + OUTSIDE * outside


def _sampled(corners: np.ndarray, step: float = 4.0) -> np.ndarray:
    """Return points every ``step`` pixels along a line."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
    at = np.arange(0.0, lengths[-1] + step, step)
    return np.stack([np.interp(at, lengths, corners[:, k]) for k in range(2)], axis=1)
