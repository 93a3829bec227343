"""Pictures of pages about motion: what is built, how it moves, and linkages found for a path."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from matplotlib.figure import Figure

from mbsd import Mechanism, constant_rate
from mbsd.cams import RISES, Lift, roller_cam
from mbsd.pictures import Picture, Svg
from tools.documents.figures.look import BLUE, FAINT, GREEN, INK, MOVED, QUIET, WRONG, note, plain


def animation(page: SimpleNamespace) -> dict[str, bytes]:
    """The slider-crank in motion, with the reactions of its joints and the velocities of its pins."""
    return {"animation.gif": Path(page.folder / "slider_crank.gif").read_bytes()}


def tutorial(page: SimpleNamespace) -> dict[str, Figure]:
    """The pendulum, free and damped: drawn by the page itself."""
    return {"tutorial_pendulum.svg": page.figure}


def model(page: SimpleNamespace) -> dict[str, Picture | Svg]:
    """A four-bar as a skeleton, and a parallelogram as a diagram of bodies and joints."""
    four_bar = Mechanism.load(page.folder / "four_bar.json")  # before the page took its motor away
    four_bar.forces.clear()  # the spring that the page adds later
    return {"model_drawing.svg": four_bar.draw(), "model_topology.svg": page.wide.topology()}


def kinematics(page: SimpleNamespace) -> dict[str, Figure]:
    """The shaper, and its ram over one turn of the crank."""
    figure = Figure(figsize=(9.6, 5.0), layout="constrained")
    skeleton, *curves = _axes(figure)
    page.sol.draw(t=0.1, ax=skeleton)
    skeleton.set_title("at t = 0.1 s")
    degrees = page.sol.t * 360.0
    ram = page.stroke
    for ax, values, colour, label in zip(
        curves,
        (1000 * ram.x, ram.vx, ram.ax),
        (BLUE, GREEN, MOVED),
        ("place, mm", "speed, m/s", "acceleration, m/s²"),
        strict=True,
    ):
        ax.axvspan(degrees[page.left], degrees[page.right], color=FAINT, linewidth=0)
        ax.plot(degrees, values, color=colour)
        ax.axhline(0.0, color=INK, linewidth=0.6)
        plain(ax, xlim=(0, 360), xticks=np.arange(0, 361, 60))
        ax.set_ylabel(label, color=colour)
        ax.margins(y=0.08)
    curves[0].set_title("the ram; grey: the fast return, to the right")
    curves[-1].set_xlabel("crank angle, degrees")
    figure.align_ylabels(curves)
    return {"kinematics.svg": figure}


def _axes(figure: Figure) -> list:
    grid = figure.add_gridspec(3, 2, width_ratios=(0.9, 1.25))
    curves = [figure.add_subplot(grid[0, 1])]
    curves += [figure.add_subplot(grid[k, 1], sharex=curves[0]) for k in (1, 2)]
    for ax in curves[:2]:
        ax.tick_params(labelbottom=False)
    return [figure.add_subplot(grid[:, 0]), *curves]


def joints(page: SimpleNamespace) -> dict[str, Figure]:
    """Machines of the page as they draw themselves."""
    figure = Figure(figsize=(11.0, 6.0), layout="constrained")
    machines = (
        page.yoke, page.planetary, page.belt, page.steering, _cam(), page.geneva, page.hill, page.wire,
    )  # fmt: skip
    for m, ax in zip(machines, figure.subplots(2, 4).ravel(), strict=True):
        m.draw(ax=ax, frames=False, names=False)
        ax.set(xticks=[], yticks=[], xlabel="", ylabel="")
        ax.set_title("", loc="left")
        ax.set_title(m.name, loc="center")
    return {"joints.svg": figure}


def _cam() -> Mechanism:
    m = Mechanism("cam and roller")
    cam, follower = m.body("cam"), m.body("follower")
    lift = Lift.of((math.pi / 2, 0.02, "cycloidal"), (math.pi / 2, 0.02), (math.pi, 0.0, "3-4-5"))
    m.revolute("shaft", m.ground.origin, cam.origin)
    m.prismatic("guide", m.ground.at(0, 0.09, math.pi / 2), follower.at(0, 0.04, math.pi / 2))
    m.cam_roller("contact", cam.origin, follower.origin, roller_cam(lift, 0.04, 0.01))
    m.drive_angle("motor", cam, constant_rate(6.28, 1.0))
    m.start_near(follower=(0, 0.06, 0))
    return m


LAWS = (("cycloidal", BLUE), ("3-4-5", GREEN), ("modified_sine", MOVED))


def cams(page: SimpleNamespace) -> dict[str, Figure]:
    """The valve train, three lift laws, and the force of the cam at three speeds."""
    figure = Figure(figsize=(11.0, 4.8), layout="constrained")
    grid = figure.add_gridspec(3, 3, width_ratios=(0.75, 1.0, 1.15))
    skeleton = figure.add_subplot(grid[:, 0])
    page.runs[500].draw(step=80, ax=skeleton, frames=False)
    skeleton.set_title("40 degrees into the rise")
    laws = [figure.add_subplot(grid[k, 1]) for k in range(3)]
    _laws(laws)
    _force(figure.add_subplot(grid[:, 2]), page)
    return {"cams.svg": figure}


def _laws(axes: list) -> None:
    """Lift and derivatives of a unit rise over a unit angle."""
    u = np.linspace(0.0, 1.0, 201)
    for order, (ax, label) in enumerate(zip(axes, ("lift", "speed", "acceleration"), strict=True)):
        for name, colour in LAWS:
            ax.plot(u, RISES[name](u)[:, order], color=colour, linewidth=1.5, label=name.replace("_", " "))
        plain(ax, xlim=(0, 1), ylabel=label)
        ax.axhline(0.0, color=INK, linewidth=0.6)
        if order < 2:
            ax.tick_params(labelbottom=False)
    axes[0].set_title("laws, for a unit rise")
    axes[0].legend(loc="lower right", fontsize=8.5, handlelength=1.4, borderaxespad=0.1)
    axes[2].set_xlabel("part of the rise")


def _force(ax, page: SimpleNamespace) -> None:
    for (rpm, sol), colour in zip(page.runs.items(), (GREEN, BLUE, MOVED), strict=True):
        angle = np.degrees(sol.body("cam").theta - sol.body("cam").theta[0])
        shown = angle <= 140.0
        ax.plot(angle[shown], sol.joint("contact").fy[shown], color=colour, label=f"{rpm} rpm")
    ax.axhline(0.0, color=INK, linewidth=0.8)
    low = ax.get_ylim()[0]
    ax.axhspan(low, 0.0, color=WRONG, alpha=0.08, linewidth=0)
    ax.text(60.0, 0.93 * low, "here it would have to pull: the valve floats", color=WRONG, ha="center", fontsize=9)
    plain(ax, xlim=(0, 140), xticks=range(0, 141, 20), xlabel="cam angle, degrees", ylabel="cam on the valve, N")
    ax.set_ylim(bottom=low)
    ax.set_title("force of the cam")
    ax.legend(loc="upper center")


HOEKEN = {"coupler": 2.5, "rocker": 2.5}
NEAR = 0.06
"""Distance from the line (m): the part of the path that is nearer is drawn in the second picture."""


def synthesis(page: SimpleNamespace) -> dict[str, Figure]:
    """The straight part of a fitted four-bar beside Hoeken's."""
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


COLOURS = {"hip": MOVED, "knee": BLUE, "ankle": GREEN}
LIFTS = {"hip thrust": MOVED, "squat": BLUE, "deadlift": GREEN}


def hip_thrust(page: SimpleNamespace) -> dict[str, Figure]:
    """The hip thrust: its moments, three lifts with one barbell, and what a lifter can choose."""
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


PAGES = (animation, tutorial, model, kinematics, joints, cams, synthesis, hip_thrust)
