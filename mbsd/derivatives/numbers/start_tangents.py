"""How a start changes with a number, where what is given and the joints decide all of it.

    J q' = -Phi',   q'_held = given'             held: the given coordinates that the joints leave free
    J v' = -(J v - nu)',   P v' = (given - P v)'

(...)' is the change with the number at the held motion, and along q'. Places and speeds are linear in most numbers, so
that one value beside a number tells the first; the second is a central difference, as near a toggle q' is large and
turns fast. Source: Haug 1989, ch. 3.
"""

from __future__ import annotations

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics.pose.close import given_coordinates, nearest_turn
from mbsd.kinematics.pose.held_values import held_values, is_choice, places_of
from mbsd.kinematics.pose.initial import drive_at, given_velocities, velocity_places
from mbsd.model.mechanism import Model

CLOSE = 1e-9
"""Sizes and rad by which a held coordinate may differ from what is given."""
ALONG = 1e-5
"""How far differences along q' go, in sizes and rad."""


class StartTangents:
    """Tangents of the start of a mechanism ``m`` made ``ready``."""

    def __init__(self, m: Model, ready: PreparedDynamics) -> None:
        packed = ready.packed
        self.m, self.packed = m, packed
        self.none = np.zeros_like(ready.initial.q), np.zeros_like(ready.initial.q)
        """Tangents q', v' of a number that changes nothing."""
        self.q, self.v, self.drive = ready.initial.q, ready.initial.v, drive_at(packed, ready.start)
        self.nu = np.zeros(len(packed.ws.phi))
        self.nu[packed.driver_rows :] = self.drive[1:, 1]
        self.starts, self.velocities = dict(m.starts), dict(m.velocities)
        self.still = not m.velocities and not self.nu.any()
        """True if nothing moves at the start, for any values of the numbers."""
        self.placed = any(velocity.place is not None for velocity in m.velocities.values())
        """True if a velocity is given at a point of a body; it changes as the body turns."""
        self.speed = self.v.reshape(-1, 3)[packed.system.row_body].reshape(-1, 6)
        """(m, 6) velocities of both bodies of each row."""
        self.phi, self.rate = self._evaluated(packed, self.q)
        self.given = np.zeros(0)
        jac = packed.jacobian()
        given = given_coordinates(m, packed)
        self.values = np.array([value for _, value in given])
        self.wanted = np.array([c for c, _ in given], np.int64)
        scale, size = packed.row_scale()[:, None], packed.column_scale()
        self.size = size
        units = np.eye(packed.coordinates)[self.wanted - 3]
        kept, self.held = held_values(jac * scale * size, units, places_of(self.wanted.tolist()))
        self.places = self._inverse(jac, kept, self.held @ units)
        target = np.array(
            [nearest_turn(self.q, int(c), float(value)) for c, value in zip(self.wanted, self.values, strict=True)]
        )
        off = np.abs(self.q[self.wanted] - target) / size[self.wanted - 3]
        if off[self.held.any(axis=0)].max(initial=0.0) > CLOSE:
            self.places = None
        self.speeds = None
        if not self.still:
            rows, self.given = self._given(m, packed, self.q), self._left(m, packed, self.q)
            kept, self.kept = held_values(jac * scale * size, rows * size, velocity_places(m))
            off = np.abs(self.given[self.kept.any(axis=0)]).max(initial=0.0)
            if is_choice(self.kept) or off <= CLOSE * np.abs(self.v).max(initial=0.0):
                self.speeds = self._inverse(jac, kept, self.kept @ rows)

    def of(
        self, m: Model, packed: Packed | None, away: float, moved: bool, heavier: bool
    ) -> tuple[np.ndarray, np.ndarray] | None:
        """(3 nb,) q' and v' by a number by which ``m`` is ``away``; None where they are not decided.

        ``packed``: arrays of ``m``, where they are others; ``moved``: whether places of markers or of centres of mass
        change with the number; ``heavier``: masses.
        """
        packed, turned = packed or self.packed, moved or m.starts != self.starts
        if not turned and m.velocities == self.velocities and (self.still or not heavier or self.speeds is not None):
            return self.none
        q, v = np.zeros((2, len(self.q)))
        rate = self.rate
        if turned:
            if self.places is None:
                return None
            phi, rate = self._evaluated(packed, self.q)
            values = np.array([value for _, value in given_coordinates(m, packed)])
            q[3:] = self.places @ np.concatenate([(self.phi - phi) / away, self.held @ (values - self.values) / away])
        if self.still and not m.velocities:
            return q, v
        if self.speeds is None:  # the least kinetic energy decides as well
            return None
        if not turned:
            _, rate = self._evaluated(packed, self.q)
        rate = (rate - self.rate) / away
        given = np.zeros(len(self.given))
        if self.placed or m.velocities != self.velocities:
            given = (self._left(m, packed, self.q) - self.given) / away
        far = float(np.abs(q[3:] / self.size).max(initial=0.0))
        if far > 0.0:
            step = ALONG / far
            ahead, behind = self.q + step * q, self.q - step * q
            rate += (self._evaluated(self.packed, ahead)[1] - self._evaluated(self.packed, behind)[1]) / (2.0 * step)
            if self.placed:
                more, less = (self._left(self.m, self.packed, there) for there in (ahead, behind))
                given = given + (more - less) / (2.0 * step)
        v[3:] = self.speeds @ np.concatenate([-rate, self.kept @ given])
        return q, v

    def _evaluated(self, packed: Packed, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Phi and J v - nu (m,) at q (3 nb,) and the speeds of the start."""
        residual_and_jacobian(packed.system, q, self.drive, packed.ws)
        return packed.ws.phi.copy(), (packed.ws.jac * self.speed).sum(axis=1) - self.nu

    @staticmethod
    def _given(m: Model, packed: Packed, q: np.ndarray) -> np.ndarray:
        """P (k, n) of what start_moving gives."""
        entries = given_velocities(m, packed, q)[0]
        rows = np.zeros((len(entries), packed.coordinates))
        for row, factors in zip(rows, entries, strict=True):
            for c, factor in factors.items():
                row[c - 3] = factor
        return rows

    def _left(self, m: Model, packed: Packed, q: np.ndarray) -> np.ndarray:
        """(k,) given - P v."""
        entries, values, _ = given_velocities(m, packed, q)
        return values - [sum(factor * self.v[c] for c, factor in factors.items()) for factors in entries]

    @staticmethod
    def _inverse(jac: np.ndarray, kept: list[int], held: np.ndarray) -> np.ndarray | None:
        """Return the inverse of J (m, n) and ``held``; None where they leave something open, or joints repeat others.

        ``kept``: rows of J that do not.
        """
        whole = len(kept) == len(jac) == jac.shape[1] - len(held)
        return np.linalg.inv(np.vstack([jac, held])) if whole else None
