"""A mechanism at rest: its loads, its constraints, and how the loads change as it moves along its constraints.

    stiffness along T:   K = T^T d(J^T lam - Q)/dq T,   lam held

For loads with a potential V this is the second derivative of V along the constraints: the multipliers bring in their
curvature. Source: Haug 1989, ch. 7 (equilibrium); Luenberger, Linear and Nonlinear Programming, ch. 11 (the Lagrangian
on the tangent space).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from mbsd.arrays.inertias import coupled
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import loads_along, pack_loads
from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import generalised
from mbsd.base.names import Suggesting
from mbsd.equations.assembly import residual_and_jacobian, tabulate
from mbsd.equations.laws import Laws
from mbsd.equations.loads import Loads

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
        """The same of each set of bodies that joints and forces connect: no set is measured by another's loads."""
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
    system = packed.system
    weight = np.zeros((len(system.mass), 3))
    weight[:, :2] = system.mass[:, None] * system.gravity
    return Statics(packed, time, drive, pack_loads(packed), compiled_laws(packed, time, time), weight.ravel())
