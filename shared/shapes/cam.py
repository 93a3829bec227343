"""Cams: a disc with any closed outline that does not cross itself."""

from __future__ import annotations

from functools import partial

import cadquery as cq
import numpy as np

from shared.shapes.build import eased, extruded
from shared.shapes.kernel import first_sound
from shared.shapes.polyline import distances, simplified

KNOTS = 240
"""Knots of the spline round a smooth disc."""
STRAY = 0.02
"""A spline that strays farther from the outline (mm) is none of it: the disc is a polygon then."""
CHORD = 0.005
"""How far that polygon strays from the outline (mm)."""
SHARP = 2.0
"""Teeth that are rounded more tightly than this (mm) make it a polygon, too: the kernel cannot chamfer such a spline,
and meshes it with ten times the triangles.
"""


def cam_disc(outline: np.ndarray, thickness: float, edge: float = 0.4) -> cq.Workplane:
    """Return the disc within ``outline`` ((n, 2), mm, closed, either way round) from z = 0 up; no hole.

    Its edges have a chamfer ``edge``, or half of that, where the CAD kernel can make one; ratchets and escape wheels
    are sharper than any chamfer and get none.
    """
    points = evenly(outline, KNOTS)
    area = _area(points)
    points = points if area > 0 else points[::-1]
    spline = cq.Edge.makeSpline([cq.Vector(x, y, 0) for x, y in points], periodic=True)
    closed = np.vstack([outline, outline[:1]])
    places = spline.positions(np.linspace(0.0, 1.0, 3 * KNOTS).tolist(), mode="parameter")
    seen = np.array([[v.x, v.y] for v in places])
    if _tightest(points) < SHARP or float(distances(seen, closed).max()) > STRAY:
        return extruded(_polygon(closed if _area(outline) > 0 else closed[::-1]), thickness)
    plain = extruded(cq.Wire.assembleEdges([spline]), thickness)
    if edge <= 0:
        return plain
    return first_sound([partial(eased, plain, size, chamfer=True) for size in (edge, edge / 2)]) or plain


def evenly(outline: np.ndarray, count: int) -> np.ndarray:
    """Return points (count, 2) of a closed outline (n, 2) at even distances."""
    closed = np.vstack([outline, outline[:1]])
    steps = np.hypot(*np.diff(closed, axis=0).T)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    at = np.linspace(0.0, arc[-1], count, endpoint=False)
    return np.stack([np.interp(at, arc, closed[:, 0]), np.interp(at, arc, closed[:, 1])], axis=1)


def _polygon(closed: np.ndarray) -> cq.Wire:
    corners = simplified(closed, CHORD)[:-1]
    return cq.Wire.makePolygon([cq.Vector(float(x), float(y), 0.0) for x, y in corners], close=True)


def _area(points: np.ndarray) -> float:
    """Return twice the signed area: above 0 counter-clockwise."""
    x, y = points.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _tightest(points: np.ndarray) -> float:
    """Return the least radius (mm) of circles through three neighbours where the outline bulges.

    The outline is counter-clockwise.
    """
    a, c = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    u, v, w = points - a, c - points, c - a
    turn = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    lengths = np.hypot(*u.T) * np.hypot(*v.T) * np.hypot(*w.T)
    bulges = turn > 1e-12 * lengths ** (2 / 3)
    return float((lengths[bulges] / (2.0 * turn[bulges])).min()) if bulges.any() else np.inf
