"""Groups solved in closed form, as tables: driven bodies and Assur groups of one or two bodies.

A group has bodies A and B (or A alone), which stand on known bodies K1 and K2. What its numbers are stands in its file
in kinds/; arms are from centres of mass, in body axes (m).

Source: Assur 1914; Norton, Design of Machinery, ch. 4, 6, 7 (loop closure of dyads).
"""

from __future__ import annotations

from typing import Any, NamedTuple

DRIVEN, WELDED, RRR, RRP, RPR, YOKE, PRP, ROD, SLIDE = range(9)
"""Kinds; blocks.py has two more."""
NUMBERS = 14
WATCHED = 2
"""Last column of Groups.turning."""
FIRST, SECOND, K1, K2, LAW, COORDINATE, KIND, THIRD = range(8)
"""Columns of Groups.group: bodies A and B, known bodies, law of a driver, coordinate, kind, and the third
known body of a train; -1 or law 0 for none. The first four are those of Groups.body."""


class Groups(NamedTuple):
    """Groups in the order of their solution."""

    kind: Any
    """(g,)"""
    body: Any
    """(g, 4) A, B or -1, K1, K2."""
    motion: Any
    """(g,) law of DRIVEN and SLIDE groups and of actuators, else 0; -k for coordinate k."""
    number: Any
    """(g, 14) columns in kinds/; linear in the places of markers."""
    group: Any
    """(g, 8) the first three in one, for the compiled loops; law 0 where there is none."""
    row: Any
    """(g, 21) ``number`` as the compiled loops need it (tables.py)."""
    angle: Any
    """(g, 2) constant angles (rad) of A and B against the body with which they turn."""
    turning: Any
    """(g, 3) that body for A and B, or -1; how many of them a motion watches."""
