"""The plate of a body with a slot and one or two more places beside it: a T, its corners filled by arcs (rmm).

in its own axes: the slot's middle at (0, 0), the slot along y; the nearer of the other places at (h, e)

             |  |
             |   \\________
             |    ________(o==o)     an arm of half width w, arcs of radius up to FILLET where it meets the wall
             |   /
             |  |
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.assembly.body_shape import EDGES, PlacedEye, first_made
from shared.shapes import outline
from shared.shapes.build import eased, extruded
from shared.shapes.link import with_eyes
from shared.shapes.solid import placed

ARM = 0.64
"""Half of the arm's width in radii of its eye."""
FILLET, END_FILLET = 24.0, 8.0
"""Radii where the arm meets the wall of the slot, and where it meets its eye."""
LONG = 2.4
"""The other places are so many radii of the slot's wall away at least; a nearer one gets a plate without an arm."""


@dataclass(frozen=True)
class _Yoke:
    """Half the slot's travel and the radius of its wall; the other eyes (x, y, radius), the nearest first; rmm."""

    half: float
    wall: float
    others: list[tuple[float, float, float]]

    @property
    def arm(self) -> float:
        """Half of its width."""
        return ARM * self.others[0][2]

    @property
    def has_room(self) -> bool:
        """Whether the arm meets the slot between its ends, and all other places are well away from it."""
        return self.others[0][0] >= LONG * self.wall and abs(self.others[0][1]) + self.arm <= self.half

    def flat(self, thickness: float, edge: float) -> cq.Workplane:
        """Wall of the slot, arm and filled corners, with rounded edges."""
        (h, e, end), w = self.others[0], self.arm
        shape = extruded(outline.hull([(0.0, -self.half, self.wall), (0.0, self.half, self.wall)]), thickness)
        arm = extruded(outline.bar(h, (self.wall, end), (2 * w, 2 * w), END_FILLET), thickness)
        shape = shape.union(placed(arm, 0.0, e))
        if len(self.others) == 2:
            shape = shape.union(extruded(outline.hull(self.others), thickness))
        for side in (1.0, -1.0):
            radius = min(FILLET, self.half - w - side * e, h - self.wall - end - END_FILLET)
            if radius > 0.5:
                shape = shape.union(self._corner(radius, side, thickness))
        return eased(shape.clean(), edge)

    def _corner(self, radius: float, side: float, thickness: float) -> cq.Workplane:
        """What fills the corner of wall and arm above (side 1) or below it (-1), up to an arc."""
        e, w, far = self.others[0][1], self.arm, self.wall + radius
        low, high, inside = e + side * w, e + side * (w + radius), e + side * w / 2  # overlaps the arm
        middle = far - radius * math.sqrt(0.5), high - side * radius * math.sqrt(0.5)
        sketch = cq.Workplane().moveTo(0.0, inside).lineTo(0.0, high).lineTo(self.wall, high)
        sketch = sketch.threePointArc(middle, (far, low)).lineTo(far, inside).close()
        return sketch.extrude(thickness)


def yoke_shape(eyes: list[PlacedEye], ends: list[tuple[float, float]], thickness: float) -> cq.Workplane | None:
    """The plate from z = 0 up, in the body's frame; ``ends`` are the middles of the slot's ends, an eye at each.

    None where other eyes than one or two are beside the slot, or these lie so that a T is no better than a plate.
    """
    walls = [eye for eye in eyes if any(math.dist(eye[:2], end) < 0.01 for end in ends)]
    others = [eye for eye in eyes if eye not in walls]
    if len(walls) != 2 or len(others) not in (1, 2):
        return None
    first, second = np.array(walls[0][:2]), np.array(walls[1][:2])
    middle, along = (first + second) / 2, second - first
    half = float(np.hypot(*along)) / 2
    across = np.array([along[1], -along[0]]) / (2 * half)
    across *= math.copysign(1.0, float((np.array(others[0][:2]) - middle) @ across))
    up = np.array([-across[1], across[0]])
    local = [
        (float(away @ across), float(away @ up), eye) for x, y, eye in others for away in [np.array([x, y]) - middle]
    ]
    local.sort(key=lambda place: place[0])
    wall = min(walls[0][2].radius, walls[1][2].radius)
    yoke = _Yoke(half, wall, [(x, y, eye.radius) for x, y, eye in local])
    if not yoke.has_room:
        return None
    shape = with_eyes(first_made([partial(yoke.flat, thickness, edge) for edge in EDGES]), local, thickness, EDGES[0])
    return placed(shape, float(middle[0]), float(middle[1]), turn=math.degrees(math.atan2(across[1], across[0])))
