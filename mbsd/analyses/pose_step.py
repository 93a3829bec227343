"""How far poses are moved for differences and searches: not farther than surfaces that touch yield, nor over teeth.

A contact of steel yields some micrometres, over which its stiffness is not that of a part of the mechanism's size.
"""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.results.surface import gaps_of

PART = 0.03
"""Part of the depth, or of the gap before it closes."""
LEAP = 0.2
"""Part of the way from tooth to tooth."""
LEAST = 1e-9
"""Sizes; less is rounding."""


def longest_step(packed: Packed, usual: float) -> float:
    """The longest step of a search (sizes, rad): ``usual``, or less where one could leap over teeth."""
    periods = [force.kind.mesh.period(force.params) for force in packed.forces if force.kind.mesh is not None]
    return min([usual, *(LEAP * period / packed.size for period in periods)])


def pose_step(packed: Packed, q: np.ndarray, usual: float) -> float:
    """The step in sizes and rad at the pose q (3 nb,): ``usual``, or less where journals are near their bearings."""
    gaps = [float(gap) for force in packed.forces for gap in gaps_of(packed, force, q[None])]
    return max(min([usual, *(PART * gap / packed.size for gap in gaps)]), LEAST)
