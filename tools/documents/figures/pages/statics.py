"""The switch: its potential energy and equilibria, and how it snaps under load."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GREEN, INK, MOVED, QUIET, WRONG, note, plain


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.6, 4.2), layout="constrained")
    skeleton, energy, snap = figure.subplots(1, 3, width_ratios=(0.85, 1.0, 1.0))
    page.right.start(page.pushed)
    page.pushed.draw(ax=skeleton, frames=False)
    skeleton.set_title("the lever on the right")
    _energy(energy, page)
    _snap(snap, page)
    return {"statics.svg": figure}


def _potential(angle: np.ndarray) -> np.ndarray:
    """J, of the lever and the spring of the page."""
    length = np.hypot(0.2 * np.cos(angle), 0.2 * np.sin(angle) - 0.3)
    return 0.5 * 800.0 * (length - 0.16) ** 2 + 0.4 * 9.80665 * 0.1 * np.sin(angle)


def _energy(ax, page: SimpleNamespace) -> None:
    angle = np.linspace(45.0, 135.0, 181)
    ax.plot(angle, _potential(np.radians(angle)), color=INK)
    for pose, colour in ((page.right, GREEN), (page.middle, WRONG), (page.left, GREEN)):
        at = np.degrees(pose.body("lever").theta), pose.energy.potential
        ax.plot(*at, "o", color=colour, markersize=8)
        note(ax, pose.stability, at, (0, 26), colour)
    plain(ax, xlim=(135, 45), ylim=(0.25, 2.1), xticks=np.arange(45, 136, 15), xlabel="angle of the lever, degrees")
    ax.set(ylabel="potential energy, J", title="three poses balance")


def _snap(ax, page: SimpleNamespace) -> None:
    angles, jump = np.array(page.angles), page.jump
    every = np.linspace(45.0, 135.0, 721)
    slope = np.gradient(_potential(np.radians(every)), np.radians(every))
    stable = np.gradient(slope, every) > 0
    for holds, style in ((stable, "-"), (~stable, (0, (4, 3)))):
        part = np.where(holds, slope, np.nan)
        ax.plot(part, every, color=QUIET, linewidth=1.1, linestyle=style)
    ax.plot(page.torques, angles, "o", color=BLUE, markersize=3.6)
    ax.annotate(
        "",
        xy=(page.torques[jump + 1], angles[jump + 1]),
        xytext=(page.torques[jump], angles[jump]),
        arrowprops={"arrowstyle": "-|>", "color": MOVED, "linewidth": 1.4, "shrinkA": 4, "shrinkB": 4},
    )
    ax.text(page.torques[jump] + 0.2, 95.0, "snaps", color=MOVED, va="center", rotation=90)
    plain(ax, xlim=(-6, 6), ylim=(45, 135), yticks=np.arange(45, 136, 15))
    ax.set(xlabel="torque of the hand, N m", ylabel="angle of rest, degrees", title="pushed until it snaps")
