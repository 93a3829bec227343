"""Spread of a result: a histogram with its limits, and each dimension's part in the variance.

It takes what :class:`mbsd.Tolerances` has, by name, and knows no more of it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.quantity import counted
from mbsd.drawing.look import FAINT, INK, PALETTE, QUIET, WRONG, literal
from mbsd.pictures import Picture

MOST_BARS = 12
"""Dimensions that are shown; the rest is one bar."""
BINS = 60
HIGH = 0.82
"""Part of the height that lines take; words are above."""
FAR = 1.5
"""Widths of the histogram beyond which a limit is not drawn."""
GOOD, LATER = PALETTE[0], PALETTE[3]


@literal
def draw_tolerances(t: Any, axes: Any = None) -> Picture:
    """Draw into two ``axes``, or a figure of its own.

    Raises ModelError without matplotlib, or for other axes.
    """
    own = axes is None
    left, right = _axes() if own else _two(axes)
    _histogram(left, t)
    _bars(right, t)
    return Picture(left, own)


def _axes() -> Any:
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise ModelError("plot needs matplotlib: install mbsd[draw]") from error
    return Figure(figsize=(10.0, 4.2), layout="constrained").subplots(1, 2, width_ratios=(1.3, 1.0))


def _two(axes: Any) -> Any:
    try:
        left, right = axes
    except (TypeError, ValueError):
        raise ModelError("plot: ax must be two axes, as figure.subplots(1, 2) gives") from None
    return left, right


def _histogram(ax: Any, t: Any) -> None:
    values = t.values[t.good]
    edges = np.histogram_bin_edges(values, min(BINS, max(10, int(np.sqrt(len(values))))))
    low, high = t.limits or (None, None)
    counts, _ = np.histogram(values, edges)
    middle = 0.5 * (edges[1:] + edges[:-1])
    bad = ((middle < low) if low is not None else False) | ((middle > high) if high is not None else False)
    colours = np.where(np.broadcast_to(bad, middle.shape), WRONG, GOOD)
    ax.bar(edges[:-1], counts, np.diff(edges), align="edge", color=colours, alpha=0.75, linewidth=0)
    _line(ax, t.nominal, "nominal", INK, "-")
    for side in t.vertex_worst or t.linear_worst:
        _line(ax, side, "worst case", QUIET, ":")
    near = (edges[0] - FAR * (edges[-1] - edges[0]), edges[-1] + FAR * (edges[-1] - edges[0]))
    for limit in (low, high):
        if limit is not None and near[0] <= limit <= near[1]:
            _line(ax, limit, "limit", WRONG, "--")
    titles = dict(zip(*reversed(ax.get_legend_handles_labels()), strict=True))
    ax.legend(titles.values(), titles.keys(), frameon=False, loc="upper center", ncols=3)
    ax.set_ylim(0, 1.3 * max(1, counts.max()))
    _plain(ax, xlabel=t.quantity, ylabel="machines", title=_title(t))


def _line(ax: Any, x: float, name: str, colour: str, style: str) -> None:
    if np.isfinite(x):
        ax.axvline(x, color=colour, linestyle=style, linewidth=1.4, ymax=HIGH, label=name)


def _title(t: Any) -> str:
    said = f"{counted(len(t), 'machine')}, standard deviation {t.std:.3g}"
    failed = f", {len(t.failed)} failed" if len(t.failed) else ""
    return said + failed + ("" if t.yields is None else f", {t.yields.part:.2%} within limits")


def _bars(ax: Any, t: Any) -> None:
    rows = sorted(t.rows, key=lambda row: -(row.share if t.sobol is None else row.sobol_total))
    shown, rest = rows[:MOST_BARS], rows[MOST_BARS:]
    names, shares = [row.name for row in shown], [100 * row.share for row in shown]
    if rest:
        names, shares = [*names, f"{len(rest)} more"], [*shares, 100 * sum(row.share for row in rest)]
    at = np.arange(len(names))
    width = 0.7 if t.sobol is None else 0.38
    ax.barh(at, shares, width, color=GOOD, alpha=0.85, label="by first derivatives")
    totals: list[float] = []
    if t.sobol is not None:
        totals = [100 * row.sobol_total for row in shown] + [100 * sum(row.sobol_total for row in rest)] * bool(rest)
        ax.barh(at + width, totals, width, color=LATER, alpha=0.85, label="Sobol, total")
        ax.legend(frameon=False, loc="lower right")
    for y, share in zip(at, shares, strict=True):
        ax.annotate(f"{share:.1f}", (share, y), (4, 0), textcoords="offset points", va="center", fontsize=9, color=INK)
    ax.set_yticks(at + (0 if t.sobol is None else width / 2), names)
    ax.invert_yaxis()
    ax.set_xlim(0, 1.12 * max(1.0, *shares, *totals))
    _plain(ax, xlabel="part of the variance, %", title="which to tighten")


def _plain(ax: Any, **labels: Any) -> None:
    ax.spines[["top", "right"]].set_visible(False)
    ax.set_axisbelow(True)
    ax.grid(color=FAINT, linewidth=0.8)
    ax.set(**labels)
