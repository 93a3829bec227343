"""Unbalanced forces of V engines over their bank angle, and the angles that fire evenly."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from mbsd.machines.engines.bank_angles import NOTHING
from tools.documents.figures.look import BLUE, GREEN, MOVED, QUIET, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(9.6, 8.4), layout="constrained")
    axes = figure.subplots(4, 3, sharex=True)
    for ax, chart in zip(axes.ravel(), page.maps, strict=True):
        left = chart.left(counterweights=True)
        for row, colour, words in ((0, MOVED, "first order"), (1, BLUE, "second order")):
            values = np.where(left.rank(row) < NOTHING, 0.0, left.rank(row))
            ax.plot(chart.angle, values, color=colour, label=words, clip_on=False)
        even = chart.angle[chart.uneven < 1e-3]
        ax.plot(
            even, 0 * even, "|", color=GREEN, markersize=9, markeredgewidth=1.6, label="fires evenly", clip_on=False
        )
        ax.axvline(chart.best, color=QUIET, linewidth=0.9, linestyle=(0, (3, 3)))
        beside = {"x": chart.best - 3, "ha": "right"} if chart.best > 150 else {"x": chart.best + 3, "ha": "left"}
        place = ax.get_xaxis_transform()
        ax.text(y=0.97, s=f"{chart.best:g}°", transform=place, va="top", color=QUIET, fontsize=9, **beside)
        top = max(left.rank(0).max(), left.rank(1).max())
        plain(ax, xlim=(0, 180), ylim=(0, 1.05 * top if top > NOTHING else 1.0), xticks=range(0, 181, 45))
        ax.set_title(chart.family.name)
    for ax in axes[-1]:
        ax.set_xlabel("between the banks, degrees")
    for ax in axes[:, 0]:
        ax.set_ylabel("m r ω²")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return {"engines.svg": figure, "engine_mounts.svg": _mounts(page)}


def _mounts(page: SimpleNamespace) -> Figure:
    """The steady response on soft and stiff mounts; two run-ups; the part of the peak that is reached."""
    figure = Figure(figsize=(9.6, 6.4), layout="constrained")
    (moved, turned), (passing, left) = figure.subplots(2, 2)
    rpm = page.RPM * page.speeds
    for colour, (frequency, response) in zip((MOVED, BLUE), page.response.items(), strict=True):
        words = f"{frequency:g} Hz mounts"
        moved.plot(rpm, 1000 * response.largest_displacement(), color=colour, label=words)
        turned.plot(rpm, 1000 * response.largest_angle(), color=colour, label=words)
    for ax, title, unit in (
        (moved, "displacement at constant speed", "mm"),
        (turned, "angle at constant speed", "mrad"),
    ):
        plain(ax, xlim=(0, 2000), xlabel="rpm", ylabel=unit)
        ax.set_ylim(bottom=0)
        ax.set_title(title)
        ax.legend()
    for colour, (rate, run) in zip((GREEN, MOVED), page.runs.items(), strict=True):
        speed, y = page.RPM * run.body("crank").omega, 1000 * run.body("block").y
        passing.plot(speed[::3], y[::3], color=colour, linewidth=1.0, label=f"{rate:g} rpm/s")
    steady = 1000 * page.response[8.0].largest_displacement()
    for side in (-1, 1):
        passing.plot(rpm, side * steady, color=QUIET, linewidth=1.0, linestyle=(0, (3, 3)))
    plain(passing, xlim=(100, 700), xlabel="rpm", ylabel="mm")
    passing.set_title("run-ups on 8 Hz mounts, steady dashed")
    passing.legend(loc="upper right")
    rates = np.geomspace(20, 10_000, 40)
    mode = page.response[8.0].modes[0]
    for colour, damping_ratio in zip((MOVED, BLUE, GREEN), (0.05, 0.1, 0.2), strict=True):
        reached = [page.run_up(mode.frequency, damping_ratio, rate / page.RPM, order=2).reached for rate in rates]
        left.plot(rates, reached, color=colour, label=f"damping ratio {damping_ratio:g}")
    plain(left, xscale="log", xlim=(20, 10_000), ylim=(0, 1.15), xlabel="rpm/s", ylabel="peak over steady peak")
    left.set_title("second order through 7.8 Hz")
    left.legend()
    return figure
