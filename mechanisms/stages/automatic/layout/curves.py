"""Curves and profiles of the model as paths in the plane, and points that follow them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from manifold3d import CrossSection, JoinType
from scipy.interpolate import CubicSpline

from mbsd.model.body import Marker
from mbsd.model.laws.curve import Curve
from mechanisms.stages.automatic.layout.layout import Layout

# Surfaces of the model as places in the plane: curves through points, and profiles y(x).

STRAY, MOST = 2e-5, 12
ARC = 128
"""Chords of a whole circle round a corner."""
FINE = 240
"""Places of a profile between its ends, at least."""


def curve_path(points: Sequence[Sequence[float]], closed: bool) -> np.ndarray:
    """Return (n, 2) places (m) of the smooth curve through ``points``, in the axes of its marker.

    There are so many that chords stray from the curve by STRAY of its size at most, and no more than MOST in each of
    its polynomials.
    """
    from mbsd.model.plane_curves import curve_pieces

    breaks, coefficients = curve_pieces(np.array(points, dtype=float), closed)
    widths = np.diff(breaks)
    bend = np.hypot(*(2.0 * coefficients[:, :, 2]).T)
    size = float(np.ptp(coefficients[:, :, 0], axis=0).max())
    count = math.ceil(math.sqrt(float((bend * widths**2).max()) / (8.0 * STRAY * max(size, 1e-300))))
    parts = np.arange(min(max(count, 1), MOST)) / min(max(count, 1), MOST)
    powers = (widths[:, None] * parts)[:, :, None] ** np.arange(6)  # (pieces, parts, 6)
    path = np.einsum("pkc,pdc->pkd", powers, coefficients).reshape(-1, 2)
    if closed:
        return path
    end = (coefficients[-1] * widths[-1] ** np.arange(6)).sum(axis=1)
    return np.vstack([path, end])


def profile_path(profile: Curve, first: float, last: float) -> np.ndarray:
    """Return (n, 2) places (m) of a profile y(x) from x = ``first`` to ``last``, its points among them."""
    x = np.union1d(np.linspace(first, last, FINE), profile.x[(profile.x > first) & (profile.x < last)])
    return np.stack([x, profile(x)[:, 0]], axis=1)


def on_body(path: np.ndarray, marker: Marker, layout: Layout) -> np.ndarray:
    """Return places (n, 2) in the axes of a marker (m) in those of its body (rmm)."""
    return layout.sizes.of_metres(1.0) * path @ axes_of(marker) + layout.place(marker)


def axes_of(marker: Marker) -> np.ndarray:
    """Return (2, 2) unit vectors along a marker's axes in its body's: a matrix that turns rows."""
    c, s = math.cos(marker.angle), math.sin(marker.angle)
    return np.array([[c, s], [-s, c]])


def farthest(points: Sequence[Sequence[float]]) -> float:
    """Return how far a curve through points reaches from its marker (m), about."""
    return max(math.hypot(x, y) for x, y in points)


def turns_left(path: np.ndarray) -> bool:
    """Return True if a closed path has its inside on its left."""
    return area(path) > 0


def set_back(path: np.ndarray, by: float) -> np.ndarray:
    """Return a closed path (n, 2) moved to its right by so much (rmm), without loops at sharp corners.

    (0, 2) where nothing is left of what it goes round.
    """
    inside = turns_left(path)
    whole = CrossSection([path if inside else path[::-1]])
    moved = whole.offset(by if inside else -by, JoinType.Round, circular_segments=ARC).to_polygons()
    if not moved:
        return np.empty((0, 2))
    largest = max(moved, key=lambda corners: abs(area(corners)))
    return largest if inside else largest[::-1]


def area(path: np.ndarray) -> float:
    """Twice the area within a closed path; above 0 where that is on its left."""
    x, y = path.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


# Open curves go on straight beyond their ends; how far along a curve a point that follows it comes.
#
# The straight continuations begin with the exact tangents of the curve: chords would lead away from the model's lines.

WINDOW = 3.0
"""A point's foot goes on by so many of its own steps at most, and by as many of the curve's."""
BESIDE = 3.0
"""Branches of a curve this near to a point (steps of the curve, more than the nearest one) may be the one it is on."""


def end_ways(points: Sequence[Sequence[float]], marker: Marker) -> np.ndarray:
    """Return (2, 2) unit vectors out of both ends of the open curve through ``points``.

    They are in the axes of the marker's body, the first end's first.
    """
    from mbsd.model import plane_curves

    ways = plane_curves.end_ways(*plane_curves.curve_pieces(np.array(points, dtype=float), False))
    return ways @ axes_of(marker)


def continued(path: np.ndarray, ways: np.ndarray, ahead: float, step: float) -> tuple[np.ndarray, int]:
    """Return a path (n, 2) with straight lines beyond both ends, and how many places lie before it.

    The lines are ``ahead`` long, with places every ``step``. ``ways``: as of :func:`end_ways`.
    """
    count = int(ahead / step) + 2
    along = step * np.arange(1, count + 1)[:, None]
    return np.vstack([path[0] + along[::-1] * ways[0], path, path[-1] + along * ways[1]]), count


def followed(path: np.ndarray, seen: np.ndarray, closed: bool) -> np.ndarray:
    """Return (T,) numbers of the places of a path (n, 2) that a point at ``seen`` (T, 2) is nearest to.

    Only the branch that it follows counts. Round a closed path, whose last place is its first, the numbers go on.

    Where a path crosses itself the nearest place may be one of the other branch.
    """
    step = float(np.hypot(*np.diff(path, axis=0).T).max())
    away = np.hypot(*(path - seen[0]).T)
    near = np.flatnonzero(away < away.min() + BESIDE * step)
    branches = np.split(near, np.flatnonzero(np.diff(near) > 1) + 1)
    starts = [int(block[np.argmin(away[block])]) for block in branches]
    tries = [_followed_from(start, path, seen, closed, step) for start in starts]
    count = len(path) - 1 if closed else len(path)
    off = [float(((path[numbers % count] - seen) ** 2).sum()) for numbers in tries]
    return tries[int(np.argmin(off))]


def evenly(path: np.ndarray, count: int) -> np.ndarray:
    """Return (count, 2) places on the spline through a path, nearly evenly along it.

    Chords would take from the pin's clearance where the curve bends.
    """
    steps = np.hypot(*np.diff(path, axis=0).T)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    apart = np.concatenate([[True], steps > 0.0])
    return CubicSpline(way[apart], path[apart])(np.linspace(0.0, way[-1], count))


def _followed_from(start: int, path: np.ndarray, seen: np.ndarray, closed: bool, step: float) -> np.ndarray:
    count = len(path) - 1 if closed else len(path)
    moves = np.hypot(*np.diff(seen, axis=0, prepend=seen[:1]).T)
    at, indices = start, np.zeros(len(seen), dtype=int)
    for k, (place, move) in enumerate(zip(seen, moves, strict=True)):
        reach = min(int(WINDOW * (move / step + 1.0)), count // 2)
        near = np.arange(at - reach, at + reach + 1)
        near = near if closed else near[(near >= 0) & (near < count)]
        at = int(near[np.argmin(((path[near % count] - place) ** 2).sum(axis=1))])
        indices[k] = at
    return indices
