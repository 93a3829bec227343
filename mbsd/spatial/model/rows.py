"""Rows: the scalar equations of which joints, couplings and drivers are composed.

A row is a weighted sum of terms that has a constant value, or that of a law of time. Between markers i and j, with
axes x, y, z of each, arms s, and d from the place of i to that of j:

    point      d                              three rows in one, in axes of the world
    dot        a . b                          an axis a of i and an axis b of j
    along      a . d                          an axis a of i
    distance   |d|
    roll       (height, 0, 0)                 three rows in one: a ball or disc of j on the plane x, y of i
    turn       atan2(y_i . x_j, x_i . x_j)    of j against i about the z axis of i, with its whole turns

mbsd/spatial/equations evaluates them, with J and gamma.
"""

from __future__ import annotations

from dataclasses import dataclass

from mbsd.spatial.model.body import Marker

TERMS = ("point", "dot", "along", "distance", "turn", "roll")
AXES = "xyz"


@dataclass(frozen=True)
class Term:
    """A measure of two markers, ``weight`` times."""

    kind: str
    """One of :data:`TERMS`."""
    i: Marker
    j: Marker
    first: str = ""
    """Axis of marker i, of dot and along."""
    second: str = ""
    """Axis of marker j, of dot."""
    weight: float = 1.0
    round: tuple[float, float] = (0.0, 0.0)
    """Radii of ring and tube (m), of roll."""


@dataclass(frozen=True)
class Row:
    """A sum of terms that equals ``value``; a driver's equals its law."""

    terms: tuple[Term, ...]
    unit: str
    """Unit of the residual: m or rad."""
    value: float = 0.0

    @property
    def count(self) -> int:
        """Rows of J."""
        return 3 if self.terms and self.terms[0].kind in ("point", "roll") else 1


def point(i: Marker, j: Marker) -> Row:
    """Return the row, three in J, that keeps the places of both markers together."""
    return Row((Term("point", i, j),), "m")


def dot(i: Marker, first: str, j: Marker, second: str, value: float = 0.0) -> Row:
    """Return the row that keeps an axis of i and one of j at an angle, by its cosine."""
    return Row((Term("dot", i, j, first, second),), "rad", value)


def along(i: Marker, axis: str, j: Marker, value: float = 0.0) -> Row:
    """Return the row that keeps the place of j along an axis of i (m)."""
    return Row((Term("along", i, j, axis),), "m", value)


def distance(i: Marker, j: Marker, length: float = 0.0) -> Row:
    """Return the row that keeps the places of both markers ``length`` apart (m)."""
    return Row((Term("distance", i, j),), "m", length)


def turn(i: Marker, j: Marker) -> Row:
    """Return the row that keeps the turn of j against i about the z axis of i (rad)."""
    return Row((Term("turn", i, j),), "rad")


def roll(i: Marker, j: Marker, ring: float, tube: float) -> Row:
    """Return the row, three in J, by which a ball, disc or ring of j rolls on the plane of i."""
    return Row((Term("roll", i, j, round=(ring, tube)),), "m")


def parallel_axes(i: Marker, j: Marker) -> list[Row]:
    """Return the two rows that keep the z axes of both markers parallel."""
    return [dot(i, "x", j, "z"), dot(i, "y", j, "z")]


def same_directions(i: Marker, j: Marker) -> list[Row]:
    """Return the three rows that keep j from turning against i."""
    return [*parallel_axes(i, j), dot(i, "x", j, "y")]
