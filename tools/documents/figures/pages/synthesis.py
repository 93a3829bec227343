"""The straight part of a fitted four-bar beside Hoeken's."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import INK, MOVED, QUIET, note, plain

HOEKEN = {"coupler": 2.5, "rocker": 2.5}
NEAR = 0.06
"""Distance from the line (m): the part of the path that is nearer is drawn in the second picture."""


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    known = page.m.batch(
        lengths={name: [value] for name, value in HOEKEN.items()}, places={"D": [(2.0, 0.0)], "P": [(5.0, 0.0)]}
    ).points["P"][0]
    fitted = page.fit.path
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    whole, close = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    whole.plot(*known.T, color=QUIET, linewidth=1.4)
    whole.plot(*fitted.T, color=MOVED, linewidth=1.6)
    whole.plot(*page.line.T, "o", color=INK, markersize=4)
    _linkage(whole, page.fit.mechanism)
    plain(whole, xlabel="x, m", ylabel="y, m", title="the fitted four-bar, and the points asked for")
    whole.set_aspect("equal", adjustable="datalim")
    for path, colour in ((known, QUIET), (fitted, MOVED)):
        lower = np.where((path[:, 1] < 4 + NEAR) & (path[:, 0] > -0.1) & (path[:, 0] < 4.1), path[:, 1] - 4, np.nan)
        close.plot(path[:, 0], 1000 * lower, color=colour, linewidth=1.8)
    note(close, "Hoeken", (3.2, 9.8), (0, 16), QUIET)
    note(close, "fitted", (2.0, -1.3), (0, -22), MOVED)
    plain(close, xlabel="x, m", ylabel="distance from the line, mm", title="the straight part")
    close.set_ylim(-6, 16)
    return {"synthesis.svg": figure}


def _linkage(ax, mechanism) -> None:
    """The mechanism in the middle of its straight part."""
    solution = mechanism.sweep(steps=2)
    b, c, d, p = (
        [float(view.x[1]), float(view.y[1])]
        for view in (*(solution.joint(name) for name in "BCD"), solution.point("P"))
    )
    for ends in (([0.0, 0.0], b), (b, p), (b, c), (c, p), (c, d)):
        ax.plot(*np.array(ends).T, "-o", color=INK, linewidth=2.0, markersize=4.5, markerfacecolor="white")
    for ground in ([0.0, 0.0], d):
        ax.plot(*ground, "^", color=INK, markersize=9)
