"""Cams with any closed outline, and Geneva drives: the slotted wheel and its locking disc."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import cadquery as cq
import numpy as np

from shared.shapes import outline
from shared.shapes.build import bore, eased, extruded
from shared.shapes.kernel import first_sound
from shared.shapes.outline import distances, simplified
from shared.shapes.solid import placed

# Cams: a disc with any closed outline that does not cross itself.


KNOTS = 240
"""Knots of the spline round a smooth disc."""
STRAY = 0.02
"""A spline that strays farther from the outline (mm) is none of it: the disc is a polygon then."""
CHORD = 0.005
"""Largest distance of that polygon from the outline (mm)."""
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


# Geneva: the slotted wheel with its locking arcs, and the locking disc of the crank.
#
# Source of the proportions: Bickford, Mechanisms for Intermittent Motion, 1972, ch. 9. The cut is a circle through the
# two ends of the disc's arc, as shallow as the points that the wheel sweeps allow.


FULLEST = 0.8
"""Radius of the locking disc, of that of the pin's circle, at most."""
EARLY = 3.0
"""The cut begins so many gaps beyond the line of the centres, where the wheel's arc dips into the disc's circle."""


@dataclass(frozen=True)
class Geneva:
    """Sizes (mm): ``distance`` of centres, ``radius`` of the pin's circle, ``slot`` width, ``wall``.

    ``gap`` is between locking disc and wheel.
    """

    slots: int
    distance: float
    radius: float
    slot: float
    wall: float
    gap: float

    @property
    def rim(self) -> float:
        """Radius of the wheel."""
        return self.distance * math.cos(math.pi / self.slots)

    @property
    def lock(self) -> float:
        """Radius of the locking disc."""
        return min(FULLEST * self.radius, self.radius - self.slot / 2 - self.wall - self.gap)

    @property
    def bottom(self) -> float:
        """Radius about the wheel's centre that the slots leave."""
        return self.distance - self.radius - self.slot / 2 - 1.0

    def wheel(self, thickness: float) -> cq.Workplane:
        """Return the wheel about the z axis from z = 0 up, a slot along x; no hole. Its edges are eased."""
        shape = extruded(outline.circle(0, 0, self.rim), thickness)
        slot = outline.hull([(self.bottom + self.slot / 2, 0, self.slot / 2), (2 * self.rim, 0, self.slot / 2)])
        for k in range(self.slots):
            turn = 360.0 * k / self.slots
            arc = extruded(outline.circle(self.distance, 0, self.lock + self.gap), thickness + 2.0, -1.0)
            shape = shape.cut(placed(extruded(slot, thickness + 2.0, -1.0), turn=turn))
            shape = shape.cut(placed(arc, turn=turn + 180.0 / self.slots))
        return shape.faces("|Z").edges().chamfer(0.05 * thickness)

    def locking_disc(self, thickness: float, hole: float) -> cq.Workplane:
        """Return the locking disc about the z axis from z = 0 up, cut away towards x.

        It has one through hole of radius ``hole``.
        """
        centre, radius = self.cut
        shape = extruded(outline.circle(0, 0, self.lock), thickness)
        shape = shape.cut(extruded(outline.circle(centre, 0, radius), thickness + 2.0, -1.0))
        return shape.faces("|Z").edges().chamfer(0.05 * thickness).cut(bore(2 * hole, 0.0, thickness, 0.4))

    @property
    def cut(self) -> tuple[float, float]:
        """Centre on the x axis and radius of the circle that is cut out of the locking disc."""
        half = math.pi / 2 - math.pi / self.slots + EARLY * self.gap / self.lock
        end = self.lock * np.array([math.cos(half), math.sin(half)])
        swept = self._swept()
        near = swept[np.hypot(*swept.T) < self.lock + 0.5 * self.gap]
        centre, radius = float(end[0]), float(end[1])
        for deeper in np.linspace(0.0, 1.0, 201):
            centre = end[0] + self.distance * math.tan((1 - deeper) * 0.49 * math.pi)
            radius = math.hypot(end[0] - centre, end[1])
            if not len(near) or np.hypot(near[:, 0] - centre, near[:, 1]).max() + self.gap <= radius:
                break
        return float(centre), float(radius)

    @property
    def least_hub(self) -> float:
        """Radius about the crank's axis that the cut leaves."""
        centre, radius = self.cut
        return centre - radius

    def _swept(self) -> np.ndarray:
        """Return points (k, 2) that the wheel's edge sweeps in the crank's frame while the pin turns it."""
        pitch, d, arc = 2 * math.pi / self.slots, self.distance, self.lock + self.gap
        edge = math.asin(self.slot / 2 / self.rim)
        angles = np.linspace(edge, pitch - edge, 241)
        off = angles - pitch / 2
        inside = arc**2 - (d * np.sin(off)) ** 2
        cut = d * np.cos(off) - np.sqrt(np.maximum(inside, 0.0))
        reach = np.where((inside > 0) & (cut < self.rim), cut, self.rim)
        points = reach[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        outlines = []
        half, away = math.pi / 2 - pitch / 2, np.array([d, 0.0])
        for turn in np.linspace(-half, half, 361):
            pin = self.radius * np.array([math.cos(turn), math.sin(turn)]) - away
            for k in (-1, 0):
                world = _turned(points, math.atan2(pin[1], pin[0]) + k * pitch) + away
                outlines.append(_turned(world, -turn))
        return np.concatenate(outlines)


def _turned(points: np.ndarray, angle: float) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])
