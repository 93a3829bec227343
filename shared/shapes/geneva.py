"""Geneva: the slotted wheel with its locking arcs, and the locking disc of the crank.

Source of the proportions: Bickford, Mechanisms for Intermittent Motion, 1972, ch. 9. The cut is a circle through the
two ends of the disc's arc, as shallow as the points that the wheel sweeps allow.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import cadquery as cq
import numpy as np

from shared.shapes import outline
from shared.shapes.build import bore, extruded
from shared.shapes.solid import placed

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
