"""Kind of a group, described by its file in kinds/. Joints have letters: see LETTERS in plan.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mbsd.kinematics.groups.links import Link, Places

Bodies = tuple[int, int, int, int]
"""A, B or -1, K1, K2."""
Made = tuple[int, Bodies, int, list[float]]
"""Kind, bodies, law, numbers: a row of Groups."""


@dataclass(frozen=True)
class GroupKind:
    """One kind. Functions that make a group return None where the joints make none after all."""

    code: int
    """Code in groups.py."""
    name: str
    row: Callable[[np.ndarray], list[np.ndarray]]
    """Its row of Groups.row, from its numbers (14, ...): what compiled loops would compute anew each time."""
    one: tuple[str, ...] = ()
    """Letters, sorted, of the joints by which known bodies hold one body, if they make it a group."""
    of_one: Callable[[Places, int, dict[str, Link]], Made | None] | None = None
    """The group of that body, from its links by letter."""
    two: tuple[str, ...] = ()
    """Letters of the joints K1 - A - B - K2, if they make two bodies a group."""
    of_two: Callable[[Places, int, int, Link, Link, Link], Made | None] | None = None
    """The group of A and B: links of A to K1, of A to B, of B to K2."""
    branch: int | None = None
    """Column of the sign of the root, where two poses satisfy the joints."""
    follows: tuple[tuple[int, int, int], ...] = ()
    """Bodies that turn with another: 0 for A or 1 for B, column of the constant angle, column of the other body."""
    watched: int = 0
    """How many of its bodies a motion watches, so that they turn little from pose to pose."""


def line(x: np.ndarray, y: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Return (x, y) over its squared length, and that square.

    Turning it along a vector of that length then takes two products.
    """
    square = x * x + y * y
    return (x / square, y / square), square
