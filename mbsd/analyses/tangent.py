"""The directions in which a mechanism can move at a pose, and coordinates that are independent there.

    J T = 0          T: tangent basis, orthonormal in dimensionless coordinates (lengths over the size, angles in rad)
    dq = B dz        z: independent coordinates,  B = T (T_z)^-1

T is the null space of J by singular values. Pivoted QR of its rows picks the coordinates that tell best where the
mechanism goes; angles are preferred a little, and the bodies named first. Source: Haug 1989, ch. 3.7 and 4.4;
Wehage, Haug 1982, J. Mech. Design 104 (generalised coordinate partitioning).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.arrays.packing import Packed

RANK = 1e-8
"""Smallest singular value of the scaled Jacobian, relative to the largest, that counts."""
PREFERENCE = {"angle": 4.0, "earlier": 1.02}
"""How much an angle is preferred to a place, and a body to the next one."""
COORDINATES = ("x", "y", "theta")


@dataclass(frozen=True)
class Independent:
    """Independent coordinates of a pose."""

    indices: np.ndarray
    """(f,) among the unknowns (n,)."""
    names: tuple[str, ...]
    """``rod.theta``; x and y are those of the body's centre of mass."""
    basis: np.ndarray
    """(n, f) B: dq = B dz, units of the coordinates."""


def tangent(packed: Packed, jacobian: np.ndarray, among: np.ndarray | None = None) -> np.ndarray:
    """(n, f) orthonormal null space of J (m, n), dimensionless: dq = column_scale * (T dz).

    ``among`` (n,): the only coordinates that move; None: all.
    """
    scaled = jacobian * packed.row_scale()[:, None] * packed.column_scale()
    if among is not None:
        out = np.eye(packed.coordinates)[:, among]
        return out @ _null_space(scaled[:, among])
    return _null_space(scaled)


def _null_space(scaled: np.ndarray) -> np.ndarray:
    """(n, f) orthonormal."""
    if not len(scaled):
        return np.eye(scaled.shape[1])
    _, singular, right = np.linalg.svd(scaled, full_matrices=True)
    rank = int((singular > RANK * singular.max(initial=0.0)).sum())
    return right[rank:].T


def independent_coordinates(packed: Packed, basis: np.ndarray) -> Independent:
    """Independent coordinates for a tangent basis (n, f)."""
    from scipy.linalg import qr

    bodies = len(packed.body_names) - 1
    weight = np.tile([1.0, 1.0, PREFERENCE["angle"]], bodies)
    weight *= np.repeat(PREFERENCE["earlier"] ** -np.arange(bodies, dtype=float).clip(max=30), 3)
    count = basis.shape[1]
    pivots = np.zeros(0, np.int64)
    if count:
        *_, pivots = qr(basis.T * weight, mode="economic", pivoting=True)
    indices = np.sort(pivots[:count])
    names = tuple(f"{packed.body_names[1 + c // 3]}.{COORDINATES[c % 3]}" for c in indices)
    physical = basis * packed.column_scale()[:, None]
    return Independent(indices, names, np.linalg.solve(physical[indices].T, physical.T).T if count else physical)
