"""The ball that comes to rest, and the block that sticks and slips."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GREEN, INK, MOVED, QUIET, note, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(9.6, 5.4), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    _ball(figure.add_subplot(grid[:, 0]), page)
    place, force = figure.add_subplot(grid[0, 1]), figure.add_subplot(grid[1, 1])
    _block(place, force, page)
    return {"events.svg": figure}


def _ball(ax, page: SimpleNamespace) -> None:
    bounce, hits = page.bounce, page.hits
    times = np.array([hit.time for hit in hits])
    order = np.argsort(np.concatenate([bounce.t, times]))
    height = np.concatenate([bounce.body("ball").y, np.full(len(times), 0.05)])
    ax.plot(np.concatenate([bounce.t, times])[order], height[order], color=BLUE)
    ax.plot(times, np.full(len(times), 0.05), "o", color=MOVED, markersize=3.5)
    ax.axhline(0.05, color=INK, linewidth=0.8)
    rest = hits[-1].time
    note(ax, f"{len(hits)} impacts,\nat rest from {rest:.2f} s", (rest, 0.05), (-6, 60))
    plain(ax, xlim=(0, 5), ylim=(0, 1.12), xlabel="time, s", ylabel="height of the centre, m")
    ax.set_title("a ball: each impact found and passed")


def _block(place, force, page: SimpleNamespace) -> None:
    sol = page.stick_slip
    x = sol.body("block").x
    happened = [event for event in sol.events if event.what in ("slides", "sticks")]
    edges = [*(event.time for event in happened), sol.t[-1]]
    for event, end in zip(happened, edges[1:], strict=True):
        if event.what == "sticks":
            place.axvspan(event.time, end, color=FAINT, linewidth=0)
            force.axvspan(event.time, end, color=FAINT, linewidth=0)
    place.plot(sol.t, 100 * x, color=GREEN)
    place.set_title("a block on a belt: grey where it sticks")
    plain(place, ylabel="stretch of the spring, cm", xlim=(0, sol.t[-1]))
    place.tick_params(labelbottom=False)
    force.plot(sol.t, sol.contact("touch").friction, color=MOVED)
    for level, name in ((6.0, "static"), (4.0, "sliding")):
        force.axhline(level, color=QUIET, linewidth=0.8, linestyle=(0, (4, 3)))
        force.text(0.06, level + 0.12, name, fontsize=9, color=QUIET, va="bottom")
    plain(force, xlabel="time, s", ylabel="friction, N", xlim=(0, sol.t[-1]), ylim=(0, 7))
