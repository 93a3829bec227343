"""Consistent poses and velocities at the start of rows that differ in them.

Where bodies form no loops and what is given tells all coordinates, these are solved for all rows of a chunk at once:

    Phi(q) = 0,   given coordinates held            Newton-Raphson from the mechanism's own start
    J v = nu,   P v = given                         least kinetic energy, as kinematics/pose/initial.py has it

Else, and where that does not close, a row's start is found as that of a single simulation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.users_function import described
from mbsd.dynamics.many.base import Base
from mbsd.dynamics.many.designs import Designs
from mbsd.equations.assembly import tabulate
from mbsd.kinematics.pose.close import CLOSED
from mbsd.kinematics.pose.initial import consistent, given_coordinates, given_velocities
from mbsd.kinematics.pose.mobility import independent_rows

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

STEPS = 8
"""Steps of Newton-Raphson; a tree of pins takes two."""
EXACT = 1e-13
"""Residual (sizes, rad) below which no further step is taken."""
Started = tuple[np.ndarray, np.ndarray, list[str | None]]
"""q and v (R, 3 nb), and why a row has none."""


class Starts:
    """Starts row by row."""

    def __init__(self, designs: Designs, base: Base) -> None:
        self.designs, self.ready = designs, base.run.ready
        self.work: Any = designs.copied()

    def __call__(self, rows: range) -> Started:
        """Those of some rows."""
        ready = self.ready
        q, v = np.repeat(ready.initial.q[None], len(rows), 0), np.repeat(ready.initial.v[None], len(rows), 0)
        reasons: list[str | None] = []
        for k, row in enumerate(rows):
            try:
                self.designs.put_start(self.work, row)
                initial = consistent(self.work, ready.packed, ready.start, ready.dynamics.metric)
                q[k], v[k] = initial.q, initial.v
                reasons.append("; ".join(initial.velocities) or None)
            except Exception as error:
                reasons.append(described(error))
        return q, v, reasons


class StartsAtOnce(Starts):
    """Starts of all rows of a chunk at once, of a mechanism without loops."""

    def __init__(self, designs: Designs, base: Base) -> None:
        super().__init__(designs, base)
        ready, packed = self.ready, self.ready.packed
        designs.put_start(self.work, 0)
        self.wanted = np.array([c for c, _ in given_coordinates(self.work, packed)])
        self.drive = packed.drives(np.array([ready.start]))[0]
        jac = self._jacobians(ready.initial.q[None])[1][0] * packed.column_scale()
        units = np.eye(packed.coordinates)[self.wanted - 3]
        kept = independent_rows(np.vstack([jac, units]))
        self.held = np.array([k - len(jac) for k in kept if k >= len(jac)], np.int64)
        self.suits = len(jac) + len(self.held) == packed.coordinates == len(kept)
        self.nu = np.zeros(len(jac))
        self.nu[packed.driver_rows :] = self.drive[1:, 1]

    def __call__(self, rows: range) -> Started:
        """Those of some rows."""
        q = np.repeat(self.ready.initial.q[None], len(rows), 0)
        targets = self._targets(rows)
        q[:, self.wanted] = targets
        q, worst = self._closed(q, targets)
        if not (worst <= CLOSED).all():
            return super().__call__(rows)
        v = self._velocities(rows, q)
        return super().__call__(rows) if v is None else (q, v, [None for _ in rows])

    def _targets(self, rows: range) -> np.ndarray:
        out = np.zeros((len(rows), len(self.wanted)))
        for k, row in enumerate(rows):
            self.designs.put_start(self.work, row)
            out[k] = [value for _, value in given_coordinates(self.work, self.ready.packed)]
        return out

    def _jacobians(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Residuals (R, m) and Jacobians (R, m, n) of poses q (R, 3 nb), in sizes and rad by row."""
        packed = self.ready.packed
        count, rows = len(q), len(packed.ws.phi)
        phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
        drives = np.repeat(self.drive[None], count, axis=0)
        tabulate(packed.system, drives, q, np.zeros_like(q), packed.ws, phi, compact, gamma)
        scale = packed.row_scale()
        return phi * scale, packed.spread(compact) * scale[:, None]

    def _closed(self, q: np.ndarray, targets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        size = self.ready.packed.column_scale()
        held = self.wanted[self.held]
        units = np.broadcast_to(np.eye(len(size))[held - 3], (len(q), len(held), len(size)))
        worst = np.full(len(q), np.inf)
        for _ in range(STEPS):
            phi, jac = self._jacobians(q)
            worst = np.abs(phi).max(axis=1, initial=0.0)
            if (worst <= EXACT).all():
                break
            off = (q[:, held] - targets[:, self.held]) / size[held - 3]
            matrix = np.concatenate([jac * size, units], axis=1)
            try:
                step = np.linalg.solve(matrix, -np.concatenate([phi, off], axis=1)[..., None])[..., 0]
            except np.linalg.LinAlgError:
                return q, np.full(len(q), np.inf)
            q[:, 3:] += step * size
        return q, worst

    def _velocities(self, rows: range, q: np.ndarray) -> np.ndarray | None:
        """(R, 3 nb), or None where what is given contradicts the joints or itself."""
        v = np.zeros_like(q)
        if not self.work.velocities and not self.nu.any():
            return v
        packed, n = self.ready.packed, self.ready.packed.coordinates
        jac = self._jacobians(q)[1]
        own, values = [], []
        for k, row in enumerate(rows):
            self.designs.put_start(self.work, row)
            given, wanted, _ = given_velocities(self.work, packed, q[k])
            matrix = np.zeros((len(given), n))
            for entry, factors in zip(matrix, given, strict=True):
                for c, factor in factors.items():
                    entry[c - 3] = factor
            own.append(matrix)
            values.append(wanted)
        everything = np.concatenate([jac, np.array(own)], axis=1)
        if len(independent_rows(everything[0] * packed.column_scale())) < everything.shape[1]:
            return None
        wanted = np.concatenate([np.broadcast_to(self.nu * packed.row_scale(), jac.shape[:2]), np.array(values)], 1)
        root = np.sqrt(self.ready.dynamics.metric[3:])
        scaled = everything * root
        square = scaled @ scaled.transpose(0, 2, 1)
        for _ in range(2):  # the second takes off what rounding left
            left = wanted - (everything @ v[:, 3:, None])[..., 0]
            v[:, 3:] += root * (scaled.transpose(0, 2, 1) @ np.linalg.solve(square, left[..., None]))[..., 0]
        return v


def starts_of(designs: Designs, base: Base) -> Starts:
    """The starts of rows."""
    packed = base.run.ready.packed
    if packed.states or len(packed.system.special) or len(packed.system.angle) or not _is_tree(packed):
        return Starts(designs, base)
    at_once = StartsAtOnce(designs, base)
    return at_once if at_once.suits else Starts(designs, base)


def _is_tree(packed: Packed) -> bool:
    """Whether joints and drivers connect bodies and ground without loops."""
    group = list(range(len(packed.body_names)))
    for i, j in packed.system.marker_body[packed.markers]:
        a, b = group[i], group[j]
        if a == b:
            return False
        group = [a if part == b else part for part in group]
    return True
