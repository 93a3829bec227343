"""Where the numbers of blocks stand in the arrays that kernels read (arrays.py)."""

from __future__ import annotations

(
    HEADS,
    KEPT_SIZE,
    Q,
    KEPT_Q,
    UNKNOWN_AT,
    DETERMINANT_AT,
    SEEN_AT,
    V,
    A,
    TURN_AT,
    UNKNOWN_WORK,
    JAC,
    OUT,
    SOLUTION,
    POINT,
    SCRATCH,
    WORK,
) = range(17)
"""Entries of ``block``: where its heads begin, and places in the scratch. What the last accepted pose leaves is
``KEPT_SIZE`` numbers from ``KEPT_Q`` on, a copy of those from ``Q`` on: poses q (3 nb,), then for each unknown its
value, convective acceleration and columns of B, then the determinant of each block. From ``SEEN_AT`` on stand the
coordinates and the time at which each block was evaluated last."""
HEAD = 9
"""Length of a head."""
BODIES, EQUATIONS, NEAR, TREE, ROWS, NEAR_AT, FRAME, ARMS, FIRST = range(9)
"""Entries of a head: bodies, equations, known bodies beside; where its lines begin in ``block`` and, of FRAME and ARMS,
in ``block_number``; its first unknown."""
TREE_WIDTH, ROWS_WIDTH, FRAME_WIDTH, ARMS_WIDTH = 5, 9, 7, 9
