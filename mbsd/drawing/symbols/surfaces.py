"""Lines, profiles and curves on which something runs, drawn as far as it goes.

Beyond its ends each goes on straight.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import on_body
from mbsd.drawing.pose import Pose
from mbsd.drawing.symbols.geometry import BESIDE, placed
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.laws.curve import Curve

NEAR = 0.02
"""Distance from a straight continuation within which something touches it, in the size of its curve."""
LEAST = 1e-6
"""A continuation shorter than this is none, in the size of its curve."""
MOST = 400
"""Strokes on the solid side of a way."""


def draw_way(canvas: Canvas, path: np.ndarray, body: str, colours: dict[str, str]) -> None:
    """Draw a line or curve of a body on which something runs, to its left.

    Ground's has strokes on the right.
    """
    with canvas.on(on_body(body)):
        if body == "ground":
            _hatched(canvas, path)
        else:
            canvas.line(path, colours[body], 2.2, order=3.5)


def _hatched(canvas: Canvas, path: np.ndarray) -> None:
    canvas.line(path, order=1.5)
    steps = np.diff(path, axis=0)
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    count = min(MOST, max(3, round(arc[-1] / (0.62 * canvas.unit))))
    for s in (np.arange(count) + 0.8) / count * arc[-1]:
        k = min(int(np.searchsorted(arc, s, side="right")) - 1, len(steps) - 1)
        along = steps[k] / (arc[k + 1] - arc[k])
        root = path[k] + (s - arc[k]) * along
        lean = (np.array([along[1], -along[0]]) - along) * 0.55 * canvas.unit
        canvas.line([root, root + lean], width=0.9, order=1.5)


def curve_way(joint: Joint, pose: Pose, key: str) -> np.ndarray:
    """Return (k, 2) of the spline through the points of a joint or contact, in the world (m).

    An open one goes on along its end tangents as far as what touches it comes, and a little more. ``key``: its name in
    ``pose.travel``.
    """
    points = tuple((float(x), float(y)) for x, y in joint.params["points"])
    path, ways = _spline(points, joint.params["closed"])
    if ways is None:
        return placed(pose, joint.i, path)
    radius = joint.params.get("radius", abs(joint.params.get("distance", 0.0)))
    seen, size = _seen(joint.i, joint.j, pose, key), float(np.ptp(path, axis=0).max())
    ends = []
    for end, way in zip(path[[0, -1]], ways, strict=True):
        ahead, aside = (seen - end) @ way, (seen - end) @ np.array([-way[1], way[0]])
        touching = ahead[np.abs(np.abs(aside) - radius) < NEAR * size]
        far = float(touching.max(initial=0.0))
        ends.append((end + (far + BESIDE * radius) * way)[None] if far > LEAST * size else path[:0])
    return placed(pose, joint.i, np.vstack([ends[0], path, ends[1]]))


def surface_way(force: Force, pose: Pose, beyond: float, whole: bool = True) -> np.ndarray:
    """Return (k, 2) of the profile or straight line that a contact force acts on, in the world (m).

    It goes as far as its body comes and ``beyond`` (m). ``whole``: with all of a profile, even where its body never
    comes.
    """
    seen = _seen(force.i, force.j, pose, f"force {force.name}")[:, 0]
    x, profile = np.array([seen.min() - beyond, seen.max() + beyond]), force.laws.get("profile")
    if not isinstance(profile, Curve):
        return placed(pose, force.i, np.stack([x, np.zeros(2)], axis=1))
    ends = (profile.x[0], profile.x[-1])
    low, high = ends if whole else np.clip(ends, *x)
    x = np.unique(np.concatenate([x, np.linspace(low, high, 121)]))
    return placed(pose, force.i, np.stack([x, profile(x)[:, 0]], axis=1))


def _seen(i: Marker, j: Marker, pose: Pose, key: str) -> np.ndarray:
    """Return (T, 2) places of marker j in the axes of marker i (m), over the motion and now."""
    axis, gap = pose.axis(i), pose.place(j) - pose.place(i)
    here = np.array([[gap @ axis, gap @ np.array([-axis[1], axis[0]])]])
    if key not in pose.travel:
        return here
    return np.vstack([np.stack([pose.travel[key], pose.aside[key]], axis=1), here])


@lru_cache(maxsize=32)
def _spline(points: tuple[tuple[float, float], ...], closed: bool) -> tuple[np.ndarray, np.ndarray | None]:
    """Return (k, 2) in the axes of the marker (m), and unit vectors out of both ends of an open curve."""
    from mbsd.model.plane_curves import curve_pieces, end_ways

    breaks, coefficients = curve_pieces(np.array(points), closed)
    end = (coefficients[-1] * (breaks[-1] - breaks[-2]) ** np.arange(6)).sum(axis=1)
    return np.vstack([coefficients[:, :, 0], end]), None if closed else end_ways(breaks, coefficients)
