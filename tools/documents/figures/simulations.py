"""Pictures of pages about simulations: energy, events, real joints and integrators."""

from __future__ import annotations

import json
from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from tools.documents.figures.look import BLUE, FAINT, GOLD, GREEN, INK, MOVED, PURPLE, QUIET, note, plain
from tools.documents.pages import DOCS


def forward_dynamics(page: SimpleNamespace) -> dict[str, Figure]:
    """The crane: where trolley and load are, and where the work of the motor goes."""
    figure = Figure(figsize=(9.6, 6.4), layout="constrained")
    snaps, place, energy = figure.subplots(3, 1, height_ratios=(0.95, 0.75, 1.1))
    _snapshots(snaps, page)
    _places(place, page)
    _energy(energy, page)
    place.sharex(energy)
    return {"forward_dynamics.svg": figure}


def _snapshots(ax, page: SimpleNamespace) -> None:
    """Trolley and load at whole seconds."""
    sol = page.sol
    x, angle = sol.body("trolley").x, sol.body("load").theta
    ax.plot([-1.0, 7.0], [0.0, 0.0], color=INK, linewidth=1.2)
    for time in (0.0, 1.0, 1.5, 2.0, 2.5, 3.0):
        k = int(np.searchsorted(sol.t, time))
        end = x[k] + 2.0 * np.cos(angle[k]), 2.0 * np.sin(angle[k])
        ax.plot([x[k], end[0]], [0.0, end[1]], color=QUIET, linewidth=1.2)
        ax.plot(x[k], 0.0, "s", color=BLUE, markersize=9)
        ax.plot(*end, "o", color=MOVED, markersize=11)
        ax.annotate(f"{time:g} s", (x[k], 0.0), (0, 9), textcoords="offset points", ha="center", fontsize=8.5)
    ax.set(xlim=(-0.9, 6.5), ylim=(-2.3, 0.5), title="trolley and load; lengths in m")
    ax.set_aspect("equal")
    ax.set_yticks([0, -2])
    ax.spines[["top", "right", "left"]].set_visible(False)


def _places(ax, page: SimpleNamespace) -> None:
    sol = page.sol
    trolley, load = sol.body("trolley").x, sol.body("load")
    for low, high in ((0.2, 1.8), (2.2, 3.8)):
        ax.axvspan(low, high, color=FAINT, linewidth=0)
    ax.plot(sol.t, trolley, color=BLUE, label="trolley")
    ax.plot(sol.t, load.x + 2.0 * np.cos(load.theta), color=MOVED, label="load")
    ax.legend(loc="lower right", ncols=2)
    top = ax.get_ylim()[1] * 1.05
    ax.set_ylim(top=top * 1.12)
    ax.text(1.0, top, "motor pushes", ha="center", va="top", fontsize=9, color=QUIET)
    ax.text(3.0, top, "motor brakes", ha="center", va="top", fontsize=9, color=QUIET)
    plain(ax, ylabel="x, m")
    ax.tick_params(labelbottom=False)


def _energy(ax, page: SimpleNamespace) -> None:
    sol = page.sol
    height = sol.energy.potential - sol.energy.potential[0]
    parts = (sol.energy.kinetic, height, page.heat)
    names = ("kinetic energy", "potential energy", "heat of wheels and pin")
    ax.stackplot(sol.t, *parts, colors=(BLUE, GOLD, GREEN), alpha=0.35, labels=names, linewidth=0)
    ax.plot(sol.t, sol.work + page.heat, color=INK, linewidth=1.4, label="work of the motor")
    plain(ax, xlim=(0, sol.t[-1]), ylabel="J", xlabel="time, s")
    ax.set_ylim(bottom=0)
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles[::-1], labels[::-1], loc="upper right")


def events(page: SimpleNamespace) -> dict[str, Figure]:
    """The ball that comes to rest, and the block that sticks and slips."""
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


def real_joints(page: SimpleNamespace) -> dict[str, Figure]:
    """Draw a slider with and without play, the journal's path in its bearing, and gears that rattle."""
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


MEASURED = DOCS / "integrators.json"
CLOSED = 1e-15
"""Less is rounding (m)."""
COLOURS = {
    "dop853": BLUE,
    "dop853, tight": BLUE,
    "radau": PURPLE,
    "rk4": GOLD,
    "symplectic": GREEN,
    "rattle": MOVED,
    "generalized_alpha": INK,
    "baumgarte": QUIET,
}


def integrators(page: SimpleNamespace) -> dict[str, Figure]:
    """Draw the energy over ten thousand periods by each integrator, and the opening of a Baumgarte pin."""
    runs = json.loads(MEASURED.read_text())["long"]
    energy = Figure(figsize=(9.6, 4.8), layout="constrained")
    left, right = energy.subplots(1, 2, sharey=True)
    for ax, (name, methods) in zip((left, right), runs.items(), strict=True):
        for method, run in methods.items():
            style = (0, (4, 2)) if "tight" in method else "-"
            ax.loglog(run["periods"], run["errors"], color=COLOURS[method], linestyle=style, label=method)
        plain(ax, xlabel="periods", xlim=(1, 1e4), ylim=(1e-12, 2))
        ax.set_title(f"{name}: largest energy error so far")
    left.set_ylabel("parts of the largest kinetic energy")
    energy.legend(
        *left.get_legend_handles_labels(), loc="outside lower center", ncols=8, columnspacing=1.0, handlelength=1.6
    )
    return {"integrators.svg": energy, "integrators_baumgarte.svg": _openings(page)}


def _openings(page: SimpleNamespace) -> Figure:
    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    ax = figure.subplots()
    for (name, gap), colour in zip(page.gap.items(), (MOVED, BLUE, GREEN), strict=True):
        gap = np.maximum(gap, CLOSED)
        ax.semilogy(page.times, gap, color=colour, linewidth=1.2)
        place = np.exp(np.mean(np.log(gap[-100:])))
        name = f"{name}:\nbelow {CLOSED:.0e} m" if np.isclose(place, CLOSED, atol=0.0) else name
        ax.annotate(name, (page.times[-1], place), (6, 0), textcoords="offset points", color=colour, va="center")
    plain(ax, xlabel="time, s", ylabel="pin C is open by, m", xlim=(0, 60), ylim=(1e-16, 1))
    ax.set_title("four-bar, RK4 with a step of 10 ms: let drift, stabilised, projected")
    return figure


PAGES = (forward_dynamics, events, real_joints, integrators)
