"""The picture of the study: the part of the steady peak that a run-up reaches, simulated and in closed form."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from tools.figures.look import BLUE, GREEN, MOVED, PURPLE, QUIET, STYLE, plain

COLOURS = (MOVED, BLUE, GREEN, PURPLE)


def picture(runs: Any) -> Figure:
    """Displacement and angle on soft and on stiff mounts over the rate; ``runs``: the table of the study (pandas)."""
    with mpl.rc_context(STYLE):  # pyright: ignore[reportArgumentType]
        layouts = list(dict.fromkeys(runs["layout"]))
        figure = Figure(figsize=(2.6 * len(layouts), 7.6), layout="constrained")
        frequencies = list(dict.fromkeys(runs["frequency"]))
        axes = figure.subplots(2 * len(frequencies), len(layouts), sharex=True, sharey="row", squeeze=False)
        for column, layout in enumerate(layouts):
            for row, (name, frequency) in enumerate(
                (name, frequency) for name in ("displacement", "angle") for frequency in frequencies
            ):
                ax = axes[row, column]
                shown = runs[(runs["layout"] == layout) & (runs["frequency"] == frequency)]
                _panel(ax, shown, name)
                ax.set_title(f"{layout}, {frequency:g} Hz" if row < len(frequencies) else "")
                if column == 0:
                    ax.set_ylabel(f"{name} / steady")
        for ax in axes[-1]:
            ax.set_xlabel("rpm/s")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        return figure


def _panel(ax: Any, runs: Any, name: str) -> None:
    for colour, (damping_ratio, rows) in zip(COLOURS, runs.groupby("damping_ratio"), strict=False):
        steady = rows[f"steady {name}"]
        ax.plot(rows["rate"], rows[name] / steady, "o", color=colour, label=f"damping ratio {damping_ratio:g}")
        ax.plot(rows["rate"], rows[f"expected {name}"] / steady, "-", color=colour)
    ax.plot([], [], "-", color=QUIET, label="one mode, closed form")
    ax.axhline(1.0, color=QUIET, linewidth=0.9, linestyle=(0, (3, 3)))
    plain(ax, xscale="log", ylim=(0, 1.25))
