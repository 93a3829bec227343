"""A kind of group, as its file in kinds/ describes it. Joints are named by letters: see LETTERS in plan.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

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
    embedded: Callable[[list[float]], list[float]]
    """Its numbers for columns of B: what the compiled loop would compute anew each time is computed once."""
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
    angles: tuple[tuple[int, int], ...] = ()
    """Constant angles: 0 for that of A or 1 for that of B, and its column."""


def line(x: float, y: float) -> tuple[tuple[float, float], float]:
    """(x, y) over its squared length, so that turning it along a vector of that length is two products; the square."""
    square = x * x + y * y
    return (x / square, y / square), square
