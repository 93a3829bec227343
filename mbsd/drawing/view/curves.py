"""Polylines sampled as the curves that they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def resampled(shapes: Sequence[np.ndarray], closed: bool) -> list[np.ndarray]:
    """Polylines (k, 2) with one number of corners; as they are where they have that already.

    What is not drawn, (0, 2), becomes the one place where it was before, or will be.
    """
    counts = {len(shape) for shape in shapes if len(shape)}
    if len(counts) == 1 and all(len(shape) for shape in shapes):
        return list(shapes)
    most = max(counts, default=1)
    out: list[np.ndarray] = []
    last = next((shape[0] for shape in shapes if len(shape)), np.zeros(2))
    for shape in shapes:
        out.append(_sampled(shape, most, closed) if len(shape) else np.tile(last, (most, 1)))
        last = out[-1][0]
    return out


def _sampled(shape: np.ndarray, count: int, closed: bool) -> np.ndarray:
    """``count`` places evenly along a polyline; an outline begins at its rightmost corner."""
    if closed:
        first = int(shape[:, 0].argmax())
        shape = np.vstack([shape[first:], shape[: first + 1]])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(shape, axis=0).T))])
    along = np.linspace(0.0, way[-1], count + 1)[:-1] if closed else np.linspace(0.0, way[-1], count)
    return np.stack([np.interp(along, way, shape[:, k]) for k in range(2)], axis=1)
