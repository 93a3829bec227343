"""Whether two pieces ever lie over each other: faces that look at each other seen from above, over the whole motion.

The way from a horizontal face to the nearest point of another solid is vertical, unless a facet beside it is on that
way too. So where no horizontal face is ever over or under a facet that faces it, within the gap that is sought in
height, the facets that are not horizontal suffice for the least gap.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mechanisms.stages.clearance.pieces import LEVEL, MeshPiece, facing
from mechanisms.stages.clearance.search.outline import edge_of
from mechanisms.stages.clearance.search.outline_search import OutlineSearch, are_over, slack

if TYPE_CHECKING:
    from mechanisms.stages.clearance.search.sweep import Sweep

BESIDE = 0.2
"""Part of the gap: shadows that stay half of this apart in the plane are known not to meet."""


def never_over(sweep: Sweep, gap: float) -> bool:
    """Whether it is proven that no horizontal face of one piece is within ``gap`` (mm) straight over or under a facet
    of the other that faces it, at any time. False proves nothing.
    """
    for sign in (1.0, -1.0):
        under, over = _near(sweep.still, sweep.mover, sign, gap)
        lying, facing_it = _near(sweep.mover, sweep.still, sign, gap)
        if not (_apart(sweep, under, over, gap) and _apart(sweep, facing_it, lying, gap)):
            return False
    return True


def _near(lying: MeshPiece, other: MeshPiece, sign: float, gap: float) -> tuple[np.ndarray, np.ndarray]:
    """Horizontal faces of ``lying`` that look up (``sign`` 1) or down (-1), and the facets of ``other`` that face them;
    of both only those that have the other within ``gap`` in height.
    """
    faces, facets = facing(lying, other, sign)
    low, high = (sign * facets[:, :, 2]).min(axis=1), (sign * facets[:, :, 2]).max(axis=1)
    levels, of = np.unique(faces[:, 0, 2] * sign, return_inverse=True)
    near = (high[None] >= levels[:, None] - LEVEL) & (low[None] < levels[:, None] + gap)
    return faces[near.any(axis=1)[of]], facets[near.any(axis=0)]


def _apart(sweep: Sweep, still: np.ndarray, mover: np.ndarray, gap: float) -> bool:
    if not len(still) or not len(mover):
        return True
    a, b = (edge_of(facets, piece) for facets, piece in ((still, sweep.still), (mover, sweep.mover)))
    if a is None or b is None or are_over(sweep, a, b):
        return False
    search = OutlineSearch(a, b, sweep.path, sweep.still.centre)
    search.resolution = BESIDE / 2 * gap
    return search.run(BESIDE * gap, float(sweep.times[0]), 0).proven > slack(sweep)
