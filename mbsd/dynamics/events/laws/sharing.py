"""How joints at rest share a friction that several of them could carry, as the locked joints of a loop.

Forces T along ways whose compliance G is singular may change by any z with G z = 0 without changing the motion. Those
are given that load no joint by more than the smallest possible part s of its limit L:

    minimise s   with   |T_k + (Z y)_k| <= s L_k

a linear programme. s > 1: they cannot hold.
"""

from __future__ import annotations

import numpy as np

SINGULAR = 1e-9
"""Eigenvalues (singular values) of G, scaled to a diagonal of ones, below this are zero."""


def share(
    compliance: np.ndarray, forces: np.ndarray, limits: np.ndarray, symmetric: bool = True
) -> tuple[np.ndarray, float]:
    """Shared forces (k,) and s, for G (k, k), forces (k,) and limits (k,).

    G is not ``symmetric`` where contacts slide, whose friction follows their normal forces.
    """
    limits = np.maximum(limits, 1e-12 * float(np.abs(limits).max(initial=0.0)) + 1e-300)
    unit = 1.0 / np.sqrt(np.maximum(np.diag(compliance), 1e-300))
    scaled = compliance * unit * unit[:, None]
    if symmetric:
        value, vector = np.linalg.eigh(scaled)
    else:
        _, value, rows = np.linalg.svd(scaled)
        vector = rows.T
    null = vector[:, value < SINGULAR] * unit[:, None] / limits[:, None]
    part = forces / limits
    if not null.shape[1]:
        return forces, float(np.abs(part).max(initial=0.0))
    if null.shape[1] == len(forces) - 1:  # one freedom: each joint takes the same part, with its own sign
        normal = np.linalg.svd(null.T)[2][-1]
        s = float(normal @ part) / float(np.abs(normal).sum())
        return s * np.sign(normal) * limits, abs(s)
    return _programme(null, part, limits)


def _programme(null: np.ndarray, part: np.ndarray, limits: np.ndarray) -> tuple[np.ndarray, float]:
    from scipy.optimize import linprog

    k, free = null.shape
    column = np.ones((k, 1))
    least = linprog(
        np.r_[np.zeros(free), 1.0],
        A_ub=np.block([[null, -column], [-null, -column]]),
        b_ub=np.r_[-part, part],
        bounds=[(None, None)] * free + [(0.0, None)],
    )
    if least.x is None:  # the given forces are one solution
        return part * limits, float(np.abs(part).max())
    return (part + null @ least.x[:-1]) * limits, float(least.x[-1])
