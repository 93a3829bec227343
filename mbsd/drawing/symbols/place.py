"""Where a joint is drawn, and on which side of its marker there is room."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.carriers import GROUND, Carrier, at_place
from mbsd.drawing.pose import Pose
from mbsd.model.joint import Joint

ROOM = math.radians(55)
"""Between ground's sign and the nearest link."""


@dataclass(frozen=True)
class Place:
    """One joint in one pose."""

    joint: Joint
    pose: Pose
    colours: dict[str, str]
    free_side: np.ndarray
    """Unit direction in which the links at this joint leave most room: where ground's sign goes."""

    @property
    def i(self) -> np.ndarray:
        """(2,) of the first marker (m)."""
        return self.pose.place(self.joint.i)

    @property
    def j(self) -> np.ndarray:
        """(2,) of the second marker (m)."""
        return self.pose.place(self.joint.j)

    @property
    def axis(self) -> np.ndarray:
        """(2,) unit x axis of the first marker."""
        return self.pose.axis(self.joint.i)

    @property
    def grounded(self) -> bool:
        """True if one of the two bodies is ground."""
        return "ground" in self.joint.bodies

    @property
    def carrier(self) -> Carrier:
        """Return the carrier of the second marker: ground too, where the joint holds it there."""
        return GROUND if self.grounded else at_place(self.joint.j)

    @property
    def grounded_end(self) -> np.ndarray:
        """(2,) of the marker on ground (m)."""
        return self.i if self.joint.i.body.name == "ground" else self.j

    def range(self, half: float) -> tuple[np.ndarray, np.ndarray]:
        """Ends of a guide along the axis: the whole travel, at least ``half`` (m) to both sides of marker j."""
        here = float((self.j - self.i) @ self.axis)
        reached = np.append(self.pose.travel.get(self.joint.name, np.zeros(0)), here)
        return self.i + (reached.min() - half) * self.axis, self.i + (reached.max() + half) * self.axis


def free_side(directions: list[float]) -> np.ndarray:
    """Down, else up, left or right: the first with room beside the links that leave at these angles (rad)."""
    best, room = -math.pi / 2, -1.0
    for side in (-math.pi / 2, math.pi / 2, math.pi, 0.0):
        nearest = min((abs((side - d + math.pi) % (2 * math.pi) - math.pi) for d in directions), default=math.pi)
        if room < ROOM and nearest > room + 1e-9:
            best, room = side, nearest
    return np.array([round(math.cos(best)), round(math.sin(best))], float)
