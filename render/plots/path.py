"""The path: the linkage as a skeleton at several poses, its joints and the curves of its traced points."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from render.plots.labels import Labels
from render.plots.style import INK, QUIET, colour, page
from shared.contract import Motion

POSES = 12
"""Poses in equal times, the first drawn strong."""
RAIL = "#e3e7ea"
Point = tuple[float, float]


def path(motion: Motion) -> Figure:
    """Skeleton of the mechanism in ``POSES`` poses, paths of its joints, curves of its traced points (m)."""
    figure = page(
        motion.mechanism,
        "path",
        f"{POSES} poses and dots in equal times over {_span(motion)}; the first pose is drawn strong",
    )
    axes = figure.add_axes((0.075, 0.085, 0.9, 0.775))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=15, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(nbins=9, steps=[1, 2, 5, 10]))
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    steps = np.linspace(0, len(motion.time) - 1, POSES + 1).round().astype(int)[:-1]
    for joint in motion.joints.values():
        slides = "ground" in joint.bodies and joint.kind != "revolute"
        axes.plot(joint.x, joint.y, color=RAIL if slides else "#c3c9cf", linewidth=7 if slides else 0.9, zorder=1)
    for step in steps[1:]:
        _faint_pose(axes, motion, int(step))
    _curves(axes, motion, steps)
    _ground(axes, motion)
    labels = Labels(axes)
    _strong_pose(axes, motion, labels)
    labels.write()
    return figure


def _span(motion: Motion) -> str:
    whole = motion.time[-1] - motion.time[0]
    turns = whole / motion.period if motion.period else None
    return f"{whole:.3g} s" + (" (one period)" if turns and abs(turns - 1) < 1e-9 else "")


def _joints_of(motion: Motion, body: str, step: int) -> list[Point]:
    """Where the joints of a body are; joints that coincide count once."""
    places = [(joint.x[step], joint.y[step]) for joint in motion.joints.values() if body in joint.bodies]
    return list({(round(x, 9), round(y, 9)): (x, y) for x, y in places}.values())


def _faint_pose(axes: Axes, motion: Motion, step: int) -> None:
    for index, body in enumerate(motion.bodies):
        joints = _joints_of(motion, body, step)
        if len(joints) > 1:
            axes.plot(*zip(*joints, strict=True), color=colour(index), linewidth=1.1, alpha=0.32, zorder=2)


def _strong_pose(axes: Axes, motion: Motion, labels: Labels) -> None:
    for index, (body, moving) in enumerate(motion.bodies.items()):
        ink = colour(index)
        joints = _joints_of(motion, body, 0)
        points = [(point.x[0], point.y[0]) for point in motion.points.values() if point.body == body]
        corners = _around(joints + points)
        if len(corners) > 2:
            closed = [*corners, corners[0]]
            axes.fill(*zip(*corners, strict=True), color=ink, alpha=0.16, linewidth=0, zorder=4)
            axes.plot(*zip(*closed, strict=True), color=ink, linewidth=1.2, zorder=5)
            labels.avoid_lines(closed)
        if len(joints) > 1:
            axes.plot(*zip(*joints, strict=True), color=ink, linewidth=4.5, zorder=6)
            labels.avoid_lines(joints)
        else:
            place = joints[0] if joints else (moving.x[0], moving.y[0])
            axes.plot(*place, "s", color=ink, markersize=17, zorder=5)
        where = np.mean(joints or [(moving.x[0], moving.y[0])], axis=0)
        labels.add(body, (float(where[0]), float(where[1])), ink, size=10)
    names: dict[Point, list[str]] = {}
    for name, joint in motion.joints.items():
        names.setdefault((round(joint.x[0], 9), round(joint.y[0], 9)), []).append(name)
    for place, here in names.items():
        axes.plot(*place, "o", color="white", markeredgecolor=INK, markersize=8, zorder=8)
        labels.add(", ".join(here), place, INK, weight="bold")
    for name, point in motion.points.items():
        labels.avoid_lines(list(zip(point.x, point.y, strict=True)))
        labels.add(name, (point.x[0], point.y[0]), _ink_of(motion, point.body), weight="bold")


def _curves(axes: Axes, motion: Motion, steps: np.ndarray) -> None:
    for point in motion.points.values():
        ink = _ink_of(motion, point.body)
        x, y = np.asarray(point.x), np.asarray(point.y)
        axes.plot(x, y, color=ink, linewidth=2.4, zorder=7)
        axes.plot(x[steps], y[steps], "o", color=ink, markersize=4.5, zorder=7)
        axes.plot(x[0], y[0], "o", color="white", markeredgecolor=ink, markeredgewidth=2, markersize=8, zorder=9)


def _ink_of(motion: Motion, body: str) -> str:
    return colour(list(motion.bodies).index(body)) if body in motion.bodies else INK


def _ground(axes: Axes, motion: Motion) -> None:
    """A foot under every joint that stands still on the ground."""
    for joint in motion.joints.values():
        if "ground" in joint.bodies and np.ptp(joint.x) < 1e-9 and np.ptp(joint.y) < 1e-9:
            at = (joint.x[0], joint.y[0])
            axes.plot(*at, marker=[(-1, -1.4), (1, -1.4), (0, 0)], markersize=17, color="#aab2ba", zorder=3)
            axes.plot(
                *at, marker=[(-1.5, -1.4), (1.5, -1.4)], markersize=25, color=QUIET, markeredgewidth=1.6, zorder=3
            )


def _around(corners: list[Point]) -> list[Point]:
    """Corners in the order of their direction from the middle, so that their polygon does not cross itself."""
    if len(corners) < 3 or all(abs(_area(corners[0], a, b)) < 1e-12 for a, b in pairwise(corners[1:])):
        return []
    middle = np.mean(corners, axis=0)
    return sorted(corners, key=lambda c: np.arctan2(c[1] - middle[1], c[0] - middle[0]))


def _area(a: Point, b: Point, c: Point) -> float:
    """Twice the area of a triangle."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
