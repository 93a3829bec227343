"""A simulated machine turn by turn: what it does over the angle of its crank, the last whole turn strong."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from render.crank import Crank, crank_of
from render.magnitudes import NOISE, force_scale, speed_scale, without_noise
from render.plots.measures import dress_axis
from render.plots.style import page, rows
from shared.contract import Motion

STILL = 1e-9
"""rad: what varies less does not turn."""
TURN = 2 * np.pi
EARLIER = "#b9c1c8"
MOST = 30
"""Turns that are drawn: the last ones."""
Panel = tuple[str, str, np.ndarray, str]
"""Words, unit, values, colour."""


def turns(motion: Motion) -> Figure:
    """Speed of the crank, acceleration of what follows it on ground, reaction at its axis, over its angle."""
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
    """(T,) over a rising angle (rad), cut where it passes whole turns."""
    start, end = float(angle[0]), float(angle[-1])
    first = max(np.floor(start / TURN), np.floor(end / TURN) - MOST)
    for cut in TURN * np.arange(first, np.ceil(end / TURN)):
        _piece(axes, angle, values, (max(cut, start), min(cut + TURN, end)), EARLIER, 1.0)
    cut = TURN * np.floor(end / TURN)
    for ends in ((end - TURN, cut), (cut, end)):
        _piece(axes, angle, values, ends, ink, 2.2)


def _piece(
    axes: Axes, angle: np.ndarray, values: np.ndarray, ends: tuple[float, float], ink: str, width: float
) -> None:
    """Between two angles of one turn."""
    low, high = ends
    if high - low < STILL:
        return
    inside = (angle > low) & (angle < high)
    at = np.concatenate([[low], angle[inside], [high]])
    drawn = np.concatenate([np.interp([low], angle, values), values[inside], np.interp([high], angle, values)])
    base = TURN * np.floor((low + STILL) / TURN)
    axes.plot(np.degrees(at - base), drawn, color=ink, linewidth=width, zorder=2 if ink == EARLIER else 3)


def _panels(motion: Motion, crank: Crank) -> list[Panel]:
    """(T,) each."""
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
    """The last body that a joint holds on ground beside the crank, and that comes back: the output of most machines."""
    held = [body for joint in motion.joints.values() if "ground" in joint.bodies for body in joint.bodies]
    others = [body for body in dict.fromkeys(held) if body not in ("ground", crank)]
    swinging = [body for body in others if np.ptp(motion.bodies[body].theta) < TURN]
    return swinging[-1] if swinging else None
