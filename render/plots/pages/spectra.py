"""Spectra: their computation, and their pages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator
from scipy.interpolate import CubicSpline

from render.magnitudes import crank_of
from render.plots.measures import dress_axis, horizon
from render.plots.pages.motion import draw
from render.plots.quantities import Quantity, quantity
from render.plots.style import INK, PARTS, QUIET, page
from shared.contract import Motion
from shared.contract.quantity import figures, labelled, written

# Amplitudes of the harmonics of what repeats with each turn or period; of all else a spectrum over frequency.
#
#     amplitude of order k     |2/N sum_n f_n exp(-2 pi i k n / N)|        f = mean + sum_k amplitude_k cos(k phi +
#     phase)
#
# N equal steps of a period, or of the angle of the crank in its last turn. What neither repeats nor turns is looked at
# through a Hann window, of which a harmonic of amplitude A keeps a peak of height A (F. J. Harris, "On the use of
# windows for harmonic analysis with the discrete Fourier transform", Proc. IEEE 66, 1978).

STEPS = 2048
"""Number of steps of one period or turn, where the rows are not equally far apart."""


@dataclass(frozen=True)
class Spectrum:
    """Amplitudes over orders of a period or of the crank, or over frequencies."""

    at: np.ndarray
    """(K,) orders, or frequencies (Hz); from 0."""
    amplitudes: np.ndarray
    """(K, ...) of the columns; at 0 the size of the mean."""
    harmonic: bool
    """True if ``at`` are orders."""
    base: float
    """Frequency of order 1 (Hz), on average where the speed varies; else the resolution."""
    over: str
    """Span of the transform, in words."""
    order_of: str
    """Name of the crank whose turns the orders count, or "period"."""


def spectrum(motion: Motion, values: np.ndarray) -> Spectrum:
    """Return the spectrum of series (T,) or (T, k) over the times of a motion."""
    time, crank = np.asarray(motion.time), crank_of(motion)
    if motion.period:
        turns = crank.turns if crank and crank.first == 0 else 1
        amplitudes = _amplitudes(_equal_steps(time, values))
        over = "one period" if turns == 1 and crank is None else "one turn" if turns == 1 else f"{turns} turns"
        return Spectrum(
            np.arange(len(amplitudes)) / turns, amplitudes, True, turns / motion.period,
            over + (f" of the {crank.body}" if crank else ""), crank.body if crank else "period",
        )  # fmt: skip
    if crank:
        ends = crank.angle[-1] - 2 * np.pi, crank.angle[-1]
        began = float(np.interp(ends[0], crank.angle[crank.first :], time[crank.first :]))
        amplitudes = _amplitudes(_resampled(crank.angle, values, np.linspace(*ends, STEPS, endpoint=False)))
        return Spectrum(
            np.arange(len(amplitudes), dtype=float), amplitudes, True, 1 / (time[-1] - began),
            f"the last turn of the {crank.body}", crank.body,
        )  # fmt: skip
    return _windowed(time, values)


def _windowed(time: np.ndarray, values: np.ndarray) -> Spectrum:
    count = max(STEPS, 2 * len(time))
    span = float(time[-1] - time[0])
    sampled = _resampled(time, values, time[0] + span * np.arange(count) / count)
    mean = sampled.mean(axis=0)
    window = 1 - np.cos(2 * np.pi * np.arange(count) / count)
    amplitudes = _amplitudes((sampled - mean) * window.reshape(-1, *(1,) * (values.ndim - 1)))
    amplitudes[0] = np.abs(mean)
    half = len(time) // 2 + 1  # above it lies nothing but what the interpolation added
    at = np.arange(half) / span
    return Spectrum(at, amplitudes[:half], False, 1 / span, f"{span:.4g} s, Hann window", "")


def _amplitudes(rows: np.ndarray) -> np.ndarray:
    """Return (N // 2 + 1, ...) of N equal steps that repeat."""
    out = np.abs(np.fft.rfft(rows, axis=0)) * (2 / len(rows))
    out[0] /= 2
    if len(rows) % 2 == 0:
        out[-1] /= 2
    return out


def _equal_steps(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the rows of a period without its end, resampled where they are not equally far apart."""
    steps = np.diff(time)
    if np.ptp(steps) <= 1e-6 * steps.mean():
        return values[:-1]
    return _resampled(time, values, np.linspace(time[0], time[-1], STEPS, endpoint=False))


def _resampled(x: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return values at ``at``: cubic splines, one between each two events, whose rows share their x."""
    out = np.empty((len(at), *values.shape[1:]))
    starts = [0, *(np.flatnonzero(np.diff(x) <= 0) + 1), len(x)]
    for low, high in pairwise(starts):
        inside = (at >= x[low]) & (at <= x[high - 1])
        if not inside.any():
            continue
        if high - low < 2:
            out[inside] = values[low]
        else:
            out[inside] = CubicSpline(x[low:high], values[low:high])(at[inside])
    return out


# The page of a spectrum: what was measured over a turn, and the amplitudes of its harmonics as stems.

SEEN = 1e-3
"""Fraction of the largest amplitude: the highest order that reaches it is the last one shown."""
FEWEST, MOST = 6, 24
"""Orders on a page."""
NUMBERED = 0.02
"""Fraction of the largest amplitude: smaller ones get no number."""
NOTHING = 1e-6
"""Fraction of the largest amplitude: smaller ones get no stem."""
ASIDE = 0.2
"""Between stems of one order, in orders; together they are centred on it."""
ROOMY = 12
"""Orders at most for a number at each stem."""


def spectrum_page(motion: Motion, name: str) -> Figure:
    """Return the time history and amplitudes of one quantity of :mod:`quantities`."""
    what = quantity(motion, name)
    lines = spectrum(motion, what.rows)
    orders = f"; orders of the {lines.order_of}" if lines.harmonic else ""
    figure = page(motion.mechanism, f"spectrum of {_article(name)}{name}", f"{what.says}; over {lines.over}{orders}")
    over = horizon(motion)
    upper, lower = figure.subplots(2, 1)
    figure.subplots_adjust(left=0.095, right=0.885, top=0.855, bottom=0.085, hspace=0.34)
    figure.align_ylabels([upper, lower])
    inks = dict(zip(what.components, PARTS if len(what.components) > 1 else (INK,), strict=False))
    draw(
        upper,
        over,
        what.symbol,
        what.unit,
        [(text, values, inks[text]) for text, values in zip(what.components, what.rows.T, strict=True)],
    )
    over.dress(upper)
    return _draw_amplitudes(figure, lower, what, lines, inks)


def _draw_amplitudes(figure: Figure, axes: Axes, what: Quantity, lines: Spectrum, inks: Mapping[str, str]) -> Figure:
    if lines.harmonic:
        stems(axes, lines, lines.amplitudes, list(inks.values()), list(inks))
        axes.set_xlabel(f"order of the {lines.order_of}; order 1 is {written(lines.base, 'Hz', 4)}")
    else:
        for column, (text, ink) in enumerate(inks.items()):
            axes.plot(lines.at[1:], lines.amplitudes[1:, column], color=ink, label=text)
        last = shown_orders(lines)
        axes.set_xlim(0.0, lines.at[min(last, len(lines.at) - 1)])
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(f"{labelled('frequency', 'Hz')}; resolved to {written(2 * lines.base, 'Hz', 2)}")
    dress_axis(axes.yaxis, "amplitude", what.unit)
    return figure


def stems(axes: Axes, lines: Spectrum, amplitudes: np.ndarray, inks: list[str], names: list[str]) -> None:
    """Draw a stem for each order above 0 and each column (K, k) of ``amplitudes``, with numbers on top.

    Stems of one order stand side by side with their middle on the order.
    """
    last = shown_orders(lines)
    at, shown = lines.at[1 : last + 1], amplitudes[1 : last + 1]
    step = float(at[0])
    columns = shown.shape[1]
    largest = float(shown.max(initial=0.0)) or 1.0
    drawn = shown > NOTHING * largest
    before = np.cumsum(drawn, axis=1) - drawn
    asides = ASIDE * step * (before - (drawn.sum(axis=1, keepdims=True) - 1) / 2)  # of those that are there
    for column in range(columns):
        aside, there = asides[:, column], drawn[:, column]
        ink, heights = inks[column], shown[:, column]
        axes.vlines((at + aside)[there], 0.0, heights[there], color=ink, linewidth=3.0, label=names[column], zorder=3)
        axes.plot((at + aside)[there], heights[there], "o", color=ink, markersize=5.5, zorder=4)
        for x, height in zip(at + aside, heights, strict=True):
            if height > NUMBERED * largest and len(at) <= ROOMY:
                axes.annotate(
                    figures(height, 3), (float(x), float(height)), (0, 5), textcoords="offset points", ha="center",
                    fontsize=9, color=ink,
                )  # fmt: skip
    axes.set_xlim(at[0] - 0.7 * step, at[-1] + 0.7 * step)
    axes.set_ylim(0.0, 1.16 * largest)
    axes.xaxis.set_major_locator(MultipleLocator(1.0 if at[-1] <= ROOMY else 2.0))
    axes.grid(visible=False, axis="x")
    axes.locator_params(axis="y", nbins=5)
    if columns > 1:
        _legend(axes, inks, names)
    if not shown.any():
        axes.text(
            0.5, 0.5, "nothing but rounding", transform=axes.transAxes, ha="center", va="center", color=QUIET,
        )  # fmt: skip


def _legend(axes: Axes, inks: list[str], names: list[str]) -> None:
    for row, (ink, name) in enumerate(zip(inks, names, strict=True)):
        axes.text(
            0.985, 0.93 - 0.1 * row, name.replace("_", " "), transform=axes.transAxes, ha="right", va="top", color=ink,
            fontsize=9.5,
        )  # fmt: skip


def shown_orders(lines: Spectrum) -> int:
    """Return the highest row that is shown."""
    sizes = lines.amplitudes[1:].max(axis=tuple(range(1, lines.amplitudes.ndim)))
    seen = np.flatnonzero(sizes >= SEEN * sizes.max(initial=0.0)) if sizes.max(initial=0.0) > 0 else np.array([])
    last = int(seen[-1]) + 1 if len(seen) else 1
    if not lines.harmonic:
        return min(max(int(1.1 * last), 8), len(lines.at) - 1)
    least, most = (int(np.searchsorted(lines.at, n)) for n in (FEWEST, MOST))
    return min(max(last, least), most, len(lines.at) - 1)


def _article(name: str) -> str:
    return "the " if name.startswith("shaking") else ""
