"""Pages of the motion: rates, turns and paths."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from render.magnitudes import NOISE, Crank, crank_of, force_scale, speed_scale, without_noise
from render.plots.measures import Horizon, cut, dress_axis, dress_plane, horizon, mark, turned
from render.plots.style import FAINT, INK, LABELLED, PARTS, QUIET, Labels, ink_of, insight_under, label_ends, page, rows
from render.report.written import first_peak
from shared.contract import AnyMotion, BodyMotion, Motion, PointMotion
from shared.contract.quantity import figures, written
from shared.contract.skeleton import Skeleton, Stroke

# Position, velocity and acceleration over the turn: of the bodies' angles, of a traced point, of a sliding body.

G = 9.80665
"""m/s²."""
STILL = 1e-9
"""m or rad: what varies less stands still."""
KINDS = (("", "position", "m"), ("v", "velocity", "m/s"), ("a", "acceleration", "m/s²"))
DASHES = ("-", (0, (5, 1.6)), (0, (1.6, 1.4)), (0, (7, 1.6, 1.6, 1.6)))
"""Dashes of lines of one body in turn."""
TURNING = ("quick_return", "dwell", "speed_ratio", "speed_peak", "difference", "transmission", "whirl", "swing")
DRAWN = ("straight_line", "ellipse", "step", "scale", "level", "crossing", "cusp", "centre", "orbit", "reach")
"""Kinds of insights under the titles of the pages of angles and of paths."""
Line = tuple[str, np.ndarray, str]
"""Label, values, colour."""


def bodies(motion: Motion) -> Figure:
    """Return angle (degrees), angular velocity (rad/s) and acceleration (rad/s^2) of every body."""
    figure = page(
        motion.mechanism,
        "angles of the bodies",
        "angle, angular velocity and angular acceleration",
        insight_under(motion, *TURNING),
    )
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
    """Return components and magnitudes of a traced point's motion."""
    traced = motion.points[name]
    return _plane_motion(motion, traced, f"traced point {name}", f"fixed to {traced.body}; components and magnitude")


def slider(motion: Motion, name: str) -> Figure:
    """Return the motion of a body that does not turn."""
    return _plane_motion(
        motion, motion.bodies[name], f"sliding body {name}", "the origin of its frame; it does not turn"
    )


def draw(axes: Axes, over: Horizon, words: str, unit: str, lines: Sequence[Line], *, floor: float = 0.0) -> None:
    """Draw lines (in ``unit``) with labels at the right; of many, only the largest are labelled.

    The rest stay faint. What is below ``floor`` is rounding and drawn as zero. Lines of one body differ by their
    dashes.
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
    """Draw a dot where the first line is largest, and its value above the axes."""
    k = first_peak(np.abs(values))
    if abs(values[k]) <= floor:
        return
    axes.plot(over.values[k], values[k], "o", color=INK, markersize=4.5, zorder=5, label="largest")
    size, at = abs(float(values[k])), float(over.values[k])
    text = written(size, unit) if unit == "m/s" else f"{written(size, unit)} ({figures(size / G, 3)} g)"
    where = written(at, over.unit, 4) if over.degrees else f"{figures(at)} s"
    axes.text(
        1.0, 1.02, f"largest {text} at {where}", transform=axes.transAxes, ha="right", va="bottom", color=QUIET,
        fontsize=9,
    )  # fmt: skip


def _plane_motion(motion: Motion, moving: PointMotion | BodyMotion, title: str, subtitle: str) -> Figure:
    """Return three rows of components, with magnitudes; along an axis alone that component says it all."""
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


# A simulated machine turn by turn: what it does over the angle of its crank, the last whole turn strong.

TURN = 2 * np.pi
EARLIER = "#b9c1c8"
MOST = 30
"""Turns that are drawn: the last ones."""
Panel = tuple[str, str, np.ndarray, str]
"""Words, unit, values, colour."""


def turns(motion: Motion) -> Figure:
    """Return crank speed, acceleration of what follows it on ground and axis reaction, over its angle."""
    crank = crank_of(motion)
    if crank is None:
        raise ValueError(f"{motion.mechanism}: no crank turns in this motion")
    figure = page(
        motion.mechanism, "turn by turn", f"over the angle of the {crank.body}: its last turn, and in grey those before"
    )  # fmt: skip
    theta = np.asarray(motion.bodies[crank.body].theta)
    forwards = bool(theta[-1] > theta[crank.first])
    angle = (theta if forwards else -theta)[crank.first :]
    panels = _panels(motion, crank)
    for axes, (words, unit, values, ink) in zip(rows(figure, len(panels)), panels, strict=True):
        _draw(axes, angle, values[crank.first :], ink)
        axes.margins(y=0.08)
        dress_axis(axes.yaxis, words, unit)
    lowest = figure.axes[-1]
    lowest.set_xlim(0.0, 360.0)
    dress_axis(lowest.xaxis, f"{crank.body} angle{'' if forwards else ', clockwise'}", "°", 9)
    return figure


def _draw(axes: Axes, angle: np.ndarray, values: np.ndarray, ink: str) -> None:
    """Draw (T,) over a rising angle (rad), cut where it passes whole turns."""
    start, end = float(angle[0]), float(angle[-1])
    first = max(np.floor(start / TURN), np.floor(end / TURN) - MOST)
    for turn in TURN * np.arange(first, np.ceil(end / TURN)):
        _piece(axes, angle, values, (max(turn, start), min(turn + TURN, end)), EARLIER, 1.0)
    turn = TURN * np.floor(end / TURN)
    for ends in ((end - TURN, turn), (turn, end)):
        _piece(axes, angle, values, ends, ink, 2.2)


def _piece(
    axes: Axes, angle: np.ndarray, values: np.ndarray, ends: tuple[float, float], ink: str, width: float
) -> None:
    """Draw a piece between two angles of one turn."""
    low, high = ends
    if high - low < STILL:
        return
    inside = (angle > low) & (angle < high)
    at = np.concatenate([[low], angle[inside], [high]])
    drawn = np.concatenate([np.interp([low], angle, values), values[inside], np.interp([high], angle, values)])
    base = TURN * np.floor((low + STILL) / TURN)
    axes.plot(np.degrees(at - base), drawn, color=ink, linewidth=width, zorder=2 if ink == EARLIER else 3)


def _panels(motion: Motion, crank: Crank) -> list[Panel]:
    """Return (T,) each."""
    body, fastest = motion.bodies[crank.body], speed_scale(motion)
    panels = [("speed", "rad/s", np.asarray(body.omega), body.colour)]
    follower = _follower(motion, crank.body)
    if follower is not None:
        name, moves = follower, motion.bodies[follower]
        if np.ptp(moves.theta) > STILL:
            unit, values, floor = "rad/s²", np.asarray(moves.alpha), NOISE * fastest**2
        else:
            field = "ax" if np.ptp(moves.x) >= np.ptp(moves.y) else "ay"
            unit, values, name = "m/s²", np.asarray(getattr(moves, field)), f"{name} {field}"
            floor = NOISE * float(np.abs(values).max())
        panels.append((name, unit, without_noise(values, floor), moves.colour))
    bearing = next(
        joint for joint in motion.joints.values() if joint.pair == "pin" and set(joint.bodies) == {"ground", crank.body}
    )
    pull = without_noise(np.hypot(bearing.fx, bearing.fy), NOISE * force_scale(motion))
    return [*panels, ("bearing force", "N", pull, body.colour)]


def _follower(motion: Motion, crank: str) -> str | None:
    """Return the last body that a joint holds on ground beside the crank and that comes back.

    It is the output of most machines.
    """
    held = [body for joint in motion.joints.values() if "ground" in joint.bodies for body in joint.bodies]
    others = [body for body in dict.fromkeys(held) if body not in ("ground", crank)]
    swinging = [body for body in others if np.ptp(motion.bodies[body].theta) < TURN]
    return swinging[-1] if swinging else None


# The path: the mechanism with its symbols at several poses, the ways of its joints, the curves of traced points.

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
    """Return the skeleton in its poses, ways of the joints, and curves of the traced points (m).

    The first pose is strong.
    """
    figure = page(
        motion.mechanism,
        "path",
        f"{len(skeleton.poses)} poses and dots in equal times over {_span(motion)}; the first pose is drawn strong",
        insight_under(motion, *DRAWN),
    )
    axes = figure.add_axes((0.075, 0.085, 0.9, 0.775))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    labels = Labels(axes)
    for joint in motion.joints.values():
        axes.plot(joint.x, joint.y, color=WAY, linewidth=0.9, zorder=1)
    faint_poses(axes, skeleton, motion)
    for stroke in skeleton.poses[0].strokes:
        draw_stroke(axes, stroke, motion, labels)
    _curves(axes, motion, skeleton, labels)
    draw_names(labels, skeleton, motion)
    dress_plane(axes)
    labels.write()
    return figure


def faint_poses(axes: Axes, skeleton: Skeleton, motion: AnyMotion) -> None:
    """Draw the bodies in all poses but the first, faint."""
    for pose in skeleton.poses[1:]:
        for stroke in pose.strokes:
            if stroke.ink.startswith("body:") and stroke.order >= WHEELS:
                axes.plot(*_corners(stroke).T, color=_ink(stroke.ink, motion), linewidth=0.8, alpha=0.3, zorder=1.2)


def draw_names(labels: Labels, skeleton: Skeleton, motion: AnyMotion) -> None:
    """Ask for the names of bodies, joints and points."""
    for name in skeleton.names:
        of_body = name.text in motion.bodies
        labels.add(
            name.text, name.at, _ink(name.ink, motion), weight="normal" if of_body else "bold", clearance=name.clearance
        )


def _span(motion: Motion) -> str:
    whole = motion.time[-1] - motion.time[0]
    turns = whole / motion.period if motion.period else None
    return written(whole, "s") + (" (one period)" if turns and abs(turns - 1) < 1e-9 else "")


def _corners(stroke: Stroke) -> np.ndarray:
    """Return (k, 2) of the line that is drawn (m)."""
    points = np.reshape(stroke.points, (-1, 2))
    return np.vstack([points, points[:1]]) if stroke.closed else points


def draw_stroke(axes: Axes, stroke: Stroke, motion: AnyMotion, labels: Labels) -> None:
    """Draw a stroke of the first pose, which names keep clear of."""
    labels.avoid_lines([(float(x), float(y)) for x, y in _corners(stroke)])
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


def _ink(role: str, motion: AnyMotion) -> str:
    """Return the colour of a role of skeleton.json on this page; a body has that of its other plots."""
    body = role.removeprefix("body:")
    if body != role and body in motion.bodies:
        return motion.bodies[body].colour
    return INKS.get(role, INK)
