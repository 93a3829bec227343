"""Mass, centre of mass and inertia in the plane, moved and put together (Steiner)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class MassProperties:
    """Mass properties of a rigid body in the plane: mass (kg), centre of mass (m), inertia about it (kg m^2)."""

    mass: float
    com: tuple[float, float]
    inertia: float

    def placed(self, x: float, y: float, angle: float = 0.0) -> MassProperties:
        """The same body turned by ``angle`` (rad) about the origin and moved by (x, y) (m)."""
        c, s = math.cos(angle), math.sin(angle)
        u, v = self.com
        return MassProperties(self.mass, (x + c * u - s * v, y + s * u + c * v), self.inertia)

    def times(self, count: float) -> MassProperties:
        """So many of them side by side, across the plane; half of what is the same on either side."""
        return MassProperties(count * self.mass, self.com, count * self.inertia)


def combined(parts: Iterable[MassProperties]) -> MassProperties:
    """One rigid body of several."""
    pieces = list(parts)
    mass = sum(piece.mass for piece in pieces)
    x = sum(piece.mass * piece.com[0] for piece in pieces) / mass
    y = sum(piece.mass * piece.com[1] for piece in pieces) / mass
    inertia = sum(piece.inertia + piece.mass * math.dist(piece.com, (x, y)) ** 2 for piece in pieces)
    return MassProperties(mass, (x, y), inertia)
