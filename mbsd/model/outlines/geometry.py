"""Geometry of outlines: lines, arcs and splines as closed rows of corners (x, y, bulge).

    b = tan(sweep / 4)      bulge of the piece to the next corner, as in DXF; 0: a line;  |b| = 1: half a circle

Splines become arcs: each interval of a cubic spline becomes two arcs with the spline's tangents at its ends (a biarc),

    p_0 + d t_0,  p_1 - d t_1,    d = (-v . t + sqrt((v . t)^2 + 2 (1 - t_0 . t_1) v . v)) / (2 (1 - t_0 . t_1))

with v = p_1 - p_0 and t = t_0 + t_1; the arcs meet midway between these two points. Intervals are halved until the arcs
stay within a tolerance of the spline.

Source: Bolton, Biarc curves, Computer-Aided Design 7 (1975), 89.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

Corner = tuple[float, float, float]

STRAIGHT = 1e-12
"""A bulge below this is a line."""
TOLERANCE = 1e-5
"""Part of the size within which arcs follow a spline, if nothing else is given."""
DEEPEST = 12
"""Halvings of an interval of a spline at most."""
CHORD = math.radians(6.0)
"""Turn of the chords that stand for an arc."""


def spline_corners(points: np.ndarray, closed: bool, tolerance: float | None) -> list[Corner]:
    """Return corners of biarcs along the cubic spline through points (k, 2)."""
    from scipy.interpolate import CubicSpline

    if closed:
        points = points if np.allclose(points[0], points[-1], rtol=0, atol=0) else np.vstack([points, points[:1]])
    steps = np.hypot(*np.diff(points, axis=0).T)
    kept = np.append(True, steps > 0.0)
    points, steps = points[kept], steps[steps > 0.0]
    u = np.append(0.0, np.cumsum(steps))
    spline = CubicSpline(u, points, bc_type="periodic" if closed else "not-a-knot")
    within = tolerance if tolerance is not None else TOLERANCE * float(np.hypot(*np.ptp(points, axis=0)))
    corners: list[Corner] = []
    for left, right in pairwise(u.tolist()):
        _add_biarcs(spline, left, right, within, 0, corners)
    return corners if closed else [*corners, (float(points[-1, 0]), float(points[-1, 1]), 0.0)]


def _add_biarcs(spline, left: float, right: float, within: float, depth: int, corners: list[Corner]) -> None:
    """Append the corners of biarcs from ``left`` to ``right``, parameters of a spline, without the last."""
    ends, slopes = spline([left, right]), spline([left, right], 1)
    slopes = slopes / np.hypot(*slopes.T)[:, None]
    middle = _meeting(ends, slopes)
    arcs = [(ends[0], _bulge(ends[0], slopes[0], middle)), (middle, -_bulge(ends[1], -slopes[1], middle))]
    seen = spline(left + (right - left) * np.arange(1, 12) / 12)
    far = max(min(_distance(p, arcs[0], middle), _distance(p, arcs[1], ends[1])) for p in seen)
    if far > within and depth < DEEPEST:
        half = 0.5 * (left + right)
        _add_biarcs(spline, left, half, within, depth + 1, corners)
        _add_biarcs(spline, half, right, within, depth + 1, corners)
        return
    corners.extend((float(start[0]), float(start[1]), bulge) for start, bulge in arcs)


def _meeting(ends: np.ndarray, slopes: np.ndarray) -> np.ndarray:
    """Return where the two arcs of a biarc meet."""
    v, t = ends[1] - ends[0], slopes[0] + slopes[1]
    bend, along, square = 2.0 * (1.0 - slopes[0] @ slopes[1]), v @ t, v @ v
    if bend > 1e-12:
        d = (-along + math.sqrt(along * along + bend * square)) / bend
    else:
        d = square / (4.0 * (v @ slopes[1])) if v @ slopes[1] > 0.0 else 0.5 * math.sqrt(square)
    return 0.5 * (ends[0] + d * slopes[0] + ends[1] - d * slopes[1])


def _bulge(start: np.ndarray, tangent: np.ndarray, end: np.ndarray) -> float:
    """Return the bulge of the arc from ``start`` along ``tangent`` to ``end``."""
    v = end - start
    return math.tan(math.atan2(tangent[0] * v[1] - tangent[1] * v[0], tangent @ v) / 2)


def _distance(point: np.ndarray, arc: tuple[np.ndarray, float], end: np.ndarray) -> float:
    """Return how far a point is from a line or arc that it is beside."""
    start, bulge = arc
    v = end - start
    chord = math.hypot(*v)
    if abs(bulge) < STRAIGHT or chord == 0.0:
        return abs(v[0] * (point - start)[1] - v[1] * (point - start)[0]) / (chord or 1.0)
    x, y, radius, *_ = arc_of((*start, bulge), (*end, 0.0))
    return abs(math.hypot(point[0] - x, point[1] - y) - radius)


def arc_of(first: Sequence[float], second: Sequence[float]) -> tuple[float, float, float, float]:
    """Return centre x, y, radius (m) and sweep (rad, left positive) of the arc between two corners."""
    bulge = first[2]
    vx, vy = second[0] - first[0], second[1] - first[1]
    aside = (1.0 - bulge * bulge) / (4.0 * bulge)
    x = 0.5 * (first[0] + second[0]) - aside * vy
    y = 0.5 * (first[1] + second[1]) + aside * vx
    return x, y, math.hypot(vx, vy) * (1.0 + bulge * bulge) / (4.0 * abs(bulge)), 4.0 * math.atan(bulge)


def signed_area(corners: Sequence[Corner]) -> float:
    """Return what corners enclose (m^2), negative where they run clockwise."""
    area = 0.0
    for first, second in zip(corners, [*corners[1:], corners[0]], strict=True):
        area += 0.5 * (first[0] * second[1] - second[0] * first[1])
        if abs(first[2]) > STRAIGHT:
            _, _, radius, sweep = arc_of(first, second)
            area += 0.5 * radius * radius * (sweep - math.sin(sweep))
    return area


def reversed_corners(corners: Sequence[Corner]) -> tuple[Corner, ...]:
    """Return the same curve the other way round."""
    turned = list(reversed(corners))
    return tuple((x, y, -bulge) for (x, y, _), (_, _, bulge) in zip(turned, [*turned[1:], turned[0]], strict=True))


def flattened(corners: Sequence[Corner], chord: float) -> tuple[list[tuple[float, float]], list[int]]:
    """Return points along corners, the first at the end again, and the piece that begins at each."""
    points: list[tuple[float, float]] = []
    pieces: list[int] = []
    for k, (first, second) in enumerate(zip(corners, [*corners[1:], corners[0]], strict=True)):
        points.append(first[:2])
        pieces.append(k)
        if abs(first[2]) <= STRAIGHT:
            continue
        x, y, radius, sweep = arc_of(first, second)
        begin = math.atan2(first[1] - y, first[0] - x)
        count = max(1, math.ceil(abs(sweep) / chord))
        for step in range(1, count):
            angle = begin + sweep * step / count
            points.append((x + radius * math.cos(angle), y + radius * math.sin(angle)))
            pieces.append(k)
    return [*points, points[0]], pieces


def depths_in(path: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return (k,) how far places (k, 2) are inside a closed path (n, 2), negative outside."""
    start, step = path[:-1], np.diff(path, axis=0)
    to = places[:, None] - start
    share = np.clip((to * step).sum(axis=2) / np.maximum((step**2).sum(axis=1), 1e-300), 0.0, 1.0)
    far = np.hypot(*np.moveaxis(to - share[..., None] * step, 2, 0)).min(axis=1)
    over = (start[:, 1] > places[:, 1:]) != (path[1:, 1] > places[:, 1:])
    with np.errstate(divide="ignore", invalid="ignore"):
        right = to[..., 1] / step[:, 1] * step[:, 0] > to[..., 0]
    return np.where((over & right).sum(axis=1) % 2 == 1, far, -far)


def size_of(corners: Sequence[Corner]) -> float:
    """Return the diagonal of the box around corners (m)."""
    points = np.array(flattened(corners, CHORD)[0]) if len(corners) > 1 else np.zeros((1, 2))
    return float(np.hypot(*np.ptp(points, axis=0)))
