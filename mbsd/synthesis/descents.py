"""Least squares from many designs side by side: the method of Levenberg and Marquardt within bounds.

A number at a bound that the slope would push across stays there (the projected method). All designs of a step are swept
at once, so that fifty descents cost little more than one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mbsd.synthesis.residuals import Residuals

FIRST = 1e-2
"""Damping of the first step, in parts of the largest diagonal entry of J^T J."""
FASTER, SLOWER = 1 / 6, 4.0
"""What a step that gains and one that does not make of the damping."""
STIFFEST = 1e7
"""Damping at which a descent ends."""
GAIN = 1e-8
"""Part of its cost that a descent gains at least in a step that counts; after three others it ends."""
IDLE = 3


def descended(
    residuals: Residuals,
    u: np.ndarray,
    *,
    fine: bool,
    steps: int,
    enough: float = 0.0,
    halved: tuple[int, ...] = (),
    seen: Callable[[float, np.ndarray], None] = lambda cost, u: None,
) -> tuple[np.ndarray, np.ndarray]:
    """Designs (n, k) in parts of the bounds, the best first, and their costs (n,), from designs u.

    At the steps ``halved`` the better half goes on alone. A descent ends at a cost of ``enough``; the first that does
    ends them all. ``seen`` is called with the best cost and its design
    after each step.
    """
    u = np.clip(u, 0.0, 1.0)
    missed = residuals.missed(u, fine)
    slopes = residuals.slopes(u, missed, fine)
    damping, idle = np.full(len(u), FIRST), np.zeros(len(u), int)
    for step in range(steps):
        goes = np.flatnonzero((damping < STIFFEST) & (idle < IDLE) & np.isfinite(missed.cost))
        if step in halved and len(goes) > 1:
            order = goes[np.argsort(missed.cost[goes], kind="stable")]
            damping[order[(len(order) + 1) // 2 :]] = np.inf
            goes = np.sort(order[: (len(order) + 1) // 2])
        if not len(goes) or missed.cost.min() <= enough:
            break
        tried = np.clip(u[goes] + _steps(u[goes], missed.rows[goes], slopes[goes], damping[goes]), 0.0, 1.0)
        there = residuals.missed(tried, fine)
        better = there.cost < missed.cost[goes]
        gained = there.cost <= (1 - GAIN) * missed.cost[goes]
        idle[goes] = np.where(gained, 0, idle[goes] + better)
        damping[goes] = np.where(better, np.maximum(FASTER * damping[goes], 1e-12), SLOWER * damping[goes])
        ours = goes[better]
        if len(ours):
            u[ours] = tried[better]
            missed.put(ours, there.take(better))
            slopes[ours] = residuals.slopes(u[ours], missed.take(ours), fine)
        best = int(missed.cost.argmin())
        seen(float(missed.cost[best]), u[best])
    order = np.argsort(missed.cost, kind="stable")
    return u[order], missed.cost[order]


def _steps(u: np.ndarray, rows: np.ndarray, slopes: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """(n, k): of each design -(J^T J + damping)^-1 J^T r over the numbers that no bound holds."""
    slope = np.einsum("nrk,nr->nk", slopes, rows)
    square = np.einsum("nrk,nrl->nkl", slopes, slopes)
    free = ~((u <= 0) & (slope > 0) | (u >= 1) & (slope < 0))
    square *= free[:, :, None] & free[:, None]
    diagonal = np.einsum("nkk->nk", square)
    lift = damping * np.maximum(diagonal.max(axis=1), 1e-300)
    square += np.where(free, lift[:, None], 1.0)[:, :, None] * np.eye(u.shape[1])
    return -np.linalg.solve(square, np.where(free, slope, 0.0)[..., None])[..., 0]
