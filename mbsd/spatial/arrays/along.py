"""Equations along a motion in space: Phi, J and gamma of all rows, loads of all bodies."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.equations.laws import Laws
from mbsd.spatial.arrays.packing import Packed
from mbsd.spatial.equations.evaluation import tabulate, tabulate_loads
from mbsd.spatial.equations.friction import ROW


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


def loads_along(packed: Packed, laws: Laws, motion: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return loads (T, 3 + 6 n) and multipliers (T, m) of the rows of forces along a motion.

    Loads are weight and forces less inertia: force and torque about centres of mass, in the world. ``motion`` is a
    DrivenMotion (mbsd/spatial/kinematics/newton.py).
    """
    load, lam = np.zeros_like(motion.v), np.zeros((len(motion.q), len(packed.ws.phi)))
    series = (motion.times, motion.drives, motion.q, motion.v, motion.a, motion.turn)
    whole = (np.ascontiguousarray(part) for part in series)
    tabulate_loads(packed.system, laws, *whole, packed.ws, load, lam)
    frictions = packed.system.friction[:, ROW]
    if len(frictions):
        lam[:, frictions] = motion.lam[:, frictions]
        _, jac, _ = _all_rows(packed, motion.drives, motion.q, motion.v, motion.turn)
        load[:, 3:] -= np.einsum("trc,tr->tc", jac[:, frictions], lam[:, frictions])
    return load, lam
