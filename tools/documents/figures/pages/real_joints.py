"""A slider's acceleration with and without play, the way of the journal in its bearing, gears that rattle."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GREEN, MOVED, QUIET, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.4, 3.4), layout="constrained")
    slider, orbit, rattle = figure.subplots(1, 3)
    turns = page.ideal.t / page.TURN
    slider.plot(turns, page.loose.body("slider").ax / 1000, color=MOVED, linewidth=0.7, label="0.5 mm of play")
    slider.plot(turns, page.ideal.body("slider").ax / 1000, color=BLUE, label="ideal")
    slider.legend(loc="lower right")
    plain(slider, title="acceleration of the slider", xlabel="turns of the crank", ylabel="km/s²")
    _orbit(page, orbit)
    shown = page.rattle.t < 0.05
    rattle.axhspan(-50, 50, color=FAINT, linewidth=0)
    rattle.plot(1000 * page.rattle.t[shown], 1e6 * page.rolled[shown], color=GREEN)
    plain(rattle, title="gears with 0.1 mm of backlash", xlabel="time, ms", ylabel="from the middle of the play, µm")
    return {"real_joints.svg": figure}


def _orbit(page: SimpleNamespace, ax) -> None:
    """The journal's centre in the bearing over two turns, and the circle where it touches."""
    sol, turn = page.loose, np.linspace(0.0, 2 * np.pi, 200)
    rod = sol.body("rod")
    end = np.stack([rod.x + 0.12 * np.cos(rod.theta), rod.y + 0.12 * np.sin(rod.theta)])
    away = np.stack([sol.body("slider").x, sol.body("slider").y]) - end
    c, s = np.cos(rod.theta), np.sin(rod.theta)
    x, y = c * away[0] + s * away[1], c * away[1] - s * away[0]
    ax.plot(0.5 * np.cos(turn), 0.5 * np.sin(turn), color=QUIET, linewidth=0.8)
    ax.plot(1000 * x, 1000 * y, color=MOVED, linewidth=0.8)
    ax.set_aspect("equal")
    plain(ax, title="the journal in its bearing", xlabel="along the rod, mm", ylabel="across it, mm")
