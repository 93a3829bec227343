"""Residuals of a motion: of Phi, of J v - nu, of J a - gamma, and of the balance of powers."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.equations.laws import Laws
from mbsd.spatial.arrays.along import loads_along, tabulated
from mbsd.spatial.arrays.packing import Packed


def residuals(packed: Packed, laws: Laws, motion: Any) -> tuple[float, float, float, float]:
    """Return the largest |Phi|, |J v - nu|, |J a - gamma| and missing power of a motion (SI)."""
    phi, jac, gamma = tabulated(packed, motion.drives, motion.q, motion.v, motion.turn)
    nu = np.zeros(phi.shape)
    for row, law in packed.system.driven:
        nu[:, row] = motion.drives[:, law, 1]
    speed = np.einsum("trc,tc->tr", jac, motion.v[:, 3:]) - nu
    bend = np.einsum("trc,tc->tr", jac, motion.a[:, 3:]) - gamma
    loads, _ = loads_along(packed, laws, motion)
    power = (loads * motion.v).sum(axis=1) - (motion.lam[:, : nu.shape[1]] * nu).sum(axis=1)
    return (
        float(np.abs(phi).max(initial=0.0)),
        float(np.abs(speed).max(initial=0.0)),
        float(np.abs(bend).max(initial=0.0)),
        float(np.abs(power).max(initial=0.0)),
    )
