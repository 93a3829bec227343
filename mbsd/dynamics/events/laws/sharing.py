"""How joints at rest share a friction that several of them could carry, as the locked joints of a loop.

Forces T along ways whose compliance G is singular may change by any z with G z = 0 without changing the motion. Those
are given that load no joint by more than the smallest possible part s of its limit L:

    minimise s   with   |T_k + (Z y)_k| <= s L_k

With one freedom each joint takes the same part s. With more of them that leaves joints undecided which the motion that
gives way first does not move: they share what is left in the same way, with a smaller s, and so on (division.py).
s > 1: they cannot hold.
"""

from __future__ import annotations

import numpy as np

from mbsd.dynamics.events.laws.division import SINGULAR, divide, division_of


def share(compliance: np.ndarray, forces: np.ndarray, limits: np.ndarray) -> tuple[np.ndarray, float]:
    """Shared forces (k,) and s, for a symmetric G (k, k), forces (k,) and limits (k,)."""
    limits = np.maximum(limits, 1e-12 * float(np.abs(limits).max(initial=0.0)) + 1e-300)
    unit = 1.0 / np.sqrt(np.maximum(np.diag(compliance), 1e-300))
    value, vector = np.linalg.eigh(compliance * unit * unit[:, None])
    null = vector[:, value < SINGULAR] * unit[:, None] / limits[:, None]
    part = forces / limits
    if not null.shape[1]:
        return forces, float(np.abs(part).max(initial=0.0))
    if null.shape[1] == len(forces) - 1:  # one freedom: each joint takes the same part, with its own sign
        normal = np.linalg.svd(null.T)[2][-1]
        s = float(normal @ part) / float(np.abs(normal).sum())
        return s * np.sign(normal) * limits, abs(s)
    return share_any(compliance, forces, limits)


def share_any(compliance: np.ndarray, forces: np.ndarray, limits: np.ndarray) -> tuple[np.ndarray, float]:
    """Shared forces (k,) and s for any G whose diagonal is positive, as where contacts slide."""
    out, count = np.ascontiguousarray(forces).copy(), len(forces)
    flags = np.ones(count, np.int64)
    return out, float(divide(np.ascontiguousarray(compliance), flags, out, limits, division_of(count)))
