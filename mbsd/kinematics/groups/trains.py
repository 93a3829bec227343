"""Gear trains, belts and locks with angles that are sums: closed forms for fixed or moving arms.

A gear or belt between wheels whose centres one arm carries holds, for ever and all turns counted,

    r_i theta_i + s r_j theta_j - (r_i + s r_j) theta_arm = c

(mbsd/equations/relative/gear.py), a lock theta_j - theta_i = c. As many such equations as pinned bodies with unknown
angles give each angle as a sum of known ones:  theta = c_0 + sum c_k theta_k.  Source: Willis; Norton, Design of
Machinery, ch. 9.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.equations.relative.equation import ARM, AT, MARKER_I, MARKER_J, MOTION, OWN, ROW, WRAPS

SAME_POINT = 1e-12
"""Points of a body within this part of the mechanism's size are one."""
SINGULAR = 1e-9
"""Least singular value of the equations beside the largest."""
PROVED = 1e-12
"""Largest sum of coefficients, beside the largest of them, that counts as zero."""


@dataclass
class Sum:
    """theta = constant + sum of shares times angles of other bodies."""

    constant: float
    shares: dict[int, float]


class Trains:
    """The equations of a mechanism at its closed pose q0 (3 nb,) that are sums of angles."""

    def __init__(self, packed: Packed, q0: np.ndarray) -> None:
        self.packed, self.theta = packed, q0[2::3]
        self.sums: dict[int, Sum] = {}
        """Sums of the bodies known so far."""
        residual_and_jacobian(packed.system, q0, np.zeros((len(packed.motions) + 1, 3)), packed.ws)
        self.open = packed.ws.phi.copy()
        self.rows = self._angle_rows() | self._special_rows()
        """Factors of the angles, of each such row."""

    def solve(self, rows: Sequence[int], pinned: Sequence[int], follows: dict[int, int]) -> bool:
        """Find the angles of ``pinned`` bodies from as many rows; ``follows``: bodies that turn with others.

        False where some row is no sum of angles, or the rows repeat each other.
        """
        if len(rows) != len(pinned) or not all(row in self.rows for row in rows):
            return False
        at = {body: k for k, body in enumerate(pinned)}
        for body, leader in follows.items():
            if leader in at:
                at[body] = at[leader]
        matrix = np.zeros((len(rows), len(pinned)))
        known = np.zeros((len(rows), len(self.theta)))
        for r, row in enumerate(rows):
            for body, factor in self.rows[row].items():
                if body in at:
                    matrix[r, at[body]] += factor
                elif body in follows:
                    known[r, follows[body]] -= factor
                else:
                    known[r, body] -= factor
        scale = np.abs(matrix).max(axis=1, initial=0.0)
        if not scale.all() or np.linalg.cond(matrix / scale[:, None]) > 1.0 / SINGULAR:
            return False
        shares = np.linalg.solve(matrix, known)
        closed = -np.linalg.solve(matrix, self.open[list(rows)])
        shares[:, 0] = 0.0
        for body, k in ((body, at[body]) for body in pinned):
            constant = self.theta[body] + closed[k] - float(shares[k] @ self.theta)
            self.sums[body] = Sum(float(constant), {int(b): float(shares[k, b]) for b in np.flatnonzero(shares[k])})
        return True

    def proves(self, row: int) -> bool:
        """Return True if a row holds always, because the angles that were found make it so."""
        if row not in self.rows:
            return False
        total: dict[int, float] = {}
        largest = 0.0
        waiting = list(self.rows[row].items())
        while waiting:
            body, factor = waiting.pop()
            largest = max(largest, abs(factor))
            if body in self.sums:
                waiting += [(other, factor * share) for other, share in self.sums[body].shares.items()]
            elif body:
                total[body] = total.get(body, 0.0) + factor
        return all(abs(value) <= PROVED * largest for value in total.values())

    def _angle_rows(self) -> dict[int, dict[int, float]]:
        system = self.packed.system
        return {
            int(row): {int(system.marker_body[i]): -1.0, int(system.marker_body[j]): 1.0}
            for i, j, row, motion in system.angle
            if motion == 0
        }

    def _special_rows(self) -> dict[int, dict[int, float]]:
        system, out = self.packed.system, {}
        for name, entry in zip(self.packed.specials.names, system.special, strict=True):
            numbers = system.numbers[entry[AT] :]
            i, j = (int(system.marker_body[entry[column]]) for column in (MARKER_I, MARKER_J))
            if entry[MOTION]:
                continue
            if name == "turn" or (name == "linear" and not numbers[OWN : OWN + 2].any()):
                factors = [(i, -numbers[OWN + 2]), (j, numbers[OWN + 2])]
            elif name in ("gear", "turns") and numbers[WRAPS] == 0.0 and self._carries(entry):
                first, second = float(numbers[OWN]), float(numbers[OWN + 1])
                factors = [(i, first), (j, second), (int(entry[ARM]), -first - second)]
            else:
                continue
            sums: dict[int, float] = {}
            for body, factor in factors:
                sums[body] = sums.get(body, 0.0) + float(factor)
            out[int(entry[ROW])] = sums
        return out

    def _carries(self, entry: np.ndarray) -> bool:
        """Return True if the arm of a gear carries both centres by pins, not only by chance at the start."""
        return all(int(entry[ARM]) in self._at_one_pin(int(entry[column])) for column in (MARKER_I, MARKER_J))

    def _at_one_pin(self, marker: int) -> dict[int, np.ndarray]:
        """Return bodies that pins hold together at the point of a marker, and their arms to it."""
        system, near = self.packed.system, SAME_POINT * self.packed.size
        arms = {int(system.marker_body[marker]): system.marker_arm[marker]}
        waiting = list(arms)
        while waiting:
            body = waiting.pop(0)
            x, y = arms[body]
            for here, there in self._pins.get(body, ()):
                other = int(system.marker_body[there])
                if other in arms:
                    continue
                at = system.marker_arm[here]
                if abs(at[0] - x) <= near and abs(at[1] - y) <= near:
                    arms[other] = system.marker_arm[there]
                    waiting.append(other)
        return arms

    @cached_property
    def _pins(self) -> dict[int, list[tuple[int, int]]]:
        """By body, markers of its pins on it and on the other body."""
        out: dict[int, list[tuple[int, int]]] = {}
        for joint, (i, j) in zip(self.packed.joints, self.packed.markers, strict=True):
            if joint.kind.constraints == ("point",):
                for here, there in ((i, j), (j, i)):
                    out.setdefault(int(self.packed.system.marker_body[here]), []).append((int(here), int(there)))
        return out
