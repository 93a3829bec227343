"""Pages of a mechanism in space: its path in a dimetric view, turns and slides, loads, points and energy."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from render.plots.measures import dress_plane, horizon
from render.plots.pages.motion import Line, draw, draw_names, draw_stroke, faint_poses
from render.plots.style import INK, PALETTE, PARTS, Labels, colour, page, rows
from shared.contract import Motion3
from shared.contract.quantity import written
from shared.contract.skeleton import VIEW, Skeleton
from shared.contract.space import columns

NOISE = 1e-9
"""Part of the largest value that is rounding."""
Panel = tuple[str, str, list[Line]]


def plots_in_space(motion: Motion3) -> list[str]:
    """Return names of the plots that this motion has something to show in."""
    return [
        "path",
        "bodies",
        "energy",
        *["reactions"] * bool(motion.joints),
        *(f"point-{name}" for name in motion.points),
    ]


def figure_in_space(plot: str, motion: Motion3, skeleton: Skeleton) -> Figure:
    """Draw a plot of :func:`plots_in_space`."""
    if plot == "path":
        return path(motion, skeleton)
    if plot.startswith("point-"):
        return point(motion, plot.removeprefix("point-"))
    whole: dict[str, Callable[[Motion3], Figure]] = {"bodies": bodies, "reactions": reactions, "energy": energy}
    return whole[plot](motion)


def flat(places: np.ndarray) -> np.ndarray:
    """Return places (n, 3) in the picture (n, 2)."""
    return places @ np.array(VIEW).T


def path(motion: Motion3, skeleton: Skeleton) -> Figure:
    """Return the skeleton in its poses and curves of the traced points (m), in a dimetric view."""
    span = written(motion.time[-1] - motion.time[0], "s")
    said = f"{len(skeleton.poses)} poses in equal times over {span}, in a dimetric view"
    figure = page(motion.mechanism, "path", f"{said}; the first pose is drawn strong")
    axes = figure.add_axes((0.075, 0.085, 0.9, 0.775))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    labels = Labels(axes)
    faint_poses(axes, skeleton, motion)
    for stroke in skeleton.poses[0].strokes:
        draw_stroke(axes, stroke, motion, labels)
    for name, traced in motion.points.items():
        way = flat(columns(traced, "x", "y", "z"))
        axes.plot(*way.T, color=motion.bodies[traced.body].colour if traced.body in motion.bodies else INK, zorder=5)
        labels.avoid_lines([(float(x), float(y)) for x, y in way[:: max(1, len(way) // 200)]])
        labels.add(name, (float(way[0, 0]), float(way[0, 1])), INK, weight="bold", clearance=skeleton.unit)
    draw_names(labels, skeleton, motion)
    dress_plane(axes, ("across the view", "up the view"))
    labels.write()
    return figure


def bodies(motion: Motion3) -> Figure:
    """Return turns (degrees) and slides (m) of joints, and angular speeds of bodies (rad/s)."""
    names = list(motion.joints)
    turns = [(n, np.degrees(j.turn), colour(names.index(n))) for n, j in motion.joints.items() if j.turn is not None]
    slides = [(n, np.asarray(j.slide), colour(names.index(n))) for n, j in motion.joints.items() if j.slide is not None]
    speeds = [
        (name, np.linalg.norm(columns(body, "wx", "wy", "wz"), axis=1), body.colour)
        for name, body in motion.bodies.items()
    ]
    said = "turns and slides of the joints from the pose of mechanism.py, angular speed of the bodies"
    panels = [("turn", "°", turns), ("slide", "m", slides), ("angular speed", "rad/s", speeds)]
    return _page(motion, "turns and slides", said, panels)


def reactions(motion: Motion3) -> Figure:
    """Return the sizes of each joint's force (N) and moment (N m), and the drivers' efforts."""
    names = list(motion.joints)
    forces, moments = (
        [(n, np.linalg.norm(columns(j, *fields), axis=1), colour(names.index(n))) for n, j in motion.joints.items()]
        for fields in (("fx", "fy", "fz"), ("mx", "my", "mz"))
    )
    efforts = [(n, np.asarray(d.effort), PALETTE[k % len(PALETTE)]) for k, (n, d) in enumerate(motion.drivers.items())]
    panels: list[Panel] = [("reaction force", "N", forces), ("reaction moment", "N m", moments)]
    for unit, words in (("N m", "driver torque"), ("N", "driver force")):
        panels.append((words, unit, [line for line in efforts if motion.drivers[line[0]].effort_unit == unit]))
    said = "size of each joint's force and of its moment about the joint, and what drivers must give"
    return _page(motion, "what the joints carry", said, panels)


def point(motion: Motion3, name: str) -> Figure:
    """Return components and sizes of a traced point's place, velocity and acceleration."""
    traced = motion.points[name]
    inks = (*PARTS, PALETTE[2])
    panels: list[Panel] = []
    for rate, words, unit in (("", "position", "m"), ("v", "velocity", "m/s"), ("a", "acceleration", "m/s²")):
        lines = [
            (rate + axis, np.asarray(getattr(traced, rate + axis)), ink) for axis, ink in zip("xyz", inks, strict=False)
        ]
        if rate:
            lines.append((f"|{rate}|", np.linalg.norm([line[1] for line in lines], axis=0), INK))
        panels.append((words, unit, lines))
    return _page(motion, f"traced point {name}", f"fixed to {traced.body}; components and size", panels)


def energy(motion: Motion3) -> Figure:
    """Return energies (J) from their start, and powers of drivers and forces (W)."""
    kinetic = np.asarray(motion.energy.kinetic)
    gained = np.asarray(motion.energy.potential) - motion.energy.potential[0]
    energies = [("kinetic", kinetic, PARTS[0]), ("Δ potential", gained, PARTS[1]), ("total", kinetic + gained, INK)]
    givers: list[tuple[str, Any]] = [*motion.drivers.items(), *motion.forces.items()]
    powers = [(name, np.asarray(load.power), colour(k)) for k, (name, load) in enumerate(givers)]
    panels = [("energy", "J", energies), ("power", "W", powers)]
    return _page(motion, "energy and power", "power: what each driver and force gives to the motion", panels)


def _page(motion: Motion3, title: str, said: str, panels: Iterable[Panel]) -> Figure:
    """Return stacked axes, one for each panel that has lines."""
    shown = [panel for panel in panels if panel[2]]
    figure, over = page(motion.mechanism, title, said), horizon(motion)
    for axes, (words, unit, lines) in zip(rows(figure, len(shown)), shown, strict=True):
        largest = max(float(np.abs(values).max()) for _, values, _ in lines)
        draw(axes, over, words, unit, lines, floor=NOISE * largest)
    over.dress(figure.axes[-1])
    return figure
