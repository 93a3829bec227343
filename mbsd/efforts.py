"""Multipliers, reactions and the quality of a solved motion; runs the kernel of dynamics.py in chunks of time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.assembly import residual_and_jacobian
from mbsd.dynamics import inverse_dynamics, joint_wrenches
from mbsd.packing import Packed
from mbsd.prepared import Prepared

JACOBIAN_NUMBERS = 4_000_000
"""How many numbers of Jacobians are held at once."""


@dataclass
class Efforts:
    """Inverse dynamics of a motion, and how well the motion fulfils its equations."""

    lam: np.ndarray
    wrench: np.ndarray
    margin: np.ndarray
    residuals: np.ndarray
    """(4,) largest |Phi|, |J v - nu|, |J a - gamma| and |d(T + V)/dt - power of the drivers|."""


def efforts(ready: Prepared, drives: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Efforts:
    """Multipliers, reactions and checks of the motion q, v, a (T, 3 nb)."""
    packed, system = ready.packed, ready.packed.system
    count, rows = len(q), len(packed.ws.phi)
    inertia = np.stack([system.mass, system.mass, system.inertia], axis=1).ravel()
    weight = np.zeros((len(system.mass), 3))
    weight[:, :2] = system.mass[:, None] * system.gravity
    loads = weight.ravel() - inertia * a
    nu = np.zeros((count, rows))
    nu[:, packed.driver_rows :] = drives[:, 1:, 1]
    out = Efforts(np.zeros((count, rows)), np.zeros((count, len(packed.joints), 3)), np.zeros(count), np.zeros(4))
    chunk = max(1, JACOBIAN_NUMBERS // max(1, rows * packed.coordinates))
    for k in range(0, count, chunk):
        at = slice(k, min(k + chunk, count))
        jac = np.zeros((at.stop - k, rows, packed.coordinates))
        phi, gamma = np.zeros((2, at.stop - k, rows))
        inverse_dynamics(
            system, ready.sequence, ready.factors, packed.ws, packed.first_row, packed.markers[:, 1].copy(),
            drives[at], q[at], v[at], loads[at], out.lam[at], out.wrench[at], phi, gamma, jac,
        )  # fmt: skip
        scaled = jac[:, ready.sequence.rows] * packed.row_scale()[ready.sequence.rows, None] * packed.column_scale()
        singular = np.linalg.svd(scaled, compute_uv=False)
        out.margin[at] = singular[:, -1] / singular[:, 0]
        if ready.mobility.redundant_rows:
            _least_norm(packed, jac, q[at], loads[at], out.lam[at], out.wrench[at])
        rate = np.einsum("trc,tc->tr", jac, v[at, 3:]) - nu[at]
        bend = np.einsum("trc,tc->tr", jac, a[at, 3:]) - gamma
        power = (loads[at] * v[at]).sum(axis=1) - (out.lam[at] * nu[at]).sum(axis=1)
        worst = [np.abs(error).max(initial=0.0) for error in (phi, rate, bend, power)]
        out.residuals = np.maximum(out.residuals, worst)
    return out


def _least_norm(
    packed: Packed, jacobians: np.ndarray, q: np.ndarray, loads: np.ndarray, lam: np.ndarray, wrench: np.ndarray
) -> None:
    """Redundant joints share the load in many ways; take the multipliers of least norm."""
    none = np.zeros((len(packed.motions) + 1, 3))
    for k, jac in enumerate(jacobians):
        lam[k] = np.linalg.lstsq(jac.T, loads[k, 3:], rcond=1e-9)[0]
        residual_and_jacobian(packed.system, q[k], none, packed.ws)
        joint_wrenches(packed.system, packed.ws, packed.first_row, packed.markers[:, 1].copy(), lam[k], wrench[k])
