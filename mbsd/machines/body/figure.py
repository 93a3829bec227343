"""A figure of a given height and mass: lengths between its joints, mass properties of its limbs.

Both sides move alike, so that each limb is that of the left and the right side together. Frames: a limb's origin is its
proximal joint and its x axis leads to the distal one; y is a quarter turn counter-clockwise from there. A figure that
faces right has its back where y of its trunk is positive. The foot's frame stands in the ankle, its x axis points
forward.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass

from mbsd.base.arguments import positive_number
from mbsd.base.errors import ModelError
from mbsd.machines.body.segments import BALL, HEEL, LENGTHS, WINTER, Segment, SegmentTable

GRIP = 0.5
"""Assumed: what is held lies half a hand beyond the wrist."""


@dataclass(frozen=True)
class Figure:
    """A person: height (m), mass (kg) and the table of segments.

    Raises ModelError for an invalid height or mass.
    """

    height: float = 1.78
    mass: float = 80.0
    table: SegmentTable = WINTER

    def __post_init__(self) -> None:
        for name, unit in (("height", "m"), ("mass", "kg")):
            positive_number(f"figure: {name}", getattr(self, name), unit)
        if not isinstance(self.table, SegmentTable):
            raise ModelError(f"figure: the table is a {type(self.table).__name__}; give WINTER or another SegmentTable")

    def length(self, limb: str) -> float:
        """Return a limb's length between its joints (m), by LENGTHS of segments.py.

        Raises ModelError if unknown.
        """
        if limb not in LENGTHS:
            raise ModelError(f"figure: there is no length '{limb}'; known: {', '.join(LENGTHS)}")
        return LENGTHS[limb] * self.height

    @property
    def arm(self) -> float:
        """From the shoulder to what a straight arm holds (m)."""
        return self.length("upper_arm") + self.reach

    @property
    def reach(self) -> float:
        """From the elbow to what the hand holds (m)."""
        return self.length("forearm") + GRIP * self.length("hand")

    @property
    def heel(self) -> float:
        """Place of the heel from the ankle along the floor (m): negative, since it is behind."""
        return -HEEL * self.length("foot")

    @property
    def toe(self) -> float:
        """Place of the tip of the toes from the ankle along the floor (m)."""
        return (1.0 - HEEL) * self.length("foot")

    @property
    def mid_foot(self) -> float:
        """Place of the middle of the foot from the ankle along the floor (m)."""
        return (self.heel + self.toe) / 2

    def limb(self, name: str) -> MassProperties:
        """Return shank, thigh, upper arm or forearm of both sides, or trunk with head, in the limb's frame."""
        segments: tuple[Segment, ...] = getattr(self.table, name)
        whole = combined(self._along(segment) for segment in segments)
        return whole if name == "trunk" else whole.times(2)

    def foot(self) -> MassProperties:
        """Return both feet, flat on the floor, in the frame of the ankle."""
        ankle, foot = self.length("ankle"), self.length("foot")
        if self.table.from_heel:
            start, end = (self.heel, -ankle), (self.toe, -ankle)
        else:
            start, end = (0.0, 0.0), (BALL * foot, -ankle)
        angle = math.atan2(end[1] - start[1], end[0] - start[0])
        return self._along(self.table.foot).placed(*start, angle).times(2)

    def lower_leg(self, ankle: float) -> tuple[float, MassProperties]:
        """Return shank and foot of one side as one rigid body, with an ankle that does not move.

        ``ankle`` is the angle between shank and sole (rad), a right angle where one stands. Returns the length from the
        ball of the foot to the knee (m), and the mass properties in the frame whose origin is the ball and whose x axis
        leads to the knee. Raises ModelError for an angle that is not between 0 and pi.
        """
        if not 0.0 < ankle < math.pi:
            raise ModelError(
                f"figure: the ankle is {math.degrees(ankle):.4g} degrees; the angle between shank and sole must be "
                "between 0 and 180, and is 90 in standing"
            )
        shank = self.length("shank")
        ball = complex(BALL * self.length("foot"), -self.length("ankle"))
        knee = cmath.rect(shank, ankle)  # from the ankle, toes forward and the sole level
        way = knee - ball
        both = combined((self.limb("shank").placed(knee.real, knee.imag, ankle + math.pi), self.foot()))
        whole = both.placed(-ball.real, -ball.imag).placed(0.0, 0.0, -cmath.phase(way))
        return abs(way), whole.times(0.5)

    def arms(self, shoulder: tuple[float, float], hand: tuple[float, float], bend: int = 1) -> MassProperties:
        """Return both arms between two places of one frame (m), as one rigid body.

        ``bend`` is 1 where the elbow is on the left of the way from the shoulder to the hand, -1 where it is on its
        right. Raises ModelError where the hand is out of reach.
        """
        upper, lower = self.arm_angles(shoulder, hand, bend)
        elbow_x = shoulder[0] + self.length("upper_arm") * math.cos(upper)
        elbow_y = shoulder[1] + self.length("upper_arm") * math.sin(upper)
        return combined(
            (
                self.limb("upper_arm").placed(*shoulder, upper),
                self.limb("forearm").placed(elbow_x, elbow_y, lower),
            )
        )

    def arm_angles(
        self, shoulder: tuple[float, float], hand: tuple[float, float], bend: int = 1
    ) -> tuple[float, float]:
        """Return directions (rad) of upper arm and forearm of a hand that holds something; see :meth:`arms`."""
        a, b = self.length("upper_arm"), self.reach
        way = complex(*hand) - complex(*shoulder)
        distance = abs(way)
        if not abs(a - b) <= distance <= a + b:
            raise ModelError(
                f"figure: the hand is {distance:.3g} m from the shoulder, but an arm of {a:.3g} and {b:.3g} m reaches "
                f"from {abs(a - b):.3g} to {a + b:.3g} m; hold it elsewhere"
            )
        direction = math.atan2(way.imag, way.real)
        upper = direction + bend * math.acos((a * a + distance**2 - b * b) / (2 * a * distance))
        elbow = complex(a * math.cos(upper), a * math.sin(upper))
        return upper, math.atan2((way - elbow).imag, (way - elbow).real)

    def _along(self, segment: Segment) -> MassProperties:
        mass = segment.mass / self.table.total * self.mass
        length = segment.length * self.height
        place = segment.start * self.height + segment.com * length
        return MassProperties(mass, (place, 0.0), mass * (segment.gyration * length) ** 2)


@dataclass(frozen=True)
class MassProperties:
    """Mass properties of a plane rigid body: mass (kg), centre of mass (m), inertia about it (kg m^2)."""

    mass: float
    com: tuple[float, float]
    inertia: float

    def placed(self, x: float, y: float, angle: float = 0.0) -> MassProperties:
        """Return the same body turned by ``angle`` (rad) about the origin and moved by (x, y) (m)."""
        c, s = math.cos(angle), math.sin(angle)
        u, v = self.com
        return MassProperties(self.mass, (x + c * u - s * v, y + s * u + c * v), self.inertia)

    def times(self, count: float) -> MassProperties:
        """Return ``count`` of these side by side, across the plane; 0.5 gives one side of two."""
        return MassProperties(count * self.mass, self.com, count * self.inertia)


def combined(parts: Iterable[MassProperties]) -> MassProperties:
    """Return one rigid body of several."""
    pieces = list(parts)
    mass = sum(piece.mass for piece in pieces)
    x = sum(piece.mass * piece.com[0] for piece in pieces) / mass
    y = sum(piece.mass * piece.com[1] for piece in pieces) / mass
    inertia = sum(piece.inertia + piece.mass * math.dist(piece.com, (x, y)) ** 2 for piece in pieces)
    return MassProperties(mass, (x, y), inertia)
