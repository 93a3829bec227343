"""A band of even width round a smooth curve, with round ends: the outline of a curved slot (mm)."""

from __future__ import annotations

import math

import cadquery as cq
import numpy as np


def band(path: np.ndarray, half: float) -> cq.Wire:
    """Return all points within ``half`` of a smooth open curve.

    The curve goes through ``path`` (n, 2), n > 2, at even steps.

    Raises ValueError if the curve bends so sharply that the band meets itself.
    """
    normal = normals(path)
    left, right = path + half * normal, path - half * normal
    for side in (left, right):
        if ((np.diff(side, axis=0) * np.diff(path, axis=0)).sum(axis=1) <= 0).any():
            raise ValueError(f"a band {2 * half:.3g} mm wide does not follow a curve that bends as sharply")
    ends = []
    for at, way in ((-1, 1.0), (0, -1.0)):
        along = np.array([normal[at, 1], -normal[at, 0]])
        ends.append(path[at] + way * half * along)
    sides = [cq.Edge.makeSpline([_vector(p) for p in side]) for side in (right, left[::-1])]
    caps = [
        cq.Edge.makeThreePointArc(_vector(right[-1]), _vector(ends[0]), _vector(left[-1])),
        cq.Edge.makeThreePointArc(_vector(left[0]), _vector(ends[1]), _vector(right[0])),
    ]
    return cq.Wire.assembleEdges([sides[0], caps[0], sides[1], caps[1]])


def loop(path: np.ndarray, beyond: float) -> cq.Wire:
    """Return the closed curve at a distance outside of a smooth closed curve.

    That one goes through ``path`` (n, 2), whose last place is its first; a negative distance is inside. Raises
    ValueError if the curve bends too sharply for that.
    """
    area = float((path[:-1, 0] * path[1:, 1] - path[1:, 0] * path[:-1, 1]).sum())
    around = np.vstack([path[-2], path, path[1]])
    outward = -math.copysign(1.0, area) * normals(around)[1:-1]
    moved = path + beyond * outward
    if ((np.diff(moved, axis=0) * np.diff(path, axis=0)).sum(axis=1) <= 0).any():
        raise ValueError(f"a groove does not follow a curve at {abs(beyond):.3g} mm that bends as sharply")
    edge = cq.Edge.makeSpline([_vector(p) for p in moved[:-1]], periodic=True)
    return cq.Wire.assembleEdges([edge])


def normals(path: np.ndarray) -> np.ndarray:
    """Return unit vectors (n, 2) to the left of a curve through ``path``."""
    way = np.gradient(path, axis=0, edge_order=2)
    way /= np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-12)
    return np.stack([-way[:, 1], way[:, 0]], axis=1)


def sharpest(path: np.ndarray) -> float:
    """Return the least radius of curvature of a curve through ``path``; infinite if it is straight.

    The path has even steps.
    """
    first, second = np.gradient(path, axis=0, edge_order=2), np.gradient(np.gradient(path, axis=0), axis=0)
    bend = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])[2:-2].max(initial=0.0)
    speed = float(np.linalg.norm(first, axis=1).max())
    return speed**3 / float(bend) if bend > 1e-12 else math.inf


def _vector(point: np.ndarray) -> cq.Vector:
    return cq.Vector(float(point[0]), float(point[1]), 0.0)
