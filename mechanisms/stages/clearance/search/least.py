"""The least gap of two pieces over a motion, with its proof: of their outlines if these suffice, else in space."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mechanisms.stages.clearance.pieces import height_between
from mechanisms.stages.clearance.search.facing import never_over
from mechanisms.stages.clearance.search.outline_search import least_by_outlines, proven_by_outlines
from mechanisms.stages.clearance.search.search import RESOLUTION, Least, Search
from mechanisms.stages.clearance.search.sweep import Sweep
from mechanisms.stages.clearance.tree import Tree

FIRST = 5
"""Poses at which the whole pieces are compared before the search."""


def least_gap(sweep: Sweep, reach: float) -> Least:
    """The least gap over the motion, ``reach`` (mm) if it is larger; an overlap ends the search.

    Where the search in space is given up, what the outlines prove holds still.
    """
    starts = np.linspace(sweep.times[0], sweep.times[-1], FIRST)
    gaps = {float(time): sweep.gap_at(float(time), reach) for time in starts}
    best = min(gaps, key=gaps.__getitem__)
    if gaps[best] <= 0:
        return Least(0.0, best, 0.0, len(gaps))
    outlined = least_by_outlines(sweep, gaps[best], best, len(gaps))
    if outlined is not None:
        return outlined
    least = _search(sweep, sweep.still.sides, sweep.mover.sides, gaps[best], best, len(gaps))
    height = height_between(sweep.still, sweep.mover)
    if height >= least.gap - RESOLUTION:
        least = replace(least, proven=min(least.proven, height))
    elif least.gap > 0 and never_over(sweep, least.gap):
        pass  # the sides suffice
    elif not least.given_up:
        least = _search(sweep, sweep.still.tree, sweep.mover.tree, least.gap, least.time, least.poses)
    else:  # more facets would be given up, too
        least = replace(least, proven=0.0)
    if least.given_up and least.gap > 0:
        return replace(least, proven=max(least.proven, proven_by_outlines(sweep, least.gap, least.time)))
    return least


def _search(sweep: Sweep, still: Tree, mover: Tree, gap: float, time: float, poses: int) -> Least:
    return Search(still, mover, sweep.path, sweep.still.centre).run(gap, time, poses)
