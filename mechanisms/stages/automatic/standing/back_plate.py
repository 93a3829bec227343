"""The base plate of a machine that stands, and the axes in which it is laid out: x right and y up as it stands."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from shared.shapes.solid import placed

if TYPE_CHECKING:
    import cadquery as cq

    from shared.contract import Mount


@dataclass(frozen=True)
class Upright:
    """The turn from the axes of the model to right and up of a mount; of a desk it is none."""

    angle: float = 0.0
    """Angle of ``up`` from y, counter-clockwise (rad)."""

    @classmethod
    def of(cls, mount: Mount) -> Upright:
        """Upright of a mount."""
        x, y, _ = mount.up
        return cls() if mount.kind == "desk" else cls(math.atan2(-x, y) + 0.0)

    def seen(self, places: np.ndarray) -> np.ndarray:
        """Places (..., 2) of the model, as right and up."""
        c, s = math.cos(self.angle), math.sin(self.angle)
        return places if self.angle == 0.0 else places @ np.array([[c, -s], [s, c]])

    def seen_place(self, x: float, y: float) -> tuple[float, float]:
        """One place of the model, as right and up."""
        u, v = self.seen(np.array([x, y]))
        return float(u), float(v)

    def as_seen(self, shape: cq.Workplane) -> cq.Workplane:
        """A shape of the model in these axes."""
        return placed(shape, turn=-math.degrees(self.angle)) if self.angle else shape

    def in_model(self, shape: cq.Workplane) -> cq.Workplane:
        """A shape in these axes as the model has it."""
        return placed(shape, turn=math.degrees(self.angle)) if self.angle else shape


@dataclass(frozen=True)
class BackPlate:
    """A plate (mm, right and up of the mount) that carries what stands on ground.

    ``unit`` is the size of its millimetre of reference, to which thicknesses and screws go.
    """

    corners: tuple[float, float, float, float]
    top: float
    """z of its face."""
    thickness: float
    unit: float
    seat: float
    """Gap between pieces that are screwed together."""
    holes: tuple[tuple[float, float, float], ...] = ()
    """x, y and radius of blind holes in its face, which its screws keep clear of."""
    hull: tuple[tuple[float, float], ...] = ()
    """Counter-clockwise centres of the round corners of a plate that is no rectangle; of others none."""
    corner: float = 0.0
    """Radius of these corners."""

    def scaled(self, scale: float) -> BackPlate:
        """With all lengths times ``scale``."""
        x0, y0, x1, y1 = (scale * value for value in self.corners)
        holes = tuple((scale * x, scale * y, scale * radius) for x, y, radius in self.holes)
        hull = tuple((scale * x, scale * y) for x, y in self.hull)
        top, thickness, unit, seat = (scale * length for length in (self.top, self.thickness, self.unit, self.seat))
        return BackPlate((x0, y0, x1, y1), top, thickness, unit, seat, holes, hull, scale * self.corner)

    def inside(self, x: float, y: float) -> float:
        """How far a place is from the rim; below 0 outside."""
        x0, y0, x1, y1 = self.corners
        border = self.hull or ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        return self.corner + min(
            ((c - a) * (y - b) - (d - b) * (x - a)) / math.hypot(c - a, d - b)
            for (a, b), (c, d) in pairwise((*border, border[0]))
        )

    @property
    def width(self) -> float:
        """To the right."""
        return self.corners[2] - self.corners[0]

    @property
    def height(self) -> float:
        """Upwards."""
        return self.corners[3] - self.corners[1]

    @property
    def back(self) -> float:
        """z of its rear face."""
        return self.top - self.thickness
