"""What the bank angle of V engines leaves unbalanced, and which angles fire evenly."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from mbsd.machines.engines.bank_angles import NOTHING
from tools.figures.look import BLUE, GREEN, MOVED, QUIET, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """See tools/figures/__main__.py."""
    figure = Figure(figsize=(9.6, 8.4), layout="constrained")
    axes = figure.subplots(4, 3, sharex=True)
    for ax, one in zip(axes.ravel(), page.maps, strict=True):
        left = one.left(counterweights=True)
        for row, colour, words in ((0, MOVED, "first order"), (1, BLUE, "second order")):
            values = np.where(left.rank(row) < NOTHING, 0.0, left.rank(row))
            ax.plot(one.angle, values, color=colour, label=words, clip_on=False)
        even = one.angle[one.uneven < 1e-3]
        ax.plot(
            even, 0 * even, "|", color=GREEN, markersize=9, markeredgewidth=1.6, label="fires evenly", clip_on=False
        )
        ax.axvline(one.best, color=QUIET, linewidth=0.9, linestyle=(0, (3, 3)))
        beside = {"x": one.best - 3, "ha": "right"} if one.best > 150 else {"x": one.best + 3, "ha": "left"}
        place = ax.get_xaxis_transform()
        ax.text(y=0.97, s=f"{one.best:g}°", transform=place, va="top", color=QUIET, fontsize=9, **beside)
        top = max(left.rank(0).max(), left.rank(1).max())
        plain(ax, xlim=(0, 180), ylim=(0, 1.05 * top if top > NOTHING else 1.0), xticks=range(0, 181, 45))
        ax.set_title(one.family.name)
    for ax in axes[-1]:
        ax.set_xlabel("between the banks, degrees")
    for ax in axes[:, 0]:
        ax.set_ylabel("m r ω²")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return {"engines.svg": figure}
