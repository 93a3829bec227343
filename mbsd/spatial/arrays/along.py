"""Equations along a motion in space: Phi, J and gamma of all rows, weight and inertia of all bodies."""

from __future__ import annotations

import numpy as np

from mbsd.equations.laws import Laws
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.equations.evaluation import tabulate
from mbsd.spatial.equations.tabulated_forces import tabulate_forces
from mbsd.spatial.model.rotation import rotation_matrix


def tabulated(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return Phi (T, h), J (T, h, 6 n) and gamma (T, h) of joints and drivers along a motion."""
    held = packed.system.held
    phi, jac, gamma = _all_rows(packed, drives, q, v, turns)
    return phi[:, :held], jac[:, :held], gamma[:, :held]


def force_rows(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return measures of forces along a motion (T, f), and their rates."""
    held = packed.system.held
    phi, jac, _ = _all_rows(packed, drives, q, v, turns)
    return phi[:, held:], np.einsum("trc,tc->tr", jac[:, held:], v[:, 3:])


def _all_rows(
    packed: Packed, drives: np.ndarray, q: np.ndarray, v: np.ndarray, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    count, rows = len(q), len(packed.ws.phi)
    phi, gamma = np.zeros((2, count, rows))
    compact = np.zeros((count, rows, packed.ws.jac.shape[1]))
    whole = (np.ascontiguousarray(part) for part in (drives, q, v, turns))
    tabulate(packed.system, *whole, packed.ws, phi, compact, gamma)
    return phi, packed.spread(compact), gamma


def forces_along(
    packed: Packed, laws: Laws, times: np.ndarray, drives: np.ndarray, q: np.ndarray, v: np.ndarray, turns: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return loads (T, 3 + 6 n) of all forces, in the world, and multipliers (T, m) of their rows."""
    load, lam = np.zeros_like(v), np.zeros((len(q), len(packed.ws.phi)))
    if len(packed.forces):
        whole = (np.ascontiguousarray(part) for part in (times, drives, q, v, turns))
        tabulate_forces(packed.system, laws, *whole, packed.ws, load, lam)
    return load, lam


def load_of(packed: Packed, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Return (T, 3 + 6 n) weight less inertia: force and torque about centres of mass, in the world."""
    out = np.zeros_like(v)
    pose, rate, bend = q[:, 3:].reshape(len(q), -1, 7), v[:, 3:].reshape(len(q), -1, 6), a[:, 3:].reshape(len(q), -1, 6)
    system, load = packed.system, out[:, 3:].reshape(len(q), -1, 6)
    load[..., :3] = system.mass[1:, None] * (system.gravity - bend[..., :3])
    rotation = rotation_matrix(pose[..., 3:])
    w, turning = (np.einsum("tbji,tbj->tbi", rotation, part[..., 3:]) for part in (rate, bend))
    moment = system.inertia[1:]
    load[..., 3:] = -np.einsum("tbij,tbj->tbi", rotation, moment * turning + np.cross(w, moment * w))
    return out
