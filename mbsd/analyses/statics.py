"""A mechanism at rest: its loads, its tangent directions, and how the loads change along them.

    J T = 0          T: tangent basis, orthonormal in dimensionless coordinates (lengths over the size, angles in rad)
    dq = B dz        z: independent coordinates,  B = T (T_z)^-1
    K = T^T d(J^T lam - Q)/dq T,   lam held        stiffness along T

T is the null space of J by singular values. Pivoted QR of its rows picks the coordinates that tell best where the
mechanism goes; angles are preferred a little, and the bodies named first. For loads with a potential V, K is the second
derivative of V along the constraints: the multipliers bring in their curvature.

Poses are moved for differences and searches no farther than surfaces that touch yield, nor over teeth: a contact of
steel yields some micrometres, over which its stiffness is not that of a part of the mechanism's size.

Sources: Haug 1989, ch. 3.7, 4.4 and 7; Wehage, Haug 1982, J. Mech. Design 104 (generalised coordinate partitioning);
Luenberger, Linear and Nonlinear Programming, ch. 11 (the Lagrangian on the tangent space).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mbsd.arrays.inertias import coupled, weight_of
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import loads_along, pack_loads
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import generalised
from mbsd.base.names import Suggesting
from mbsd.equations.assembly import residual_and_jacobian, tabulate
from mbsd.equations.laws import Laws
from mbsd.equations.loads import Loads
from mbsd.results.measured import gaps_of

RANK = 1e-8
"""Smallest singular value of the scaled Jacobian, relative to the largest, that counts."""
PREFERENCE = {"angle": 4.0, "earlier": 1.02}
"""Preference of an angle over a position, and of a body over the next one."""
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
    """Return the step (sizes, rad) at q (3 nb,): ``usual``, or less where journals are near bearings."""
    gaps = [float(gap) for force in packed.forces for gap in gaps_of(packed, force, q[None])]
    return max(min([usual, *(PART * gap / packed.size for gap in gaps)]), LEAST)


STEP = 1e-3
"""Step of central differences, in sizes and rad; they are of fourth order."""
DIFFERENCES = np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
OFFSETS = np.array([-2.0, -1.0, 1.0, 2.0])


@dataclass
class Statics(Suggesting):
    """Evaluations at rest at one time; q (3 nb,) and loads (n,) without ground."""

    packed: Packed
    time: float
    drive: np.ndarray
    """(drivers + 1, 3) positions held, no rates."""
    loads: Loads
    laws: Laws
    weight: np.ndarray
    """(3 nb,) N."""
    among: np.ndarray | None = None
    """(n,) coordinates that move, the loads of others left out; None: all."""

    @cached_property
    def groups(self) -> list[Statics]:
        """Statics of each set of connected bodies: no set is measured by the loads of another."""
        group = coupled(self.packed)[1:].repeat(3)
        numbers = np.unique(group)
        return [self] if len(numbers) < 2 else [replace(self, among=group == number) for number in numbers]

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """(m, n)"""
        residual_and_jacobian(self.packed.system, q, self.drive, self.packed.ws)
        return self.packed.jacobian()

    def applied(self, q: np.ndarray) -> np.ndarray:
        """(T, n) springs and other forces at poses q (T, 3 nb)."""
        times = np.full(len(q), self.time)
        return loads_along(self.packed, self.loads, self.laws, times, q, np.zeros_like(q))[:, 3:]

    def load(self, q: np.ndarray) -> np.ndarray:
        """(n,) all loads Q at q (3 nb,), weight included."""
        load = self.applied(q[None])[0] + self.weight[3:]
        return load if self.among is None else np.where(self.among, load, 0.0)

    def multipliers(self, jacobian: np.ndarray, load: np.ndarray) -> np.ndarray:
        """(m,) of least norm with J^T lam = Q as nearly as can be."""
        rows, columns = self.packed.row_scale(), self.packed.column_scale()
        scaled = (jacobian * rows[:, None] * columns).T
        return rows * np.linalg.lstsq(scaled, load * columns, rcond=1e-9)[0] if len(rows) else np.zeros(0)

    def stiffness(self, q: np.ndarray, lam: np.ndarray, basis: np.ndarray, step: float = STEP) -> np.ndarray:
        """(f, f) along the directions ``basis`` (n, f), dimensionless, by poses ``step`` (sizes, rad) apart."""
        count, columns = basis.shape[1], self.packed.column_scale()
        if not count:
            return np.zeros((0, 0))
        poses = np.tile(q, (len(OFFSETS), count, 1))
        poses[:, :, 3:] += step * OFFSETS[:, None, None] * (basis * columns[:, None]).T
        poses = poses.reshape(-1, len(q))
        rows, many = len(lam), len(poses)
        phi, gamma, compact = np.zeros((many, rows)), np.zeros((many, rows)), np.zeros((many, rows, 6))
        drives = np.tile(self.drive, (many, 1, 1))
        tabulate(self.packed.system, drives, poses, np.zeros_like(poses), self.packed.ws, phi, compact, gamma)
        left = generalised(self.packed, compact, np.tile(lam, (many, 1)))[:, 3:] - self.applied(poses)
        slopes = np.einsum("o,ofn->nf", DIFFERENCES, left.reshape(len(OFFSETS), count, -1)) / step
        return (basis * columns[:, None]).T @ slopes

    def size_of_load(self, q: np.ndarray) -> float:
        """The largest load (N, N m over the size) that balances at q, before anything cancels."""
        columns = self.packed.column_scale()
        if self.among is not None:
            columns = np.where(self.among, columns, 0.0)
        largest = float(np.abs(self.weight[3:] * columns).max(initial=0.0))
        return max(largest, float(np.abs(self.applied(q[None])[0] * columns).max(initial=0.0)))


def statics(packed: Packed, time: float) -> Statics:
    """Statics of a packed mechanism whose drivers hold where they are at ``time`` (s)."""
    drive = packed.drives(np.array([time]))[0]
    drive[:, 1:] = 0.0
    return Statics(packed, time, drive, pack_loads(packed), compiled_laws(packed, time, time), weight_of(packed))
