"""Blocks of bodies that no closed form covers, as tables, solved together by Newton-Raphson.

Each body hangs from a known one or from an earlier one of its block, so that few unknowns are left: the angle of a pin,
the way of a slide, or all three coordinates where there is neither. What else holds the bodies are the equations, all
of them functions F(x, y, a) of the relative pose of two markers (equations/relative/equation.py). A gear wheel in an
eccentric bearing, a cam's follower and a Geneva's wheel are blocks of one unknown.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from mbsd.equations.system import constant

BLOCK, TRAIN = 9, 10
"""Kinds after those of groups.py. TRAIN: a pinned body whose angle is a sum of known angles (kinds/train.py)."""
PIN, SLIDE, WELD, FREE = range(4)
"""Codes of how a body hangs."""
UNKNOWNS = (1, 1, 0, 3)
"""Number of unknowns of each of these."""
ALONG, ACROSS, TURNED, APART, SPECIAL = range(5)
"""Equations: x, y, a or the distance less a constant, or a constraint of relative pose."""
BODIES, EQUATIONS, NEAR, CARRIES, TREE_AT, ROWS_AT, NEAR_AT, LAWS, MOVING = range(9)
"""Columns of ``head``: bodies, equations, known bodies beside; 1 if other groups stand on it; first entries of tree,
rows and near; laws and bodies of the mechanism."""
BODY, PARENT_PLACE, PARENT, HANGS, UNKNOWN = range(5)
"""Columns of ``tree``: place of the parent in the block, -1 if it is known; first unknown."""
EQUATION, BODY_I, BODY_J, PLACE_I, PLACE_J, MOTION, AT, ARM, ADDRESS = range(9)
"""Columns of ``rows``; AT, ARM and ADDRESS as in ``System.special``."""
STRIDE, SIZE = 7, 8
"""Columns of ``arms``: how far the row's law may go in one step, size of the mechanism (m)."""
LARGEST = 12
"""Unknowns of one block; with more the mechanism is solved as a whole, with its sparse factors."""
DOUBTED_BEFORE = 4
"""Beside the states of carried.py: a pose is needed in the step before this one."""


class Blocks(NamedTuple):
    """All blocks of a plan; the group of kind BLOCK has the number of its block as ``motion``."""

    head: Any
    """(blocks, 9)"""
    tree: Any
    """(bodies, 5) in the order in which they are placed."""
    rows: Any
    """(equations, 9)"""
    near: Any
    """Known bodies that blocks hang from or are held by."""
    frame: Any
    """(bodies, 7) joint's point on the parent, axis there, angle against the parent, point on the body."""
    arms: Any
    """(equations, 9) arm and axis of marker i, arm of marker j, constant, stride, size."""
    numbers: Any
    """``System.numbers``."""
    train: Any
    """(trains, 2) first share of each and how many; the group of kind TRAIN has its number as ``motion``."""
    train_body: Any
    """Bodies whose angles count to a train's."""
    share: Any
    """Weights of the equations."""
    unknown: Any
    """(3, 12) scratch: unknowns, their rates and accelerations."""
    jac: Any
    """(12, 6) scratch."""
    out: Any
    """(12, 10) scratch: equations with their derivatives."""
    du: Any
    """(2, 12) scratch: corrections, order of rows."""
    scratch: Any
    """Matrix, columns of unknowns, relative pose."""


@cache
def no_blocks() -> Blocks:
    """Return blocks of a plan of closed forms alone, in which nobody writes scratch."""
    return with_scratch([], [], [], [], [], [], np.zeros(0), [], [], [])


def with_scratch(
    head: Sequence[Sequence[int]],
    tree: Sequence[Sequence[int]],
    rows: Sequence[Sequence[int]],
    near: Sequence[int],
    frame: Sequence[Sequence[float]],
    arms: Sequence[Sequence[float]],
    numbers: np.ndarray,
    train: Sequence[Sequence[int]],
    train_body: Sequence[int],
    share: Sequence[float],
) -> Blocks:
    """Return the fields of the same names as arrays, and the scratch."""
    most = max((row[BODIES] for row in head), default=0)
    return Blocks(
        head=np.array(head, np.int64).reshape(-1, 9),
        tree=np.array(tree, np.int64).reshape(-1, 5),
        rows=np.array(rows, np.int64).reshape(-1, 9),
        near=np.array(near, np.int64),
        frame=np.array(frame, float).reshape(-1, 7),
        arms=np.array(arms, float).reshape(-1, 9),
        numbers=constant(numbers),
        train=np.array(train, np.int64).reshape(-1, 2),
        train_body=np.array(train_body, np.int64),
        share=np.array(share, float),
        unknown=np.zeros((3, LARGEST)),
        jac=np.zeros((LARGEST, 6)),
        out=np.zeros((LARGEST, 10)),
        du=np.zeros((2, LARGEST)),
        scratch=np.zeros(LARGEST * LARGEST + 3 * LARGEST * most + 16),
    )


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
