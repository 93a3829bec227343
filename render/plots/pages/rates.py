"""Position, velocity and acceleration over the turn: of the bodies' angles, of a traced point, of a sliding body."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from render.magnitudes import NOISE, speed_scale, without_noise
from render.plots.horizon import Horizon, horizon
from render.plots.inks import ink_of
from render.plots.marks import mark
from render.plots.measures import cut, dress_axis, turned
from render.plots.style import FAINT, INK, LABELLED, PARTS, QUIET, label_ends, page, rows
from render.report.written import first_peak, speed
from shared.contract import BodyMotion, Motion, PointMotion
from shared.contract.quantity import figures, written

G = 9.80665
"""m/s²."""
STILL = 1e-9
"""m or rad: what varies less stands still."""
KINDS = (("", "position", "m"), ("v", "velocity", "m/s"), ("a", "acceleration", "m/s²"))
DASHES = ("-", (0, (5, 1.6)), (0, (1.6, 1.4)), (0, (7, 1.6, 1.6, 1.6)))
"""Dashes of lines of one body in turn."""
Line = tuple[str, np.ndarray, str]
"""Label, values, colour."""


def bodies(motion: Motion) -> Figure:
    """Angle (degrees), angular velocity (rad/s) and angular acceleration (rad/s^2) of every body."""
    figure = page(motion.mechanism, "angles of the bodies", "angle, angular velocity and angular acceleration")
    kinds = (("theta", "angle", "°"), ("omega", "velocity", "rad/s"), ("alpha", "acceleration", "rad/s²"))
    over = horizon(motion)
    turning = [name for name, body in motion.bodies.items() if np.ptp(body.theta) > STILL] or list(motion.bodies)
    fastest = speed_scale(motion)
    floors = {"theta": STILL, "omega": NOISE * fastest, "alpha": NOISE * fastest**2}
    for axes, (field, words, unit) in zip(rows(figure, 3), kinds, strict=True):
        series = {name: np.asarray(getattr(motion.bodies[name], field)) for name in turning}
        scale = np.degrees(1.0) if field == "theta" else 1.0
        lines = [(name, scale * values, ink_of(motion, [name])) for name, values in series.items()]
        draw(axes, over, words, unit, lines, floor=floors[field])
    over.dress(figure.axes[-1])
    mark(figure, over, motion)
    return figure


def point(motion: Motion, name: str) -> Figure:
    """Components and magnitudes of a traced point's motion."""
    traced = motion.points[name]
    return _plane_motion(motion, traced, f"traced point {name}", f"fixed to {traced.body}; components and magnitude")


def slider(motion: Motion, name: str) -> Figure:
    """The motion of a body that does not turn."""
    return _plane_motion(
        motion, motion.bodies[name], f"sliding body {name}", "the origin of its frame; it does not turn"
    )


def draw(axes: Axes, over: Horizon, words: str, unit: str, lines: Sequence[Line], *, floor: float = 0.0) -> None:
    """Lines (in ``unit``) with their labels at the right; of many, the largest get labels and the rest stay faint.

    What is below ``floor`` is rounding and drawn as zero. Lines of one body differ by their dashes.
    """
    lines = [(text, without_noise(values, floor), ink) for text, values, ink in lines]
    by_size = sorted(lines, key=lambda line: -float(np.ptp(line[1])))
    named = [line for line in lines if any(line is big for big in by_size[:LABELLED])]
    times: Counter[str] = Counter()
    ends = []
    for line in lines:
        text, values, ink = line
        is_named = any(line is big for big in named)
        dash = DASHES[times[ink] % len(DASHES)] if is_named else "-"
        times[ink] += is_named
        x, y = turned(over.values, values) if unit == "°" else (over.values, values)
        axes.plot(x, y, color=ink if is_named else FAINT, linestyle=dash, zorder=3 if is_named else 2, label=text)
        ends += [(text, float(y[-1]), ink)] if is_named else []
    low, high = axes.get_ylim()
    if all(np.ptp(values) == 0.0 for _, values, _ in lines):  # a constant is a straight line in the middle
        size = max((abs(float(values[0])) for _, values, _ in lines), default=0.0) or 4.0
        axes.set_ylim(low - 0.25 * size, high + 0.25 * size)
    cut(axes, [values for _, values, _ in lines], None if unit == "°" else over.margin, unit)
    low, high = axes.get_ylim()
    if low < 0 < high:
        axes.axhline(0, color="#9aa3ab", linewidth=0.9, zorder=1)
    dress_axis(axes.yaxis, words, unit)
    label_ends(axes, over.values[-1], ends)


def _largest(axes: Axes, over: Horizon, unit: str, values: np.ndarray, floor: float) -> None:
    """A dot where the first line is largest, and what it is there, in words above the axes."""
    k = first_peak(np.abs(values))
    if abs(values[k]) <= floor:
        return
    axes.plot(over.values[k], values[k], "o", color=INK, markersize=4.5, zorder=5, label="largest")
    size, at = abs(float(values[k])), float(over.values[k])
    text = speed(size) if unit == "m/s" else f"{written(size, unit)} ({figures(size / G, 3)} g)"
    where = written(at, over.unit, 4) if over.degrees else f"{figures(at)} s"
    axes.text(
        1.0, 1.02, f"largest {text} at {where}", transform=axes.transAxes, ha="right", va="bottom", color=QUIET,
        fontsize=9,
    )  # fmt: skip


def _plane_motion(motion: Motion, moving: PointMotion | BodyMotion, title: str, subtitle: str) -> Figure:
    """Three rows of components, with magnitudes; along an axis alone that component says it all."""
    figure = page(motion.mechanism, title, subtitle)
    over = horizon(motion)
    fast = max(float(np.hypot(moving.vx, moving.vy).max()), 0.0)
    floors = {"": 0.0, "v": NOISE * fast, "a": NOISE * fast * speed_scale(motion)}
    components = {axis: ink for axis, ink in zip("xy", PARTS, strict=True) if np.ptp(getattr(moving, axis)) > STILL}
    stacked = rows(figure, 3)
    figure.subplots_adjust(hspace=0.2)
    for axes, (rate, words, unit) in zip(stacked, KINDS, strict=True):
        lines = [(rate + axis, np.asarray(getattr(moving, rate + axis)), ink) for axis, ink in components.items()]
        if rate and len(components) == 2:
            lines.insert(0, (f"|{rate}|", np.hypot(lines[0][1], lines[1][1]), INK))
        draw(axes, over, words, unit, lines, floor=floors[rate])
        if rate and lines:
            _largest(axes, over, unit, lines[0][1], floors[rate])
    over.dress(figure.axes[-1])
    mark(figure, over, motion)
    return figure
