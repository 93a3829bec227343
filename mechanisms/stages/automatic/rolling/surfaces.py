"""Surfaces along open curves: as long as the curve, and on along its straight continuations as far as something rolls
or slides there.

A wheel that rolls on a curve follows its branch through whatever the curve crosses (mbsd/arrays/curve_branches.py); a
wall cannot be crossed. So where the whole surface would be in the wheel's way it is cut to what the wheel runs on, and
where that is, the joint has no parts.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.automatic.layout.followed import continued, end_ways, evenly, followed
from mechanisms.stages.automatic.layout.profiles import curve_path, on_body
from mechanisms.stages.automatic.rolling.backings import THICK, behind, is_simple, straight_back
from mechanisms.stages.automatic.rolling.roads import Road, along, backed
from shared.shapes.band import normals
from shared.shapes.polyline import distances
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

if TYPE_CHECKING:
    from mbsd.model.force import Force
    from mbsd.model.joint import Joint
    from mechanisms.stages.automatic.layout.layout import Layout
    from mechanisms.stages.automatic.rolling.rounds import Round

BEYOND = (0.8, 0.1)
"""How far a surface goes on beyond the way of a wheel, in the wheel's radii; less where that is in its way."""
FINE = 4
"""A curve is followed at so many places to each of its path."""
MOST = 2000
"""So many places of a wheel are looked at."""
OFF = 0.05
"""How much nearer than its radius a wheel may come to a surface that it does not touch, for rounding (rmm)."""
TOUCHES = 0.5
"""What is nearer than this to a surface touches it (rmm)."""

LEAST = 1e-6
"""What goes on by less than this (rmm) does not."""


def rolled_road(joint: Joint, part: Round, layout: Layout) -> Road:
    """The road of a disc that rolls on an open curve. Raises UserError where each would be in the disc's way."""
    path = on_body(curve_path(joint.params["points"], False), joint.i, layout)
    centres = layout.seen(joint.j.body.name, layout.place(joint.j), joint.i.body.name)
    radius, few = layout.sizes.of_metres(joint.params["radius"]), centres[:: max(1, len(centres) // MOST)]
    ways = end_ways(joint.params["points"], joint.i)
    run = _run(path, ways, few, radius)
    tried = list(_surfaces(path, ways, run, radius))
    for surface in tried:
        if distances(few, surface).min() >= radius - OFF:
            road = backed(joint.name, part, surface, few, radius - OFF)
            if road is not None:
                return road
    raise UserError(_refusal(joint, tried[-1], centres, radius, layout))


def touched_path(touch: Joint | Force, places: np.ndarray, radius: float, layout: Layout) -> np.ndarray:
    """(n, 2) the open curve of a contact in the frame of its body (rmm), with as much of its straight continuations as
    a disc about ``places`` (T, 2) touches.
    """
    points, ends = touch.params["points"], []
    path, ways = on_body(curve_path(points, False), touch.i, layout), end_ways(points, touch.i)
    for end, way in zip(path[[0, -1]], ways, strict=True):
        ahead = (places - end) @ way
        beside = np.abs((places - end) @ behind(way)) - radius
        out = ahead[(ahead > 0.0) & (beside < TOUCHES)]
        ends.append(end + (float(out.max()) + BEYOND[0] * radius) * way if len(out) else end)
    return _with_ends(path, np.array(ends))


def touched_road(touch: Joint | Force, part: Round, path: np.ndarray, places: np.ndarray, layout: Layout) -> Road:
    """The road of a contact along a path (n, 2) (rmm) that a round part about ``places`` (T, 2) touches. Raises
    UserError where nothing has room behind the surface.
    """
    few = places[:: max(1, len(places) // MOST)]
    road = backed(touch.name, part, path, few, part.made - part.pressed - OFF)
    road = road or along(touch.name, [part], path)
    if road.band is None and not is_simple(path, road.feet):
        m = layout.m
        raise UserError(
            f"{m.name}: contact '{touch.name}': its curve turns back so far that neither a straight lower side nor a "
            f"band of {THICK * layout.sizes.scale:.3g} mm behind it is clear of what touches it; cut it into several "
            f"curves, or write {shown_file(m.name, 'parts')}"
        )
    return road


def _run(path: np.ndarray, ways: np.ndarray, centres: np.ndarray, radius: float) -> tuple[float, float]:
    """From where to where along a curve a disc rolls (rmm from its first place)."""
    even = evenly(path, FINE * len(path))
    offset = even + radius * normals(even)
    length, step = float(np.hypot(*np.diff(path, axis=0).T).sum()), float(np.hypot(*np.diff(offset, axis=0).T).max())
    ahead = float(np.linalg.norm(centres[:, None] - offset[[0, -1]], axis=2).max())
    whole, before = continued(offset, ways, ahead, step)
    numbers = followed(whole, centres, False) - before
    last = len(even) - 1
    inside = np.clip(numbers, 0, last) * (length / last)
    places = inside + step * (np.minimum(numbers, 0) + np.maximum(numbers - last, 0))
    return float(places.min()), float(places.max())


def _surfaces(path: np.ndarray, ways: np.ndarray, run: tuple[float, float], radius: float) -> Iterable[np.ndarray]:
    """The whole curve with what is rolled on beyond its ends, then what is rolled on alone."""
    length = float(np.hypot(*np.diff(path, axis=0).T).sum())
    low, high = run
    for part in BEYOND:
        out = np.array([low - part * radius if low < 0.0 else 0.0, high + part * radius if high > length else length])
        yield _with_ends(path, path[[0, -1]] + np.maximum([-out[0], out[1] - length], 0.0)[:, None] * ways)
    for part in BEYOND:
        first, last = low - part * radius, high + part * radius
        ends = path[[0, -1]] + np.maximum([-first, last - length], 0.0)[:, None] * ways
        whole = _with_ends(path, ends)
        at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(whole, axis=0).T))]) + min(first, 0.0)
        cut = [np.array([np.interp(end, at, side) for side in whole.T]) for end in (first, last)]
        yield np.vstack([cut[0], whole[(at > first + OFF) & (at < last - OFF)], cut[1]])


def _with_ends(path: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """A path that goes on to two other ends."""
    first, last = (ends[[k]] if np.hypot(*(ends[k] - path[k])) > LEAST else ends[:0] for k in (0, -1))
    return np.vstack([first, path, last])


def _refusal(joint: Joint, surface: np.ndarray, centres: np.ndarray, radius: float, layout: Layout) -> str:
    m, scale, body = layout.m, layout.sizes.scale, joint.i.body.name
    away = distances(centres, surface)
    sides = distances(centres, np.vstack([surface[-1:], straight_back(surface), surface[:1]]))
    at = int(np.argmin(away if away.min() < radius - OFF else sides))
    x, y = centres[at] * scale
    return (
        f"{m.name}: joint '{joint.name}': at t={layout.times[at]:.4g} s the disc of '{joint.j.body.name}', "
        f"{radius * scale:.4g} mm in radius, is at ({x:.4g}, {y:.4g}) mm in the frame of '{body}', where another "
        f"stretch of its own road is {min(away[at], sides[at]) * scale:.3g} mm from its middle: it would run through a "
        "wall. Let the motion end before, part the stretches of the curve (its straight continuations are some of "
        f"them), make the disc smaller, or write {shown_file(m.name, 'parts')}"
    )
