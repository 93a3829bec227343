"""Surfaces of the model as places in the plane: curves through points, and profiles y(x)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from manifold3d import CrossSection, JoinType

if TYPE_CHECKING:
    from mbsd.model.body import Marker
    from mbsd.model.laws.curve import Curve
    from mechanisms.stages.automatic.layout.layout import Layout

STRAY, MOST = 2e-5, 12
ARC = 128
"""Chords of a whole circle round a corner."""
FINE = 240
"""Places of a profile between its ends, at least."""


def curve_path(points: Sequence[Sequence[float]], closed: bool) -> np.ndarray:
    """(n, 2) places (m) of the smooth curve through ``points``, in the axes of its marker: so many that chords stray
    from the curve by STRAY of its size at most, and no more than MOST in each of its polynomials.
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
    """(n, 2) places (m) of a profile y(x) from x = ``first`` to ``last``, its points among them."""
    x = np.union1d(np.linspace(first, last, FINE), profile.x[(profile.x > first) & (profile.x < last)])
    return np.stack([x, profile(x)[:, 0]], axis=1)


def on_body(path: np.ndarray, marker: Marker, layout: Layout) -> np.ndarray:
    """Places (n, 2) in the axes of a marker (m) in those of its body (rmm)."""
    c, s = math.cos(marker.angle), math.sin(marker.angle)
    return layout.sizes.of_metres(1.0) * path @ np.array([[c, s], [-s, c]]) + layout.place(marker)


def farthest(points: Sequence[Sequence[float]]) -> float:
    """How far a curve through points reaches from its marker (m), about."""
    return max(math.hypot(x, y) for x, y in points)


def turns_left(path: np.ndarray) -> bool:
    """Whether a closed path has its inside on its left."""
    return area(path) > 0


def set_back(path: np.ndarray, by: float) -> np.ndarray:
    """A closed path (n, 2) moved to its right by so much (rmm), without the loops that sharp corners would make.

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
