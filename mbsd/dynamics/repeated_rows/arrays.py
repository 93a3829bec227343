"""Rows of joints and drivers, some of which repeat others, as arrays of the compiled loop; empty where none does."""

from __future__ import annotations

from typing import Any, NamedTuple

ROW, BLOCK, SIDE = range(3)
"""Columns of Repeated.place: the row in J, its block and its place there in Schur.rows."""
HELD, OPENED, SCALE, UNTIL = range(4)
"""Columns of Repeated.number: 1 where it holds, 0 where others do in its place, GONE; whether it did not hold once, so
that it might open; what makes its residual dimensionless; when (s) an event of the user released its joint, infinite
while none has."""
GONE = -1.0
"""Its joint is released."""
STEPS, BETTER, FOLLOWS = range(3)
"""Entries of Repeated.clock: steps so far; by what factor other rows must be better; what part of itself a row adds at
least to others from which it does not follow."""


class Repeated(NamedTuple):
    """k rows: all of joints and drivers, in order; see exchange.py."""

    place: Any
    """(k, 3) int"""
    number: Any
    """(k, 4)"""
    clock: Any
    """(3,)"""
    size: Any
    """(3 nb,) of a unit step of each coordinate; 0 of ground."""
    jac: Any
    """(k, 3 nb) dimensionless."""
    gram: Any
    """(k, k) products of its rows."""
    factor: Any
    """(k, k) Cholesky factor of those of some rows, in their order."""
    whole: Any
    """(k, k) the same of all rows, while some are chosen."""
    left: Any
    """(2, k) squares of what rows chosen before leave of each; a vector."""
    order: Any
    """(2, k) int, rows in the order of a factor."""
