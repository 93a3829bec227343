"""Heights of many feeders before and after a bar was tightened, and the part of each dimension in their variance."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GOLD, INK, QUIET, WRONG, plain

HIGH = 0.78
"""Part of the height that is below the words."""
BINS = np.linspace(79.3, 80.7, 71)


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    heights, shares = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    _heights(heights, page)
    _shares(shares, page)
    return {"tolerances.svg": figure}


def _heights(ax, page: SimpleNamespace) -> None:
    for t, colour, name in ((page.rough, GOLD, "all bars m"), (page.better, BLUE, "the rocker IT9")):
        part = f"{t.yields.part:.0%} within limits"
        ax.hist(1e3 * t.values, BINS, color=colour, alpha=0.6, label=f"{name}: {part}", zorder=2)
    for limit in page.rough.limits:
        ax.axvline(1e3 * limit, color=WRONG, linestyle="--", linewidth=1.4, ymax=HIGH)
    for side in page.better.vertex_worst:
        ax.axvline(1e3 * side, color=QUIET, linestyle=":", linewidth=1.4, ymax=HIGH)
    ax.axvline(1e3 * page.rough.nominal, color=INK, linewidth=1.2, ymax=HIGH)
    plain(ax, xlabel="height of P in the middle of the stroke, mm", ylabel="feeders of 10 000")
    ax.set_ylim(0, 1.28 * ax.get_ylim()[1])
    ax.legend(loc="upper left")
    ax.set_title("dashed: limits; dotted: worst case of the better ones")


def _shares(ax, page: SimpleNamespace) -> None:
    rows = {row.name: row for row in page.rough.rows}
    names = sorted(rows, key=lambda name: -rows[name].share)
    after = {row.name: row for row in page.better.rows}
    at = np.arange(len(names))
    for side, table, colour in ((-0.2, rows, GOLD), (0.2, after, BLUE)):
        ax.barh(at + side, [100 * table[name].share for name in names], 0.38, color=colour, alpha=0.85)
    ax.set_yticks(at, names)
    ax.invert_yaxis()
    plain(ax, xlabel="part of the variance, %", title="what to tighten, before and after")
