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
from mbsd.base.running import Kept
from mbsd.model.laws.curve import Curve

FINE, MOST_CHORDS = 4, 4000
"""Chords of a piece, and in all, with which crossings are looked for."""
PART_OF_LOOP = 1 / 8
"""Fraction of the shortest loop: how far a point may go in one step."""
BLOCK = 64
"""Chords that are compared with all others at once."""
PARALLEL = 1e-6
"""Sine of the angle below which straight continuations do not meet."""
SAME = 1e-9
"""Fraction of the longest step between points: those closer than this are the same."""
TRIED, MOST_TRIED = 8, 512
"""Places of a piece, and pieces, from which it is tried whether the nearest node leads to the foot."""
CLOSER = 0.7
"""Weight of squared distances of nodes elsewhere, since between the places tried they may be nearer still."""
ROUNDABOUT = 2.0
"""Ways along the curve longer than this part of the chord lead round more than half a circle, to another part."""
SHARP = 1.0
"""Turning of a piece (rad) that has room for two feet of one point."""
LOOKS = 48
"""Nodes that find_foot looks at first, as mbsd/equations/relative/curve_pieces.py says."""
LEAST_PIECES, LEAST_PARTS = 128, 4
"""Pieces in all, and for each piece of the spline: the nearest node leads to the foot, arc lengths are exact."""


def curve_pieces(points: np.ndarray, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return breaks (p + 1,) and coefficients (p, 2, 6) of a degree-5 spline through points (k, 2).

    Coefficients go from the lowest power up.

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


def end_ways(breaks: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """(2, 2) unit vectors out of both ends of an open curve, along which it goes on straight."""
    powers = np.arange(1, 6)
    last = (coefficients[-1, :, 1:] * powers * (breaks[-1] - breaks[-2]) ** (powers - 1)).sum(axis=1)
    ways = np.array([-coefficients[0, :, 1], last])
    return ways / np.hypot(*ways.T)[:, None]


def curve_numbers(
    breaks: np.ndarray,
    coefficients: np.ndarray,
    closed: bool,
    distance: float,
    radius: float,
    farthest: float = 0.0,
) -> np.ndarray:
    """The own numbers of a curve constraint (mbsd/equations/relative/curve_pieces.py).

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
    end = (coefficients[-1] * h[-1] ** np.arange(6)).sum(axis=1)
    doubtful = np.abs(np.diff(turning)).max() > SHARP or _passes_itself(breaks, coefficients, closed, distance)
    reach = float(np.diff(arc).max()) / 2 if doubtful else 0.0
    return np.concatenate([head, rows.ravel(), [arc[-1], turning[-1] - turning[0], *end, *ends[-1], reach]])


def _passes_itself(breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float) -> bool:
    """Return True if another part of a curve is so close that a point's nearest node may mislead.

    It may then not lead to the point's foot.

    Looked for as the kernel does (find_foot), from places at ``distance`` (m, left) of the curve.
    """
    key = breaks.tobytes(), coefficients.tobytes(), closed, distance
    return _PASSES.get(key, lambda: _wrong_nodes(breaks, coefficients, closed, distance))


_PASSES: Kept[bool] = Kept()


def _wrong_nodes(breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float) -> bool:
    count = len(coefficients)
    h, powers = np.diff(breaks), np.arange(6)
    shares = (np.arange(TRIED) + 0.5) / TRIED
    piece = np.unique(np.linspace(0, count - 1, min(count, MOST_TRIED)).astype(int))
    s = h[piece, None] * shares
    place = np.einsum("pdk,psk->psd", coefficients[piece], s[..., None] ** powers)
    slope = np.einsum("pdk,psk->psd", coefficients[piece, :, 1:] * powers[1:], s[..., None] ** powers[:-1])
    across = np.stack([-slope[..., 1], slope[..., 0]], axis=-1) / np.hypot(slope[..., 0], slope[..., 1])[..., None]
    on, place = place.reshape(-1, 1, 2), (place + distance * across).reshape(-1, 1, 2)
    nodes = np.vstack([coefficients[:, :, 0], (coefficients[-1] * h[-1] ** powers).sum(axis=1)])
    chord = np.hypot(*np.diff(nodes, axis=0).T)
    way = np.append(0.0, np.cumsum(chord))
    gone = (way[piece, None] + chord[piece, None] * shares).reshape(-1, 1)
    last = count - closed
    stride = max(count // LOOKS, 1)
    row = np.arange(len(place))

    def elsewhere(node: np.ndarray) -> np.ndarray:
        """Return True if nodes (n, k) belong to another part: the arc to them is far longer than the chord."""
        along = np.abs(way[node] - gone)
        along = np.minimum(along, way[-1] - along) if closed else along
        return along > ROUNDABOUT * np.hypot(*np.moveaxis(nodes[node] - on, -1, 0))

    def squares(node: np.ndarray) -> np.ndarray:
        """Return (n, k) squared distances of places and nodes, infinite if there is none; less elsewhere."""
        inside = (node >= 0) & (node <= last)
        node = np.where(inside, node, 0)
        square = ((nodes[node] - place) ** 2).sum(axis=2)
        return np.where(inside, np.where(elsewhere(node), CLOSER * square, square), np.inf)

    coarse = np.arange(0, count, stride)[None].repeat(len(place), axis=0)
    best = coarse[row, squares(coarse).argmin(axis=1)][:, None]
    looked = best + np.arange(1 - stride, stride)
    looked[looked >= count] = -1
    if not closed:
        looked = np.hstack([looked, np.full_like(best, count)])
    best = looked[row, squares(looked).argmin(axis=1)][:, None]
    return bool(elsewhere(best).any())


def disc_numbers(params: Mapping[str, Any], follows: bool) -> list[np.ndarray]:
    """Return numbers of constraints `curve` and `curve_rolling` of a disc: points, closed, radius.

    These are entries of ``params``.

    ``follows``: it never leaves its branch of a curve that crosses itself; a contact is with the nearest branch.
    """
    closed, radius = params["closed"], params["radius"]
    pieces = curve_pieces(np.array(params["points"], float), closed)
    farthest = farthest_step(*pieces, closed, radius) if follows else 0.0
    numbers = curve_numbers(*pieces, closed, radius, radius, farthest)
    return [numbers, numbers]


def crossings(
    breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float, continued: bool = False
) -> np.ndarray:
    """Return (c, 2) parameters at which the curve parallel at ``distance`` (m, left) crosses itself.

    They are rough.

    ``continued``: an open curve with its straight continuations, which have parameters beyond its own. They cross it
    after the crossings of the curve alone in this list, and each other at its end.
    """
    u, place, slope = _chords(breaks, coefficients, closed, distance)
    a, b = (place, np.roll(place, -1, axis=0)) if closed else (place[:-1], place[1:])
    n = len(a)
    blocks = []
    for start in range(0, n - 2, BLOCK):
        k, others = np.arange(start, min(start + BLOCK, n - 2)), np.arange(start + 2, n)
        p, q, r, s = a[k, None], b[k, None], a[others], b[others]
        r_side, s_side, p_side, q_side = _side(p, q, r), _side(p, q, s), _side(r, s, p), _side(r, s, q)
        hit = (r_side * s_side <= 0) & (p_side * q_side <= 0) & ((r_side != 0) | (s_side != 0))
        hit &= others >= k[:, None] + 2
        if closed:
            hit &= (k[:, None] > 0) | (others < n - 1)
        which, other = np.nonzero(hit)
        blocks.append(np.stack([u[k[which]], u[others[other]]], axis=1))
    if continued and not closed:
        blocks += _continued_crossings(u, place, slope)
    return np.concatenate([np.zeros((0, 2)), *blocks])


def _chords(
    breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return parameters (n,), places and slopes (n, 2) of the ends of chords.

    An open curve's last end is the last one.
    """
    fine = max(1, min(FINE, MOST_CHORDS // len(coefficients)))
    s = (np.diff(breaks)[:, None] * np.arange(fine) / fine)[..., None]
    u = (breaks[:-1, None] + s[..., 0]).ravel()
    powers = np.arange(6)
    place = np.einsum("pdk,psk->psd", coefficients, s**powers).reshape(-1, 2)
    slope = np.einsum("pdk,psk->psd", coefficients[:, :, 1:] * powers[1:], s ** powers[:-1]).reshape(-1, 2)
    if not closed:
        h = breaks[-1] - breaks[-2]
        u = np.append(u, breaks[-1])
        place = np.vstack([place, coefficients[-1] @ h**powers])
        slope = np.vstack([slope, (coefficients[-1, :, 1:] * powers[1:]) @ h ** powers[:-1]])
    return u, place + distance * np.stack([-slope[:, 1], slope[:, 0]], axis=1) / np.hypot(*slope.T)[:, None], slope


def _side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
    return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0])


def _continued_crossings(u: np.ndarray, place: np.ndarray, slope: np.ndarray) -> list[np.ndarray]:
    """Where the straight lines beyond both ends cross the chords between ``place`` (n, 2), and each other."""
    out: list[np.ndarray] = []
    for end, way, own in ((0, -slope[0], 0), (-1, slope[-1], len(u) - 2)):
        to = place - place[end]
        off, ahead = way[0] * to[:, 1] - way[1] * to[:, 0], to @ way / (way @ way)
        for k in np.flatnonzero((off[:-1] * off[1:] <= 0) & (off[:-1] != off[1:])):
            part = off[k] / (off[k] - off[k + 1])
            beyond = ahead[k] + part * (ahead[k + 1] - ahead[k])
            if k != own and beyond > 0.0:
                out.append(np.array([[u[k], u[end] + (beyond if end else -beyond)]]))
    begins, ends = -slope[0], slope[-1]
    turned = begins[0] * ends[1] - begins[1] * ends[0]
    if abs(turned) > PARALLEL * np.hypot(*begins) * np.hypot(*ends):
        gap = place[-1] - place[0]
        first = (gap[0] * ends[1] - gap[1] * ends[0]) / turned
        last = (gap[0] * begins[1] - gap[1] * begins[0]) / turned
        if first > 0.0 and last > 0.0:
            out.append(np.array([[u[0] - first, u[-1] + last]]))
    return out


def farthest_step(breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float) -> float:
    """Return how far the foot may go at once (m): part of a self-crossing curve's shortest loop, else 0.

    The straight continuations of an open curve count as parts of it.
    """
    key = breaks.tobytes(), coefficients.tobytes(), closed, distance
    return _FARTHEST.get(key, lambda: _farthest_step(breaks, coefficients, closed, distance))


_FARTHEST: Kept[float] = Kept()


def _farthest_step(breaks: np.ndarray, coefficients: np.ndarray, closed: bool, distance: float) -> float:
    crossed = crossings(breaks, coefficients, closed, distance, continued=True)
    if not len(crossed):
        return 0.0
    around = np.abs(crossed[:, 1] - crossed[:, 0])
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
    returns = bool(np.hypot(*(array[0] - array[-1])) <= SAME * np.hypot(*np.diff(array, axis=0).T).max())
    if returns and len(array) > 2 and not closed:
        raise ModelError(
            f"{what}: the last of {len(array)} points repeats the first, ({array[0, 0]:.6g}, {array[0, 1]:.6g}) m, but "
            "closed is not True: there the curve would not go round but on straight. Give closed=True, or leave the "
            "last point out if the curve is to be open"
        )
    if returns and closed:
        array = array[:-1]
    steps = np.hypot(*np.diff(np.vstack([array, array[:1]]) if closed else array, axis=0).T)
    if not steps.min() > SAME * steps.max():
        raise ModelError(f"{what}: points {int(np.argmin(steps))} and the next are the same; remove one")
    if not math.isfinite(float(steps.sum())):
        raise ModelError(f"{what}: the points are too far apart")
    return array.tolist()


def check_crossing(what: str, points: list[list[float]], closed: bool) -> None:
    """Raise ModelError for a curve that crosses itself or its continuation: no side of it is free."""
    pieces = curve_pieces(np.array(points), closed)
    places = crossings(*pieces, closed, 0.0, continued=True)
    inside = (places >= pieces[0][0]) & (places <= pieces[0][-1])
    places, both = places[inside[:, 0]], inside[inside[:, 0], 1]  # continuations that cross make a roof or a valley
    if len(places):
        k = min(int(np.searchsorted(pieces[0], places[0, 0], "right")) - 1, len(pieces[1]) - 1)
        x, y = pieces[1][k, :, 0]
        crossed = "itself" if both[0] else "the straight line on which it goes on beyond its end"
        raise ModelError(
            f"{what}: the curve crosses {crossed} near ({x:.4g}, {y:.4g}) m, where it has no side that is free; "
            + ("cut it into curves that do not" if both[0] else "turn its end another way by some points more")
            + ", or take rolling_on_curve or point_on_curve, which follow it through"
        )


def check_curvature(what: str, points: list[list[float]], closed: bool, radius: float) -> None:
    """Raise ModelError if a curve bends to the left too tightly for a disc of ``radius`` (m).

    The disc would touch twice.
    """
    tightest = float(curvature(*curve_pieces(np.array(points), closed)).max())
    if tightest * radius >= 1.0:
        raise ModelError(
            f"{what}: the curve is bent to a radius of {1 / tightest:.4g} m, where a disc of {radius:.4g} m "
            "touches twice; use a smaller disc or a smoother curve"
        )
