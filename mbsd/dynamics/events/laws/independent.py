"""Which of the rows of closed contacts hold independently of each other and of all joints.

A box on three points of a line, or with both feet sticking, has more contact rows than freedoms that they take. The
others hold without them; their forces are counted as zero.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.dynamics.events.bounds import DEPENDENT
from mbsd.dynamics.events.laws.compliance import Compliance


def independent(at: Compliance, rows: Sequence[int]) -> list[int]:
    """Rows kept, earlier ones first: Cholesky of G = J K^-1 J^T, row by row."""
    directions = at.generalised(rows)
    g = directions.T @ at.answer(directions)
    kept: list[int] = []
    for k in range(len(rows)):
        left = g[k, k]
        if kept:
            left -= g[k, kept] @ np.linalg.solve(g[np.ix_(kept, kept)], g[kept, k])
        if left > DEPENDENT * g[k, k] and g[k, k] > 0.0:
            kept.append(k)
    return [rows[k] for k in kept]
