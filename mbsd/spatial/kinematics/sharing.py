"""Multipliers of least norm, where joints repeat each other and share a load in many ways.

    J^T lam = Q - M a,   J = Q R   =>   lam = Q R^-T (Q - M a)

Rows of J are dimensionless: a force counts as its moment at one size of the mechanism, whatever the unit of length.
"""

from __future__ import annotations

import numpy as np

from mbsd.equations.laws import Laws
from mbsd.spatial.arrays.along import loads_along, tabulated
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.kinematics.newton import DrivenMotion

JACOBIAN_NUMBERS = 2_000_000
"""Numbers of Jacobians held at once."""


def least_norm(packed: Packed, laws: Laws, motion: DrivenMotion) -> np.ndarray:
    """Return multipliers (T, m) of least norm along a motion."""
    drives, q, v, turns = motion.drives, motion.q, motion.v, motion.turn
    count, rows = len(q), len(packed.row_joint)
    loads, lam = loads_along(packed, laws, motion)
    each = max(1, JACOBIAN_NUMBERS // (rows * packed.freedoms))
    for first in range(0, count, each):
        part = slice(first, first + each)
        _, jac, _ = tabulated(packed, drives[part], q[part], v[part], turns[part])
        orthogonal, upper = np.linalg.qr(jac * packed.row_scale[:, None])
        side = np.linalg.solve(np.swapaxes(upper, 1, 2), loads[part, 3:, None])
        lam[part, :rows] = (orthogonal @ side)[..., 0] * packed.row_scale
    return lam
