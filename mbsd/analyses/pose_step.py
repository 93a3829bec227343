"""How far poses are moved for differences of loads: not farther than surfaces that touch yield, nor into what is free.

A contact of steel yields some micrometres, over which its stiffness is not that of a part of the mechanism's size.
"""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.results.surface import foot_of

PART = 0.03
"""Part of the depth, or of the gap before it closes."""
LEAST = 1e-9
"""Sizes; less is rounding."""


def pose_step(packed: Packed, q: np.ndarray, usual: float) -> float:
    """The step in sizes and rad at the pose q (3 nb,): ``usual``, or less where journals are near their bearings."""
    gaps = [abs(float(foot_of(packed, force, q[None]).gap[0])) for force in packed.forces if force.kind.journal]
    return max(min([usual, *(PART * gap / packed.size for gap in gaps)]), LEAST)
