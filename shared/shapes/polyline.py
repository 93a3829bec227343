"""Polylines in the plane: distances of places from one, and one of fewer places."""

from __future__ import annotations

import numpy as np


def distances(places: np.ndarray, path: np.ndarray) -> np.ndarray:
    """Return distances (T,) from places (T, 2) to the nearest place of a path (n, 2)."""
    start, way = path[:-1], np.diff(path, axis=0)
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    part = np.clip(((places[:, None] - start) * way).sum(axis=2) / square, 0.0, 1.0)
    return np.sqrt(((places[:, None] - start - part[..., None] * way) ** 2).sum(axis=2).min(axis=1))


def simplified(path: np.ndarray, tolerance: float) -> np.ndarray:
    """Return places of a path (n, 2) whose polygon strays from it by ``tolerance`` at most.

    The method is that of Ramer, Douglas and Peucker.
    """
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
