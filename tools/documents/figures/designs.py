"""Pictures of pages about many designs: batches, gradients and tolerances."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GOLD, INK, MOVED, PURPLE, QUIET, WRONG, note, plain

SHOWN = 30


def batch(page: SimpleNamespace) -> dict[str, Figure]:
    """Coupler curves of many four-bars, and which lengths make them straight."""
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


LEVELS = np.arange(0, 81, 10)


def batch_simulations(page: SimpleNamespace) -> dict[str, Figure]:
    """Where a bistable lever comes to rest, over the angle and the speed of its start."""
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    rests, fast = figure.subplots(1, 2)
    shape = len(page.speeds), len(page.angles)
    side = page.right.reshape(shape).astype(float)
    rests.contourf(page.angles, page.speeds, side, levels=(-0.5, 0.5, 1.5), cmap=ListedColormap([GOLD, BLUE]))
    for colour, word in ((BLUE, "right"), (GOLD, "left")):
        rests.plot([], [], "s", color=colour, label=f"it rests on the {word}")
    rests.legend(loc="upper center", ncols=2, bbox_to_anchor=(0.5, -0.16))
    drawn = fast.contourf(page.angles, page.speeds, page.many["fast"].reshape(shape), levels=LEVELS, cmap="viridis")
    figure.colorbar(drawn, ax=fast).set_label("fastest, rad/s")
    for ax, title in ((rests, "on which side it rests"), (fast, "how fast it becomes")):
        plain(ax, xlabel="angle at the start, degrees", ylabel="speed at the start, rad/s", title=title)
        ax.set(xlim=(page.angles[0], page.angles[-1]), ylim=(page.speeds[0], page.speeds[-1]))
    return {"batch_simulations.svg": figure}


EVERY = 24
ARROW = 0.010
"""A change of a length (m) that the arrows are of."""


def derivatives(page: SimpleNamespace) -> dict[str, Figure]:
    """Where lengths move the point of a four-bar, what they do to its torque, and how a search went down."""
    figure = Figure(figsize=(10.0, 3.8), layout="constrained")
    path, torque, search = figure.subplots(1, 3, width_ratios=(1.0, 1.25, 0.9))
    s, colours = page.s, {"crank": BLUE, "coupler": GOLD, "rocker": PURPLE}
    x, y = s.values["P.x"], s.values["P.y"]
    path.plot(1e3 * x, 1e3 * y, color=QUIET, lw=1.2)
    for name, colour in colours.items():
        dx, dy = (ARROW * s.of(axis, name) for axis in ("P.x", "P.y"))
        path.quiver(
            1e3 * x[::EVERY], 1e3 * y[::EVERY], 1e3 * dx[::EVERY], 1e3 * dy[::EVERY], color=colour, angles="xy",
            scale_units="xy", scale=1.0, width=0.008, label=name,
        )  # fmt: skip
        path.update_datalim(1e3 * np.stack([x + dx, y + dy], axis=1)[::EVERY])  # a quiver counts its tails alone
        torque.plot(s.t, 1e1 * page.m.bodies[name].length * s.of("motor.effort", name), color=colour, label=name)
    path.autoscale_view()
    path.set_aspect("equal", adjustable="datalim")
    plain(path, xlabel="x, mm", ylabel="y, mm", title=f"where {1e3 * ARROW:g} mm more move the point")
    torque.legend(loc="best")
    plain(torque, xlabel="time, s", ylabel="mN m", title="what one per cent adds to the torque")
    history = np.array(page.softest.history)
    search.plot(np.arange(1, len(history) + 1), history, "o-", color=BLUE)
    search.axhline(page.softest.objective, color=QUIET, lw=0.8)
    plain(search, xlabel="motions", ylabel="N m/rad", title="the closer of the clamp")
    return {"derivatives.svg": figure}


HIGH = 0.78
"""Part of the height that is below the words."""
BINS = np.linspace(79.3, 80.7, 71)


def tolerances(page: SimpleNamespace) -> dict[str, Figure]:
    """Heights of many feeders before and after a bar was tightened, and what each dimension adds to them."""
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


PAGES = (batch, batch_simulations, derivatives, tolerances)
