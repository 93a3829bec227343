"""Records that kernels of a block hand on: its tables, the motion that they fill, and their scratch."""

from __future__ import annotations

from typing import Any, NamedTuple


class Block(NamedTuple):
    """One block of a plan; its tables are those of mbsd/kinematics/groups/blocks.py."""

    head: Any
    """(9,) counts, and where the tables begin."""
    tree: Any
    """(bodies, 5) how each body is joined to another."""
    rows: Any
    """(n, 9) equations."""
    near: Any
    """Known bodies beside."""
    frame: Any
    """(bodies, 7) places of the joints in ``tree``."""
    arms: Any
    """(n, 9) arms of the equations."""
    numbers: Any
    """Numbers of the relative equations."""


class Motion(NamedTuple):
    """All bodies at one time."""

    q: Any
    """(3 nb,) poses, then velocities and accelerations."""
    v: Any
    a: Any
    turn: Any
    """(nb, 2) cosine and sine of the angles."""


class History(NamedTuple):
    """A driven motion, of which one row after the other is filled."""

    times: Any
    """(T,) s"""
    drives: Any
    """(T, motions + 1, 3)"""
    q: Any
    """(T, 3 nb), and so are v and a."""
    v: Any
    a: Any
    turn: Any
    """(nb, 2) of the row that is filled."""
    start: Any
    """(3 nb,) the pose from which angles go on."""
    determinant: Any
    """(T, 1) of the block."""


class Work(NamedTuple):
    """Scratch."""

    unknown: Any
    """(3, 12) unknowns, their rates and accelerations."""
    jac: Any
    """(12, 6) rows of the equations on their two bodies."""
    out: Any
    """(12, 10) equations with their derivatives."""
    solution: Any
    """(2, 12) corrections, order of rows."""
    matrix: Any
    """Factors of G, columns of the unknowns, a relative pose."""
    point: Any
    """(4, 8) points that bodies carry."""
