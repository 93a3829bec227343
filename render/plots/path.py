"""The path: the linkage as a skeleton at several poses, its joints and the curves of its traced points."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from render.plots.style import HALO, INK, QUIET, colour, page
from shared.contract import Motion

POSES = 12
"""Poses in equal times, the first drawn strong."""


def path(motion: Motion) -> Figure:
    """Skeleton of the mechanism in ``POSES`` poses, paths of its joints, curves of its traced points (m)."""
    figure = page(
        motion.mechanism,
        "path",
        f"{POSES} poses and dots in equal times over {_span(motion)}; the first pose is drawn strong",
    )
    axes = figure.add_axes((0.075, 0.085, 0.9, 0.775))
    steps = np.linspace(0, len(motion.time) - 1, POSES + 1).round().astype(int)[:-1]
    for joint in motion.joints.values():
        axes.plot(joint.x, joint.y, color="#c3c9cf", linewidth=0.9, zorder=1)
    for step in steps[1:]:
        _skeleton(axes, motion, int(step), strong=False)
    _curves(axes, motion, steps)
    _skeleton(axes, motion, 0, strong=True)
    _ground(axes, motion)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=15, steps=[1, 2, 5, 10]))
    axes.yaxis.set_major_locator(MaxNLocator(nbins=9, steps=[1, 2, 5, 10]))
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    return figure


def _span(motion: Motion) -> str:
    whole = motion.time[-1] - motion.time[0]
    turns = whole / motion.period if motion.period else None
    return f"{whole:.3g} s" + (" (one period)" if turns and abs(turns - 1) < 1e-9 else "")


def _corners(motion: Motion, body: str, step: int) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Where the joints of a body are, and where its traced points are."""
    joints = [(j.x[step], j.y[step]) for j in motion.joints.values() if body in j.bodies]
    points = [(p.x[step], p.y[step]) for p in motion.points.values() if p.body == body]
    return joints, points


def _skeleton(axes: Axes, motion: Motion, step: int, *, strong: bool) -> None:
    for index, body in enumerate(motion.bodies):
        joints, points = _corners(motion, body, step)
        corners = joints + points
        ink = colour(index)
        if len(corners) > 2:
            x, y = zip(*_around(corners), strict=True)
            if strong:
                axes.fill(x, y, color=ink, alpha=0.16, linewidth=0, zorder=4)
                axes.plot([*x, x[0]], [*y, y[0]], color=ink, linewidth=1.2, zorder=5)
        if len(joints) > 1:
            x, y = zip(*joints, strict=True)
            axes.plot(
                x,
                y,
                color=ink,
                linewidth=4.5 if strong else 1.1,
                alpha=1 if strong else 0.32,
                zorder=6 if strong else 2,
            )
        elif strong and joints:
            axes.plot(*joints[0], "s", color=ink, markersize=15, alpha=0.9, zorder=5)
        if strong:
            origin = [(motion.bodies[body].x[step], motion.bodies[body].y[step])]
            middle = tuple(np.mean(joints or corners or origin, axis=0))
            axes.annotate(
                body, middle, (7, -11), textcoords="offset points", path_effects=HALO, color=ink, fontsize=10, zorder=9
            )
    if strong:
        for name, joint in motion.joints.items():
            axes.plot(joint.x[step], joint.y[step], "o", color="white", markeredgecolor=INK, markersize=8, zorder=8)
            axes.annotate(
                name,
                (joint.x[step], joint.y[step]),
                (-8, 8),
                textcoords="offset points",
                path_effects=HALO,
                ha="right",
                fontweight="bold",
                zorder=9,
            )


def _curves(axes: Axes, motion: Motion, steps: np.ndarray) -> None:
    for name, point in motion.points.items():
        ink = colour(list(motion.bodies).index(point.body)) if point.body in motion.bodies else INK
        x, y = np.asarray(point.x), np.asarray(point.y)
        axes.plot(x, y, color=ink, linewidth=2.4, zorder=7)
        axes.plot(x[steps], y[steps], "o", color=ink, markersize=4.5, zorder=7)
        axes.plot(x[0], y[0], "o", color="white", markeredgecolor=ink, markeredgewidth=2, markersize=8, zorder=9)
        inward = np.array([x.mean() - x[0], y.mean() - y[0]])
        offset = 15 * inward / (np.hypot(*inward) or 1.0)
        axes.annotate(
            name,
            (x[0], y[0]),
            tuple(offset),
            textcoords="offset points",
            path_effects=HALO,
            ha="center",
            va="center",
            color=ink,
            fontweight="bold",
            zorder=9,
        )


def _ground(axes: Axes, motion: Motion) -> None:
    """A hatched foot under every joint that stands still on the ground."""
    for joint in motion.joints.values():
        if "ground" in joint.bodies and np.ptp(joint.x) < 1e-9 and np.ptp(joint.y) < 1e-9:
            at = (joint.x[0], joint.y[0])
            axes.plot(*at, marker=[(-1, -1.4), (1, -1.4), (0, 0)], markersize=17, color="#aab2ba", zorder=3)
            axes.plot(
                *at, marker=[(-1.5, -1.4), (1.5, -1.4)], markersize=25, color=QUIET, markeredgewidth=1.6, zorder=3
            )


def _around(corners: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Corners in the order of their direction from the middle, so that their polygon does not cross itself."""
    middle = np.mean(corners, axis=0)
    return sorted(corners, key=lambda c: np.arctan2(c[1] - middle[1], c[0] - middle[0]))
