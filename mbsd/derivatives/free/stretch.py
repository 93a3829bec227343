"""A motion between two events, and tangents along it, as arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.derivatives.numbers.terms import Along, Left


@dataclass
class Stretch:
    """T times of a motion between two events, nodes and others, with the rows that hold there."""

    along: Along
    compact: np.ndarray
    """(T, m, 6) J."""
    rows: np.ndarray
    """Independent rows that hold."""
    dependent: list[tuple[int, int]]
    """Rows of sliding and of the gap whose normal force makes their friction."""
    asked: np.ndarray
    """(T,) whether tangents are wanted there."""
    nodes: np.ndarray
    """(T,) whether it is one of the nodes of whole steps, the first and the last among them."""
    solved: bool = True
    """Whether accelerations and multipliers are known; else accelerations are about what they will be."""
    own: Left | None = None
    """How the equations change with P numbers at the held motion, (P, T, ...), where that is known."""


@dataclass
class Tangents:
    """By P numbers: how a motion changes with them at R times. (P, R, 3 nb), (P, R, m)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    lam: np.ndarray

    def parts(self) -> tuple[np.ndarray, ...]:
        """All of it."""
        return self.q, self.v, self.a, self.lam


@dataclass
class Carried:
    """Tangents along some nodes."""

    asked: Tangents
    """Where they were asked for."""
    q: np.ndarray
    """(P, 3 nb) q' at the last node."""
    v: np.ndarray
    lam: np.ndarray
    """(P, m) lam' there."""
    errors: np.ndarray
    """(d, 2) what each step adds, and what it leaves out inside alone, as parts of the largest so far."""
    off: float
    """By how much accelerations were other than about what was known, as part of the largest."""


def joined(parts: list[Tangents]) -> Tangents:
    """One stretch after the other."""
    return Tangents(*(np.concatenate(own, axis=1) for own in zip(*(part.parts() for part in parts), strict=True)))
