"""The path: the mechanism with its symbols at several poses, the ways of its joints, the curves of traced points."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from render.plots.labels import Labels
from render.plots.measures import dress_plane
from render.plots.style import FAINT, INK, QUIET, page
from shared.contract import Motion
from shared.contract.quantity import written
from shared.contract.skeleton import Skeleton, Stroke

WAY = "#c3c9cf"
"""Colour of the lines along which joints move."""
INKS = {
    "ink": INK,
    "quiet": QUIET,
    "paper": "white",
    "faint": FAINT,
    "driver": "#c2410c",
    "load": "#4b5563",
    "wrong": "#c81e1e",
    "x": "#d0453a",
    "y": "#2f8f4e",
}
WHEELS = 2.0
"""Strokes of a lower order are wheels, cams and pitch circles: drawn over and over they would hide each other."""


def path(motion: Motion, skeleton: Skeleton) -> Figure:
    """The skeleton in its poses, the first strong; ways of the joints, curves of the traced points (m)."""
    figure = page(
        motion.mechanism,
        "path",
        f"{len(skeleton.poses)} poses and dots in equal times over {_span(motion)}; the first pose is drawn strong",
    )
    axes = figure.add_axes((0.075, 0.085, 0.9, 0.775))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    labels = Labels(axes)
    for joint in motion.joints.values():
        axes.plot(joint.x, joint.y, color=WAY, linewidth=0.9, zorder=1)
    for pose in skeleton.poses[1:]:
        for stroke in pose.strokes:
            if stroke.ink.startswith("body:") and stroke.order >= WHEELS:
                axes.plot(*_corners(stroke).T, color=_ink(stroke.ink, motion), linewidth=0.8, alpha=0.3, zorder=1.2)
    for stroke in skeleton.poses[0].strokes:
        _draw(axes, stroke, motion)
        labels.avoid_lines([(float(x), float(y)) for x, y in _corners(stroke)])
    _curves(axes, motion, skeleton, labels)
    for name in skeleton.names:
        of_body = name.text in motion.bodies
        labels.add(
            name.text, name.at, _ink(name.ink, motion), weight="normal" if of_body else "bold", clearance=name.clearance
        )
    dress_plane(axes)
    labels.write()
    return figure


def _span(motion: Motion) -> str:
    whole = motion.time[-1] - motion.time[0]
    turns = whole / motion.period if motion.period else None
    return written(whole, "s") + (" (one period)" if turns and abs(turns - 1) < 1e-9 else "")


def _corners(stroke: Stroke) -> np.ndarray:
    """(k, 2) of the line that is drawn (m)."""
    points = np.reshape(stroke.points, (-1, 2))
    return np.vstack([points, points[:1]]) if stroke.closed else points


def _draw(axes: Axes, stroke: Stroke, motion: Motion) -> None:
    corners, ink = _corners(stroke), _ink(stroke.ink, motion)
    order = 3 + stroke.order / 4  # above the ways and the faint poses, below the curves
    if stroke.fill is not None:
        axes.fill(*corners.T, facecolor=to_rgba(_ink(stroke.fill, motion), stroke.alpha), linewidth=0, zorder=order)
    if stroke.width > 0:
        axes.plot(
            *corners.T,
            color=ink,
            linewidth=stroke.width,
            alpha=None if stroke.closed else stroke.alpha,
            linestyle=(0, tuple(stroke.dash)) if stroke.dash else "-",
            solid_capstyle="round",
            solid_joinstyle="round",
            zorder=order,
        )


def _curves(axes: Axes, motion: Motion, skeleton: Skeleton, labels: Labels) -> None:
    times = [pose.time for pose in skeleton.poses]
    for point in motion.points.values():
        ink = _ink(f"body:{point.body}", motion)
        x, y = np.asarray(point.x), np.asarray(point.y)
        axes.plot(x, y, color=ink, linewidth=2.4, zorder=6)
        dots = [np.interp(times, motion.time, values) for values in (x, y)]
        axes.plot(*dots, "o", color=ink, markersize=4.5, zorder=6)
        axes.plot(x[0], y[0], "o", color="white", markeredgecolor=ink, markeredgewidth=2, markersize=8, zorder=7)
        labels.avoid_lines(list(zip(point.x, point.y, strict=True)))


def _ink(role: str, motion: Motion) -> str:
    """The colour that a role of skeleton.json has on this page; a body's is that of its other plots."""
    body = role.removeprefix("body:")
    if body != role and body in motion.bodies:
        return motion.bodies[body].colour
    return INKS.get(role, INK)
