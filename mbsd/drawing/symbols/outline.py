"""Outlines of links: the convex hull of a body's points, grown by a radius, so that its corners are round."""

from __future__ import annotations

import math

import numpy as np

ARC_STEP = math.radians(10)


def hull(points: np.ndarray) -> np.ndarray:
    """(k, 2) corners of the convex hull, counter-clockwise (monotone chain); one or two points stay as they are."""
    unique = sorted({(float(x), float(y)) for x, y in points})
    if len(unique) < 3:
        return np.array(unique)

    def chain(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
        out: list[tuple[float, float]] = []
        for p in ordered:
            while len(out) > 1 and _turn(out[-2], out[-1], p) <= 0:
                out.pop()
            out.append(p)
        return out[:-1]

    return np.array(chain(unique) + chain(unique[::-1]))


def rounded(points: np.ndarray, radius: float) -> np.ndarray:
    """(k, 2) closed outline at ``radius`` around the hull of ``points``: a disc, a stadium, a rounded polygon."""
    corners = hull(points)
    if len(corners) == 1:
        return corners[0] + radius * _arc(0.0, 2 * math.pi)
    edges = np.roll(corners, -1, axis=0) - corners
    outward = np.arctan2(-edges[:, 0], edges[:, 1])  # normals of the edges that leave each corner
    parts = []
    for k, corner in enumerate(corners):
        first = outward[k - 1]
        turn = (outward[k] - first) % (2 * math.pi)
        parts.append(corner + radius * _arc(first, first + turn))
    return np.concatenate(parts)


def _arc(first: float, last: float) -> np.ndarray:
    angles = np.linspace(first, last, max(2, math.ceil((last - first) / ARC_STEP) + 1))
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
