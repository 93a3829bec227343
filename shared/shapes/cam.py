"""Cams: a disc with any smooth closed outline."""

from __future__ import annotations

import cadquery as cq
import numpy as np

from shared.shapes.build import extruded

KNOTS = 240
"""Of the spline round the disc."""


def cam_disc(outline: np.ndarray, thickness: float, edge: float = 0.4) -> cq.Workplane:
    """The disc within ``outline`` ((n, 2), mm, closed and smooth, either way round) from z = 0 up; no hole."""
    points = evenly(outline, KNOTS)
    area = points[:, 0] @ np.roll(points[:, 1], -1) - points[:, 1] @ np.roll(points[:, 0], -1)
    points = points if area > 0 else points[::-1]
    edges = [cq.Edge.makeSpline([cq.Vector(x, y, 0) for x, y in points], periodic=True)]
    shape = extruded(cq.Wire.assembleEdges(edges), thickness)
    return shape.faces("|Z").edges().chamfer(edge) if edge > 0 else shape


def evenly(outline: np.ndarray, count: int) -> np.ndarray:
    """(count, 2): points of a closed outline (n, 2) at even distances."""
    closed = np.vstack([outline, outline[:1]])
    steps = np.hypot(*np.diff(closed, axis=0).T)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.linspace(0.0, arc[-1], count, endpoint=False)
    return np.stack([np.interp(at, arc, closed[:, 0]), np.interp(at, arc, closed[:, 1])], axis=1)
