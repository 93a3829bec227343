"""Measures of a page: its panels, the time that a plot shows, and marks of moments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator, MultipleLocator

from render.insights.loops import marks
from render.plots.style import QUIET, SIZE
from shared.contract import AnyMotion, Motion
from shared.contract.quantity import angle_step, figures, labelled, prefixed, written

# Quantities of an axis: its words with the unit, its numbers with the prefix that they need, ticks of angles, cuts.

TICKS = 5
"""Number of ticks on an axis, about; of angles one more."""
LETTER = 5.6
"""Points that a letter of an axis's words takes; words too long for a vertical axis have their unit below them."""
PEAK, KEPT = 12.0, 3.0
"""A curve is cut where it is so many times higher than usual, at so many times that."""
USUAL = 90.0
"""Percentile of the largest at each time."""
NEAR = 0.05
"""Fraction of the median of the margin: poses below are near a singular one."""


def dress_axis(axis: Axis, words: str, unit: str, ticks: int = TICKS) -> None:
    """Label an axis whose limits (SI, or degrees) are final, and write its numbers with one prefix."""
    low, high = axis.get_view_interval()
    factor, named = prefixed(max(abs(float(low)), abs(float(high))), unit)
    text = labelled(words, named)
    room = axis.axes.get_position().height * SIZE[1] * 72 / LETTER
    axis.set_label_text(text.replace(" / ", "\n/ ", 1) if axis is axis.axes.yaxis and len(text) > room else text)
    axis.set_major_formatter(FuncFormatter(lambda value, _: figures(value * factor)))
    if unit == "°":
        axis.set_major_locator(MultipleLocator(angle_step(abs(float(high - low)), ticks + 1)))
    else:
        axis.set_major_locator(MaxNLocator(nbins=ticks, steps=[1, 2, 2.5, 5, 10]))


def dress_plane(
    axes: Axes, words: tuple[str, str] = ("x", "y"), unit: str = "m", ticks: tuple[int, int] = (15, 9)
) -> None:
    """Label both axes of a plane (m or N) with one prefix; what is drawn on them is final."""
    axes.apply_aspect()
    largest = max(float(np.abs(axis.get_view_interval()).max()) for axis in (axes.xaxis, axes.yaxis))
    factor, named = prefixed(largest, unit)
    for axis, said, count in zip((axes.xaxis, axes.yaxis), words, ticks, strict=True):
        axis.set_label_text(labelled(said, named))
        axis.set_major_formatter(FuncFormatter(lambda value, _: figures(value * factor)))
        axis.set_major_locator(MaxNLocator(nbins=count, steps=[1, 2, 5, 10]))


def turned(x: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the curve of an angle (T,) in degrees over x (T,), within one turn.

    It is broken where the next turn begins. What makes no whole turn is moved by whole turns alone, so that its middle
    is within half a turn of zero.
    """
    if np.ptp(angle) < 360.0 - 1e-6:
        return x, angle - 360.0 * round(float(angle.max() + angle.min()) / 720.0)
    turn = np.floor((angle[:-1] + angle[1:]) / 720.0)
    out_x, out_y = [], []
    for piece in np.split(np.arange(len(turn)), np.flatnonzero(np.diff(turn)) + 1):
        rows = np.append(piece, piece[-1] + 1)
        out_x += [*x[rows], np.nan]
        out_y += [*np.clip(angle[rows] - 360.0 * turn[piece[0]], 0.0, 360.0), np.nan]
    return np.array(out_x[:-1]), np.array(out_y[:-1])


def cut(axes: Axes, curves: Sequence[np.ndarray], margin: np.ndarray | None, unit: str) -> bool:
    """Limit the vertical axis if curves (T,) go far out near a singular pose, and note it.

    ``margin`` (T,): how far each pose is from a singular one. Returns whether it was cut.
    """
    if margin is None or not len(curves):
        return False
    sizes = np.max([np.abs(values) for values in curves], axis=0)
    usual, top = float(np.percentile(sizes, USUAL)), int(sizes.argmax())
    if not sizes[top] > PEAK * usual > 0.0 or not margin[top] < NEAR * float(np.median(margin)):
        return False
    kept = np.concatenate([values[np.abs(values) <= KEPT * usual] for values in curves])
    low, high = min(float(kept.min()), 0.0), max(float(kept.max()), 0.0)
    axes.set_ylim(low - 0.08 * (high - low), high + 0.08 * (high - low))
    axes.text(
        0.995, 0.97, f"clipped: up to {written(float(sizes[top]), unit)} near a singular pose",
        transform=axes.transAxes, ha="right", va="top", color=QUIET, fontsize=8.5, zorder=6,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5, "alpha": 0.85},
    )  # fmt: skip
    return True


# The horizontal axis: the driver's angle where one angle drives the mechanism one way, time otherwise.

MOST_TICKS = 9


@dataclass(frozen=True)
class Horizon:
    """Values of the horizontal axis, rising, and what they are called."""

    values: np.ndarray
    words: str
    unit: str
    """s or °"""
    note: str = ""
    """After the label."""
    margin: np.ndarray | None = None
    """(T,) how far each pose is from a singular one."""

    @property
    def degrees(self) -> bool:
        """True if it is an angle."""
        return self.unit == "°"

    def dress(self, axes: Axes) -> None:
        """Set limits, ticks and the label of the lowest axes."""
        axes.set_xlim(self.values[0], self.values[-1])
        dress_axis(axes.xaxis, self.words, self.unit, MOST_TICKS)
        axes.set_xlabel(axes.get_xlabel() + self.note)


def horizon(motion: AnyMotion) -> Horizon:
    """Return the driver's angle in degrees, or time in s.

    It is time unless there is one driver, it is an angle and it never turns back. A driver that turns clockwise has its
    angle counted that way, so that what comes later is always at the right.
    """
    margin = np.asarray(motion.diagnostics.singularity_margin)
    if len(motion.drivers) == 1:
        ((name, driver),) = motion.drivers.items()
        angle = np.degrees(driver.value)
        moves = np.diff(angle)[np.diff(motion.time) > 0]  # both rows of an event have the same angle
        if driver.unit == "rad" and (np.all(moves > 0) or np.all(moves < 0)):
            clockwise = bool(np.all(moves < 0))
            angle = -angle if clockwise else angle
            angle = angle - 360.0 * round(float(angle[0]) / 360.0)
            words = f"{name} angle, clockwise" if clockwise else f"{name} angle"
            return Horizon(angle, words.replace("_", " "), "°", _pace(motion, angle), margin)
    return Horizon(np.asarray(motion.time), "time", "s", "", margin)


def _pace(motion: AnyMotion, angle: np.ndarray) -> str:
    """Return how long a turn takes, of a driver that turns evenly."""
    even = np.interp(motion.time, [motion.time[0], motion.time[-1]], [angle[0], angle[-1]])
    if np.abs(angle - even).max() > 1e-6 * np.ptp(angle):
        return ""
    return f"; a turn takes {written(float(360 * (motion.time[-1] - motion.time[0]) / np.ptp(angle)), 's', 4)}"


# Marks on the plots, over time or angle, what happens at one moment of a motion: dead points, impacts and others.

MOST = 12
"""Events on a page; of more, the first."""
LETTER_SIZE, LETTER_WIDTH = 8.5, 0.56
"""Size of the words (points), and the width of a letter in it."""
SPACE = 8.0
"""Points between the words of two marks at least; where there is less, the first has words alone."""


def mark(figure: Figure, over: Horizon, motion: Motion) -> None:
    """Draw a dotted line through all axes at each mark, with its words on top if there is room."""
    first, *_ = figure.axes
    width = first.get_position().width * figure.get_size_inches()[0] * 72.0
    low, high = first.get_xlim()
    taken: list[tuple[float, float]] = []
    for at, words in marks(motion)[:MOST]:
        x = float(np.interp(at, motion.time, over.values))
        for axes in figure.axes:
            axes.axvline(x, color=QUIET, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1.5)
        begin, end = _within(width, width * (x - low) / (high - low), LETTER_WIDTH * LETTER_SIZE * len(words))
        if all(end + SPACE < start or begin > stop + SPACE for start, stop in taken):
            taken.append((begin, end))
            _write(first, 0.5 * (begin + end) / width, words)


def _within(width: float, middle: float, length: float) -> tuple[float, float]:
    """Return the ends (points) of words of this length about ``middle``, moved into the axes' width."""
    begin = max(min(middle - 0.5 * length, width - length), 0.0)
    return begin, begin + length


def _write(axes: Axes, middle: float, words: str) -> None:
    axes.text(
        middle, 1.015, words.replace("_", " "), transform=axes.transAxes, color=QUIET, fontsize=LETTER_SIZE,
        ha="center", va="bottom",
    )  # fmt: skip
