"""Belts and chains round two pulleys: the length of their path, places along it, and their thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Path of a belt or chain round two pulleys: its length, and places along it.
#
# The first pulley's centre is the origin, the second's at (distance, 0). The belt goes counter-clockwise round the
# first, on straight along the common tangent, round the second (clockwise if it is crossed), and back:
#
# open       cos(beta) = (r1 - r2) / d      arcs 2 pi - 2 beta and 2 beta crossed    cos(beta) = (r1 + r2) / d
# arcs 2 pi - 2 beta, both
#
# beta is the angle between the line of centres and the radius to a tangent's end. Lengths in any one unit.


Array = NDArray[np.float64]


@dataclass(frozen=True)
class BeltPath:
    """A belt on pitch radii ``first`` and ``second``, whose centres are ``distance`` apart."""

    first: float
    second: float
    distance: float
    crossed: bool = False

    @property
    def has_room(self) -> bool:
        """True if the pulleys lie so far apart that there are tangents."""
        return abs(self._difference) < self.distance

    @property
    def _difference(self) -> float:
        return self.first + self.second if self.crossed else self.first - self.second

    @property
    def beta(self) -> float:
        """Angle beta of the file's formulas (rad)."""
        return math.acos(self._difference / self.distance)

    @property
    def strand(self) -> float:
        """Length of a straight part."""
        return math.sqrt(self.distance**2 - self._difference**2)

    @property
    def parts(self) -> tuple[float, float, float, float]:
        """Lengths of the arc on the first, the strand to the second, the arc on that, and the strand back."""
        wrap = 2 * math.pi - 2 * self.beta
        return self.first * wrap, self.strand, self.second * (wrap if self.crossed else 2 * self.beta), self.strand

    @property
    def length(self) -> float:
        """Length of the whole belt."""
        return sum(self.parts)

    def places(self, along: Array) -> tuple[Array, Array]:
        """Return (n, 2) places along the belt, and their (n,) positions on its strands.

        ``along`` (n,) are lengths from where the belt meets the first pulley. Positions are 0 .. 1, below zero on the
        strand back, 0 on pulleys.
        """
        s = np.mod(along, self.length)
        off_first, onto_second, off_second, _ = np.cumsum(self.parts)
        beta, sense = self.beta, -1.0 if self.crossed else 1.0
        start = math.pi - beta if self.crossed else -beta
        out, centre = np.empty((len(s), 2)), np.array([self.distance, 0.0])
        rest = np.zeros(len(s))
        on_first, on_second = s < off_first, (s >= onto_second) & (s < off_second)
        out[on_first] = self.first * _ray(beta + s[on_first] / self.first)
        out[on_second] = centre + self.second * _ray(start + sense * (s[on_second] - onto_second) / self.second)
        for begins, inside, ends, sign in (
            (
                off_first,
                (s >= off_first) & (s < onto_second),
                (self.first * _ray(-beta), centre + self.second * _ray(start)),
                1.0,
            ),
            (off_second, s >= off_second, (centre + self.second * _ray(-start), self.first * _ray(beta)), -1.0),
        ):
            part = ((s[inside] - begins) / self.strand)[:, None]
            out[inside] = (1 - part) * ends[0] + part * ends[1]
            rest[inside] = sign * part[:, 0]
        return out, rest

    def on_second(self, along: float) -> float:
        """Return the angle (rad) of a place on the arc of the second pulley, from the line of centres."""
        arc, strand, _, _ = self.parts
        start, sense = (math.pi - self.beta, -1.0) if self.crossed else (-self.beta, 1.0)
        return start + sense * (along - arc - strand) / self.second


def _ray(angle: Array | float) -> Array:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


# Thickness of a belt or chain in the film and in the clearance proof, from its rim's radius.
#
# A round belt carries marks that stand out a little. A chain has rollers on pins between two rows of plates.


LONG, PROUD = 1.6, 1.06
"""Half of a mark's length, and its radius."""
ROLLER, BOLT = 0.9, 0.35
"""Radii of a chain's roller and of its pin."""
PLATES, PIN, PLATE = 1.5, 2.1, 0.42
"""How far a chain's plates lie from the middle, half a pin's length, a plate's radius."""
APART = 1.1
"""How far the strands of a crossed belt pass over and under each other."""


def half_width(radius: float, chain: bool) -> float:
    """Return the extent from the middle line out, in the plane."""
    return radius * (ROLLER if chain else PROUD)


def half_height(radius: float, chain: bool, crossed: bool) -> float:
    """Return the extent from the middle line up."""
    return radius * ((PIN if chain else PROUD) + (APART if crossed else 0.0))
