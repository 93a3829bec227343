"""Curves in the body's frame as the numbers that constraints/curve_pieces.py reads.

Source of the spline: de Boor, A Practical Guide to Splines; the parameter is the length of the chords.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import ModelError
from mbsd.model.laws.curve import Curve

FINE, MOST_CHORDS = 4, 4000
"""Chords of a piece, and in all, with which crossings are looked for."""
PART_OF_LOOP = 1 / 8
"""Of the shortest loop: how far a point may go in one step."""
LEAST_PIECES, LEAST_PARTS = 128, 4
"""Pieces in all, and for each piece of the spline: the nearest node leads to the foot, arc lengths are exact."""


def curve_pieces(points: np.ndarray, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """Breaks (p + 1,) and coefficients (p, 2, 6), lowest first, of a spline of degree 5 through points (k, 2).

    Fewer than six points give a lower degree, two a straight line. A closed curve returns to its first point smoothly.
    """
    from scipy.interpolate import make_interp_spline

    if closed:
        points = np.vstack([points, points[:1]])
    u = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    degree = 5 if closed else min(5, len(points) - 1)
    degree -= degree in (2, 4)  # even degrees put their knots between the points
    spline = make_interp_spline(u, points, k=degree, bc_type="periodic" if closed else None)
    breaks = np.unique(spline.t)
    breaks = breaks[(breaks >= u[0]) & (breaks <= u[-1])]
    parts = max(LEAST_PARTS, math.ceil(LEAST_PIECES / (len(breaks) - 1)))
    shares = np.arange(parts) / parts
    breaks = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * shares).ravel(), breaks[-1])
    coefficients = np.zeros((len(breaks) - 1, 2, 6))
    for power in range(degree + 1):
        coefficients[:, :, power] = spline(breaks[:-1], power) / math.factorial(power)
    return breaks, coefficients


def curve_numbers(
    breaks: np.ndarray,
    coefficients: np.ndarray,
    closed: bool,
    distance: float,
    radius: float,
    farthest: float = 0.0,
) -> np.ndarray:
    """The own numbers of a curve constraint; a closed curve ends with arc length and turning of a round.

    ``farthest``: how far the foot may go at once on a curve that crosses itself (m).
    """
    fine = 8
    nodes, weights = np.polynomial.legendre.leggauss(fine)
    h = np.diff(breaks)
    powers = np.arange(1, 6)
    slopes = coefficients[:, :, 1:] * powers

    def tangent(s: np.ndarray) -> np.ndarray:
        """(p, 2) derivative at local parameters s (p,)."""
        return (slopes * s[:, None, None] ** np.arange(5)).sum(axis=2)

    speeds = [np.hypot(*tangent(h * (1 + node) / 2).T) for node in nodes]
    arc = np.concatenate([[0.0], np.cumsum(h / 2 * sum(w * v for w, v in zip(weights, speeds, strict=True)))])
    ends = np.vstack([tangent(np.zeros(len(h))), tangent(h)[-1:]])
    turning = np.unwrap(np.arctan2(ends[:, 1], ends[:, 0]))
    rows = np.column_stack([breaks[:-1], coefficients.reshape(len(h), 12), arc[:-1], turning[:-1]])
    head = [distance, radius, float(closed), breaks[-1] - breaks[0], len(h), farthest]
    return np.concatenate([head, rows.ravel(), [arc[-1], turning[-1] - turning[0]]])


def disc_numbers(params: Mapping[str, Any]) -> list[np.ndarray]:
    """Those of the constraints `curve` and `curve_rolling` of a disc on a curve: ``points``, ``closed``, ``radius``."""
    closed, radius = params["closed"], params["radius"]
    pieces = curve_pieces(np.array(params["points"], float), closed)
    numbers = curve_numbers(*pieces, closed, radius, radius, farthest_step(*pieces, closed, radius))
    return [numbers, numbers]


def crossings(breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float) -> np.ndarray:
    """(c, 2) pairs of parameters at which the curve parallel at ``distance`` (m, left) crosses itself, roughly."""
    fine = max(1, min(FINE, MOST_CHORDS // len(coefficients)))
    s = (np.diff(breaks)[:, None] * np.arange(fine) / fine)[..., None]
    u = (breaks[:-1, None] + s[..., 0]).ravel()
    powers = np.arange(6)
    place = np.einsum("pdk,psk->psd", coefficients, s**powers).reshape(-1, 2)
    slope = np.einsum("pdk,psk->psd", coefficients[:, :, 1:] * powers[1:], s ** powers[:-1]).reshape(-1, 2)
    place = place + distance * np.stack([-slope[:, 1], slope[:, 0]], axis=1) / np.hypot(*slope.T)[:, None]
    a, b = (place, np.roll(place, -1, axis=0)) if closed else (place[:-1], place[1:])
    u, n = u[: len(a)], len(a)
    out: list[np.ndarray] = []

    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])

    for k in range(n - 2):
        others = np.arange(k + 2, n - (closed and k == 0))
        one, two = side(a[k], b[k], a[others]), side(a[k], b[k], b[others])
        three, four = side(a[others], b[others], a[k]), side(a[others], b[others], b[k])
        for hit in others[(one * two <= 0) & (three * four <= 0) & ((one != 0) | (two != 0))]:
            out.append(np.array([u[k], u[hit]]))
    return np.array(out).reshape(-1, 2)


def farthest_step(breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float) -> float:
    """How far the foot may go at once (m): a part of the shortest loop of a curve that crosses itself, else 0."""
    found = crossings(breaks, coefficients, closed, distance)
    if not len(found):
        return 0.0
    around = np.abs(found[:, 1] - found[:, 0])
    if closed:
        around = np.minimum(around, breaks[-1] - breaks[0] - around)
    return float(around.min()) * PART_OF_LOOP


def graph_numbers(profile: Curve) -> np.ndarray:
    """The own numbers of a curve y(x), traversed as x rises."""
    poly = profile.pieces
    breaks = np.unique(poly.x)
    parts = max(LEAST_PARTS, math.ceil(LEAST_PIECES / (len(breaks) - 1)))
    shares = np.arange(parts) / parts
    breaks = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * shares).ravel(), breaks[-1])
    coefficients = np.zeros((len(breaks) - 1, 2, 6))
    coefficients[:, 0, 0], coefficients[:, 0, 1] = breaks[:-1], 1.0
    for power in range(len(poly.c)):
        coefficients[:, 1, power] = poly(breaks[:-1], power) / math.factorial(power)
    return curve_numbers(breaks, coefficients, False, 0.0, 0.0)


def curvature(breaks: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """(p,) signed curvature (1/m) at the begin of each piece, positive to the left."""
    dx, dy = coefficients[:, 0, 1], coefficients[:, 1, 1]
    ddx, ddy = 2 * coefficients[:, 0, 2], 2 * coefficients[:, 1, 2]
    return (dx * ddy - dy * ddx) / np.hypot(dx, dy) ** 3


def checked_points(what: str, points: object, closed: bool) -> list[list[float]]:
    """Points (k, 2) as plain data. Raises ModelError for what is no curve."""
    array = number_array(f"{what}: points", points)
    if array.ndim != 2 or array.shape[1] != 2 or len(array) < (6 if closed else 2):
        raise ModelError(
            f"{what}: points of shape {array.shape} must be {'six' if closed else 'two'} or more rows of x, y (m)"
        )
    if closed and np.array_equal(array[0], array[-1]):
        array = array[:-1]
    steps = np.hypot(*np.diff(np.vstack([array, array[:1]]) if closed else array, axis=0).T)
    if not steps.min() > 1e-9 * steps.max():
        raise ModelError(f"{what}: points {int(np.argmin(steps))} and the next are the same; remove one")
    if not math.isfinite(float(steps.sum())):
        raise ModelError(f"{what}: the points are too far apart")
    return array.tolist()


def refuse_crossing(what: str, points: list[list[float]], closed: bool) -> None:
    """Raise ModelError for a curve that crosses itself: it has no side on which matter could be."""
    pieces = curve_pieces(np.array(points), closed)
    found = crossings(*pieces, closed, 0.0)
    if len(found):
        k = min(int(np.searchsorted(pieces[0], found[0, 0], "right")) - 1, len(pieces[1]) - 1)
        x, y = pieces[1][k, :, 0]
        raise ModelError(
            f"{what}: the curve crosses itself near ({x:.4g}, {y:.4g}) m, where it has no side that is free; cut it "
            "into curves that do not, or take rolling_on_curve or point_on_curve, which follow it through"
        )


def refuse_tight(what: str, points: list[list[float]], closed: bool, radius: float) -> None:
    """Raise ModelError where a curve bends to the left so tightly that a disc of ``radius`` (m) touches twice."""
    tightest = float(curvature(*curve_pieces(np.array(points), closed)).max())
    if tightest * radius >= 1.0:
        raise ModelError(
            f"{what}: the curve is bent to a radius of {1 / tightest:.4g} m, where a disc of {radius:.4g} m "
            "touches twice; use a smaller disc or a smoother curve"
        )
