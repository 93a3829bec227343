"""The hip thrust: its moments, three lifts with one barbell, and what a lifter can choose."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, GREEN, INK, MOVED, plain

COLOURS = {"hip": MOVED, "knee": BLUE, "ankle": GREEN}
LIFTS = {"hip thrust": MOVED, "squat": BLUE, "deadlift": GREEN}


def pictures(page: SimpleNamespace) -> dict[str, Figure]:
    """Return the pictures of the page."""
    figure = Figure(figsize=(10.2, 6.4), layout="constrained")
    (pose, moments, lifts), (feet, benches, loads) = figure.subplots(2, 3)
    _poses(pose, page)
    mass = page.who.mass
    for joint, colour in COLOURS.items():
        moments.plot(page.lift.t, page.lift.moment(joint) / mass, color=colour, label=joint)
    moments.axvspan(1.0, 1.5, color=INK, alpha=0.06, linewidth=0)
    plain(moments, xlim=(0, 3.5), title="hip thrust, 65 kg, both legs", xlabel="time, s", ylabel="moment, N m/kg")
    for name, colour in LIFTS.items():
        lift = page.lifts[name]
        lifts.plot(lift.t, lift.moment("hip") / mass, color=colour, label=name)
    plain(lifts, xlim=(0, 3.5), title="the hip in three lifts", xlabel="time, s", ylabel="moment, N m/kg")
    for ax, table, x, label in (
        (feet, page.feet, "distance", "from the pad to the ankle, m"),
        (benches, page.benches, "bench", "height of the bench, m"),
        (loads, page.loads, "load", "barbell, kg"),
    ):
        ax.plot(table[x], table["hip"], color=MOVED, label="hip, peak")
        ax.plot(table[x], table["hip at the top"], color=MOVED, linestyle=(0, (4, 2)), label="hip, at the top")
        ax.plot(table[x], table["knee"], color=BLUE, label="knee")
        plain(ax, title=label.split(",")[0], xlabel=label, ylabel="moment, N m/kg")
        ax.set_ylim(bottom=0.0)
    for ax in (moments, lifts, feet):
        ax.legend(loc="best", handlelength=1.6)
    return {"hip_thrust.svg": figure}


def _poses(ax, page: SimpleNamespace) -> None:
    """The chain at the bottom and at the top, the way of the bar, the forces at the bottom."""
    sol = page.lift.solution
    for row, alpha in ((0, 1.0), (int(np.abs(sol.t - 1.0).argmin()), 0.35)):
        points = [(sol.joint("floor").x[row], 0.0)]
        for joint in ("ankle", "knee", "hip"):
            points.append((sol.joint(joint).x[row], sol.joint(joint).y[row]))
        trunk = sol.body("trunk")
        length = page.who.length("trunk")
        shoulder = trunk.x[row] + length * np.cos(trunk.theta[row]), trunk.y[row] + length * np.sin(trunk.theta[row])
        ax.plot(*np.transpose([*points, shoulder]), "-o", color=INK, markersize=4, alpha=alpha)
        ax.plot(*page.lift.bar[row], "o", color=MOVED, markersize=9, alpha=alpha)
    ax.plot(*page.lift.bar.T, color=MOVED, linewidth=0.8)
    edge = sol.mechanism.joints["pad"].j
    ax.plot([edge.x - 0.45, edge.x, edge.x], [edge.y, edge.y, 0.0], color=INK, linewidth=0.8)
    ax.axhline(0.0, color=INK, linewidth=0.8)
    for place, force in (((edge.x, edge.y), page.lift.pad[0]), (points_of_floor(sol), page.lift.floor[0])):
        ax.annotate("", xytext=place, xy=np.add(place, force / 2500.0), arrowprops={"arrowstyle": "->", "color": GREEN})
    plain(ax, title="bottom and top, forces at the bottom", xlabel="x, m", ylabel="y, m")
    ax.set_aspect("equal", adjustable="datalim")


def points_of_floor(sol) -> tuple[float, float]:
    """Where the floor pushes."""
    return float(sol.joint("floor").x[0]), 0.0
