"""Consistent poses and velocities at the start of rows that differ in them.

Where bodies form no loops and what is given tells all coordinates, these are solved for all rows of a chunk at once:

    Phi(q) = 0,   given coordinates held            Newton-Raphson from the mechanism's own start
    J v = nu,   P v = given                         least kinetic energy, as kinematics/pose/initial.py has it

Else, and where that does not close, a row's start is found as that of a single simulation.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.arrays.inertias import inertia_of, least_energy, usual_inertia
from mbsd.arrays.packing import pack
from mbsd.base.arguments import described
from mbsd.base.errors import ModelError
from mbsd.dynamics.batch.designs import Designs
from mbsd.dynamics.batch.single_run import Base
from mbsd.equations.assembly import tabulate
from mbsd.kinematics.pose.close import CLOSED, given_coordinates
from mbsd.kinematics.pose.held_values import RANK_TOLERANCE, free_direction, half_held, independent_rows, places_of
from mbsd.kinematics.pose.initial import consistent, given_velocities

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

    @cached_property
    def _without_contacts(self) -> Packed:
        """The mechanism without the rows of contacts and of joints that stick, which hold no start."""
        ready = self.ready
        if not ready.switches.contacts and not ready.sticks:
            return ready.packed
        packed = pack(self.work)
        packed.settle_laws(ready.start, ready.end)
        return packed

    def __call__(self, rows: Sequence[int]) -> Started:
        """Return the starts of some rows."""
        ready = self.ready
        q, v = np.repeat(ready.initial.q[None], len(rows), 0), np.repeat(ready.initial.v[None], len(rows), 0)
        reasons: list[str | None] = []
        for k, row in enumerate(rows):
            try:
                self.designs.put_start(self.work, row)
                initial = consistent(self.work, self._without_contacts, ready.start)
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
        next(row for row in range(designs.count) if self._refused(row) is None)  # of it, what is given
        self.wanted = np.array([c for c, _ in given_coordinates(self.work, packed)], np.int64)
        self.drive = packed.drives(np.array([ready.start]))[0]
        jac = self._jacobians(ready.initial.q[None])[1][0] * packed.column_scale()
        units = np.eye(packed.coordinates)[self.wanted - 3]
        kept = independent_rows(np.vstack([jac, units]))
        self.held = [k - len(jac) for k in kept if k >= len(jac)]
        self.halves = half_held(self.held, places_of(self.wanted.tolist()))
        self.suits = len(jac) + len(self.held) == packed.coordinates == len(kept)
        self.nu = np.zeros(len(jac))
        self.nu[packed.driver_rows :] = self.drive[1:, 1]

    def __call__(self, rows: Sequence[int]) -> Started:
        """Return the starts of some rows."""
        reasons = [self._refused(row) for row in rows]
        known = [k for k, reason in enumerate(reasons) if reason is None]
        if len(known) == len(rows):
            return self._at_once(rows)
        q, v = (np.repeat(part[None], len(rows), 0) for part in (self.ready.initial.q, self.ready.initial.v))
        if known:
            q[known], v[known], own = self._at_once([rows[k] for k in known])
            for k, reason in zip(known, own, strict=True):
                reasons[k] = reason
        return q, v, reasons

    def _refused(self, row: int) -> str | None:
        """Why what is given of a row's start cannot be."""
        try:
            self.designs.put_start(self.work, row)
        except ModelError as error:
            return described(error)
        return None

    def _at_once(self, rows: Sequence[int]) -> Started:
        """Return the starts of rows whose starts are possible."""
        q = np.repeat(self.ready.initial.q[None], len(rows), 0)
        targets = self._targets(rows)
        q[:, self.wanted] = targets
        q, worst = self._closed(q, targets)
        v, clear = self._velocities(rows, q)
        reasons: list[str | None] = [None for _ in rows]
        for k in np.flatnonzero(~(clear & (worst <= CLOSED))).tolist():  # each by itself, whichever are beside it
            (q[k],), (v[k],), (reasons[k],) = super().__call__(rows[k : k + 1])
        return q, v, reasons

    def _targets(self, rows: Sequence[int]) -> np.ndarray:
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
        worst, left = np.full(len(q), np.inf), np.arange(len(q))
        for _ in range(STEPS):
            phi, jac = self._jacobians(q[left])
            worst[left] = np.abs(phi).max(axis=1, initial=0.0)
            going = worst[left] > EXACT
            left, phi, jac = left[going], phi[going], jac[going]
            if not len(left):
                break
            held = self._held(jac * size)
            units = held @ np.eye(len(size))[self.wanted - 3]
            off = (held @ ((q[left][:, self.wanted] - targets[left]) / size[self.wanted - 3])[..., None])[..., 0]
            q[left, 3:] += _solved(np.concatenate([jac * size, units], 1), -np.concatenate([phi, off], 1)) * size
        return q, worst

    def _held(self, jac: np.ndarray) -> np.ndarray:
        """(R, h, k) what is held of the given values, by J (R, m, n) in sizes; see kinematics/pose/held_values.py."""
        units = np.eye(jac.shape[2])[self.wanted - 3]
        out = np.repeat(np.eye(len(self.wanted))[self.held][None], len(jac), axis=0)
        for x, y in self.halves:
            before = np.repeat(units[[k for k in self.held if k < x]][None], len(jac), axis=0)
            at = next(n for n, k in enumerate(self.held) if k in (x, y))
            out[:, at, [x, y]] = free_direction(np.concatenate([jac, before], axis=1), units[[x, y]])
        return out

    def _velocities(self, rows: Sequence[int], q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(R, 3 nb), and (R,) whether what is given contradicts neither the joints nor itself."""
        v, clear = np.zeros_like(q), np.ones(len(q), bool)
        if not self.work.velocities and not self.nu.any():
            return v, clear
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
        sized = everything * packed.column_scale()
        sized /= np.maximum(np.linalg.norm(sized, axis=-1, keepdims=True), 1e-300)
        clear = np.linalg.svd(sized, compute_uv=False)[:, -1] > RANK_TOLERANCE
        wanted = np.concatenate([np.broadcast_to(self.nu * packed.row_scale(), jac.shape[:2]), np.array(values)], 1)
        inertia, root = inertia_of(packed)[3:], np.sqrt(1.0 / usual_inertia(packed)[3:])
        scaled = everything * root
        square = scaled @ scaled.transpose(0, 2, 1)
        for _ in range(2):  # the second takes off what rounding left
            left = wanted - (everything @ v[:, 3:, None])[..., 0]
            v[:, 3:] += root * (scaled.transpose(0, 2, 1) @ _solved(square, left)[..., None])[..., 0]
        if not inertia.all():
            v[:, 3:] = least_energy(v[:, 3:], everything, inertia, packed.column_scale())
        return v, clear


def _solved(matrices: np.ndarray, right: np.ndarray) -> np.ndarray:
    """(R, n) solutions, not numbers where a matrix (R, n, n) is singular."""
    try:
        return np.linalg.solve(matrices, right[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full(right.shape, np.nan)
        return np.concatenate([_solved(matrices[k : k + 1], right[k : k + 1]) for k in range(len(matrices))])


def starts_of(designs: Designs, base: Base) -> Starts:
    """The starts of rows."""
    packed = base.run.ready.packed
    if packed.states or len(packed.system.special) or len(packed.system.angle) or not _is_tree(packed):
        return Starts(designs, base)
    at_once = StartsAtOnce(designs, base)
    return at_once if at_once.suits else Starts(designs, base)


def _is_tree(packed: Packed) -> bool:
    """Return True if joints and drivers connect bodies and ground without loops."""
    group = list(range(len(packed.body_names)))
    for i, j in packed.system.marker_body[packed.markers]:
        a, b = group[i], group[j]
        if a == b:
            return False
        group = [a if part == b else part for part in group]
    return True
