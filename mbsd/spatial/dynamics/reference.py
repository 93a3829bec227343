"""A mechanism in reference coordinates: its arrays, its start, and the choice among rows that repeat each other."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.equations.interactions.switching import WIDTH
from mbsd.kinematics.pose.held_values import independent_rows
from mbsd.kinematics.pose.mobility import better_rows
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.dynamics.envelope import OWN, envelope_of
from mbsd.spatial.dynamics.formulation import SpaceDynamics, Switches, Table
from mbsd.spatial.model.rotation import rotation_matrix


class ReferenceCoordinates:
    """All coordinates of a mechanism with their start."""

    def __init__(self, packed: Packed, q: np.ndarray, v: np.ndarray, repeats: bool, start: float) -> None:
        """Start from a closed pose q (3 + 7 n,) with velocities v (3 + 6 n,) in the world.

        ``repeats``: some rows of joints repeat each other. ``start``: the time (s).
        """
        self.packed, self.ws = packed, packed.ws
        self.kept = self._best_rows(q)
        self.limit = OWN if repeats else 0.0
        self.entries, self.rates = len(q), packed.freedoms
        self.counted = np.zeros(1 + len(packed.ws.turn))
        self.counted[0] = start
        self.y = np.zeros((2, len(q)))
        self.y[0] = q
        self.y[1, : len(v)] = _to_bodies(q, v)

    @staticmethod
    def nanoseconds(packed: Packed) -> float:
        """Return about what an evaluation takes on one processor (ns); see docs/decisions/space/formulation.md."""
        return 120.0 * len(packed.bodies) + 210.0 * len(packed.row_joint)

    def _best_rows(self, q: np.ndarray) -> np.ndarray:
        """Return rows that are independent and far from each other at q."""
        jac = self.packed.scaled(q)
        kept = independent_rows(jac)
        chosen = better_rows(jac, kept) if 0 < len(kept) < len(jac) else None
        return np.array(kept if chosen is None else chosen, np.int64)

    def dynamics(self, laws: Any, turns: np.ndarray, drive: np.ndarray) -> SpaceDynamics:
        """Return the arrays of a run with laws; turns (T, turns) takes counted angles."""
        del drive
        packed, nb = self.packed, len(self.packed.bodies)
        inertia, weight, per_size = (np.zeros(7 * nb - 4) for _ in range(3))
        for b in range(1, nb):
            part = slice(6 * b - 3, 6 * b)
            inertia[part], inertia[6 * b : 6 * b + 3] = packed.system.mass[b], packed.system.inertia[b]
            weight[part] = packed.system.mass[b] * packed.system.gravity
            per_size[part], per_size[6 * b : 6 * b + 3] = 1.0 / packed.size, 1.0
        inverse = np.divide(1.0, inertia, out=np.zeros_like(inertia), where=inertia > 0.0)
        envelope, factors = envelope_of(packed.system.row_body, self.kept)
        none = Table(np.zeros((0, 2), np.int64), np.zeros((0, 2), np.int64))
        return SpaceDynamics(
            system=packed.system, laws=laws, loads=Switches(np.zeros((1, WIDTH))), schur=none, sliding=none,
            envelope=envelope, factors=factors, inertia=inertia, inverse=inverse, weight=weight, per_size=per_size,
            world=np.zeros(6 * nb - 3), pushed=np.zeros(len(packed.ws.phi)), limit=np.array([self.limit]), turns=turns,
            counted=self.counted,
        )  # fmt: skip

    def check_callbacks(self, accepted: bool) -> None:
        """Raise what functions of the user raised; see Packed."""
        self.packed.check_callbacks(accepted)

    def choose(self, y: np.ndarray) -> None:
        """Choose rows anew at a state (2, n), where those in use come near to depend on each other."""
        if better_rows(self.packed.scaled(y[0]), self.kept) is None:
            self.limit *= 0.1
        else:
            self.kept, self.limit = self._best_rows(y[0]), OWN

    def allowed(self, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """Return absolute and growing tolerances (2, n) of the state."""
        absolute = np.full((2, self.entries), tolerance)
        for b in range(1, len(self.packed.bodies)):
            absolute[0, 7 * b - 4 : 7 * b - 1] *= self.packed.size
            absolute[1, 6 * b - 3 : 6 * b] *= self.packed.size
        return absolute, np.full_like(absolute, tolerance)

    def to_world(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return velocities or accelerations v (T, 3 + 6 n) with rotations in the world instead of body axes."""
        out = np.ascontiguousarray(v)
        parts = out[:, 3:].reshape(len(out), -1, 6)
        parts[..., 3:] = np.einsum("tbij,tbj->tbi", _rotations(q), parts[..., 3:])
        out[:, 3:] = parts.reshape(len(out), -1)
        return out


def _rotations(q: np.ndarray) -> np.ndarray:
    """Return (..., n, 3, 3) rotations from principal axes to the world."""
    return rotation_matrix(q[..., 3:].reshape(*q.shape[:-1], -1, 7)[..., 3:])


def _to_bodies(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return v (3 + 6 n,) with rotations in body axes instead of the world."""
    out = v.copy()
    parts = out[3:].reshape(-1, 6)
    parts[:, 3:] = np.einsum("bji,bj->bi", _rotations(q), parts[:, 3:])
    return out
