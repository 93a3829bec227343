"""Coupler curves of many four-bars, and which lengths make them straight."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from tools.documents.figures.look import INK, MOVED, QUIET, note, plain

SHOWN = 30


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.0, 4.4), layout="constrained")
    curves, cloud = figure.subplots(1, 2, width_ratios=(1.15, 1.0))
    _curves(curves, page)
    _cloud(figure, cloud, page)
    return {"batch.svg": figure}


def _curves(ax, page: SimpleNamespace) -> None:
    for path in page.path[:SHOWN]:
        ax.plot(*path.T, color=QUIET, linewidth=0.7, alpha=0.35)
    ax.plot(*page.path[page.best].T, color=MOVED, linewidth=1.2)
    straight = page.lower[page.best]
    ax.plot(*straight.T, color=MOVED, linewidth=3.4)
    note(ax, "the straightest", (straight[45, 0], straight[45, 1]), (-44, -24), MOVED)
    _linkage(ax, page)
    plain(ax, xlabel="x, m", ylabel="y, m", title=f"paths of P, {SHOWN} of {len(page.path)} designs")
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(y=0.12)


def _linkage(ax, page: SimpleNamespace) -> None:
    """The best design in the middle of its straight part."""
    best = np.flatnonzero(page.designs.closes)[page.best]
    k = 60
    angle = 2 * np.pi * page.designs.t[k]
    b, p = np.array([np.cos(angle), np.sin(angle)]), page.path[page.best][k]
    c = b + page.lengths["coupler"][best] * (p - b) / np.hypot(*(p - b))
    d = page.pivots[best]
    for ends in (([0.0, 0.0], b), (b, p), (c, d)):
        ax.plot(*np.array(ends).T, "-o", color=INK, linewidth=2.2, markersize=4.5, markerfacecolor="white")
    for ground in ([0.0, 0.0], d):
        ax.plot(*ground, "^", color=INK, markersize=9)
    ax.annotate("P", p, (-4, 8), textcoords="offset points", ha="right")


def _cloud(figure: Figure, ax, page: SimpleNamespace) -> None:
    closes = page.designs.closes
    coupler, rocker = page.lengths["coupler"][closes], page.lengths["rocker"][closes]
    drawn = ax.hexbin(
        coupler,
        rocker,
        C=100 * page.height,
        reduce_C_function=np.min,
        gridsize=(15, 8),
        cmap="viridis_r",
        norm=LogNorm(),
        linewidth=0.2,
    )
    ax.plot(coupler[page.best], rocker[page.best], "o", color="none", markeredgecolor=MOVED, markersize=11, mew=2)
    plain(ax, xlabel="length of the coupler, m", ylabel="length of the rocker, m")
    ax.set_title("the straightest with lengths near these")
    bar = figure.colorbar(drawn, ax=ax)
    bar.set_label("height of the straight part, % of its length")
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50) if drawn.norm.vmin <= tick]
    ticks = [tick for tick in ticks if tick <= drawn.norm.vmax]
    bar.set_ticks(ticks, labels=[f"{tick:g}" for tick in ticks])
    bar.minorticks_off()
