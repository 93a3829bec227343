"""Surfaces of the model as places in the plane: curves through points, profiles y(x), how near discs come to them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd import Marker
    from mbsd.model.laws.curve import Curve
    from mechanisms.stages.automatic.layout.layout import Layout

STRAY, MOST = 2e-5, 12
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


def distances(places: np.ndarray, path: np.ndarray) -> np.ndarray:
    """(T,) from places (T, 2) to the nearest place of a path (n, 2)."""
    start, way = path[:-1], np.diff(path, axis=0)
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    part = np.clip(((places[:, None] - start) * way).sum(axis=2) / square, 0.0, 1.0)
    return np.sqrt(((places[:, None] - start - part[..., None] * way) ** 2).sum(axis=2).min(axis=1))


def simplified(path: np.ndarray, tolerance: float) -> np.ndarray:
    """Those places of a path (n, 2) whose polygon strays from it by ``tolerance`` at most (Ramer, Douglas, Peucker)."""
    kept, waiting = {0, len(path) - 1}, [(0, len(path) - 1)]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        away = distances(path[first + 1 : last], path[[first, last]])
        if away.max() > tolerance:
            middle = first + 1 + int(away.argmax())
            kept.add(middle)
            waiting += [(first, middle), (middle, last)]
    return path[sorted(kept)]
