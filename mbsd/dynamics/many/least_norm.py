"""Multipliers of least norm of joints that repeat others, of many simulations; see dynamics/simulate.py."""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import rows_of_joints
from mbsd.dynamics.many.outputs import Reacting
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.start.large import MANY_COORDINATES

NEGLIGIBLE = 1e-9
"""Singular values of J below this part of the largest are zero."""


def shares(ready: PreparedDynamics) -> bool:
    """Whether joints share loads in many ways, and those of least norm are meant.

    Friction came from those of the rows that held.
    """
    if len(ready.dynamics.loads.friction) or ready.packed.coordinates > MANY_COORDINATES:
        return False
    return bool(ready.mobility.redundant_rows)


def shared(
    packed: list[Packed],
    y: np.ndarray,
    jacobians: np.ndarray,
    lam: np.ndarray,
    times: np.ndarray,
    joints: np.ndarray,
    gone: np.ndarray | None = None,
) -> Reacting:
    """Reactions in ``joints`` (k,); jacobians (R, T, rows of all joints and drivers, 6) are compact, lam (R, T, m).

    ``gone`` (R, T, rows): which rows hold no more.
    """  # fmt: skip
    first, rows = packed[0], jacobians.shape[2]
    if gone is not None:
        jacobians[gone] = 0.0
    out = lam.copy()
    for mine, compact, multipliers in zip(out, jacobians, lam, strict=True):
        j = _spread(first, compact)
        forces = np.einsum("trc,tr->tc", j, multipliers[:, :rows])
        mine[:, :rows] = np.einsum("trc,tc->tr", np.linalg.pinv(j.transpose(0, 2, 1), rcond=NEGLIGIBLE), forces)
    own = rows_of_joints(first, joints)
    return Reacting(packed, y, jacobians[:, :, own], out, times, joints, own)


def _spread(packed: Packed, compact: np.ndarray) -> np.ndarray:
    """(T, rows, n) of the first rows of J, compact (T, rows, 6)."""
    whole = np.zeros((len(compact), len(packed.ws.phi), 6))
    whole[:, : compact.shape[1]] = compact
    return packed.spread(whole)[:, : compact.shape[1]]
