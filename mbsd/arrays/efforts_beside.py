"""Efforts at and near a pose where J is singular, from those at poses beside it.

With J^T lam = Q - M a the multipliers are  lam = y / D,  D the determinant of J and y smooth functions of the time, by
Cramer's rule. Where D has a root t_c,

    y(t_c) = 0     lam has a limit, and is smooth itself
    y(t_c) != 0    lam grows without bound as 1 / (t - t_c), and there is none at t_c

Where several loops pass together, D has a root of a higher order n, and D^(k/n) with k below n may do in its place.

Both follow from poses at which D is not small, on both sides of t_c, or on one side where the motion begins, ends or
switches to the other assembly; polynomials through these give what is between. Reactions go with the multipliers.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FINITE = 1e-7
"""Part of its largest value below which y vanishes, too."""
NOISE = 1e-8
"""The same as a part of the largest of all y."""
TOLD, LEAST = 1e-5, 1e-2
"""Error, as a part of the largest value beside or of that part of the largest of all, beyond which it is NaN."""
AT_ROOT = 1e-8
"""Part of the largest D beside below which lam = y / D is not a number."""


def lagrange(nodes: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return (P, N) weights at ``places`` (P,) of the polynomial through values at ``nodes`` (N,)."""
    out = np.ones((len(places), len(nodes)))
    for i, node in enumerate(nodes):
        others = np.delete(nodes, i)
        out[:, i] = np.prod((places[:, None] - others) / (node - others), axis=1)
    return out


@dataclass
class Side:
    """Poses beside a change point from which efforts of others follow."""

    time: float
    """Time of the change point (s)."""
    nodes: np.ndarray
    """(N,) rising times (s)."""
    rows: np.ndarray
    """(R,) times whose efforts follow (s)."""

    def efforts(self, factor: np.ndarray, beside: np.ndarray, arms: np.ndarray) -> np.ndarray:
        """Return (R, k) values at the rows from ``beside`` (N, k) at the nodes; NaN where there are none.

        ``factor`` (N + R,): D at the nodes, then at the rows. ``arms`` (k,): 1 of forces, 1/m of torques.
        """
        count = len(self.nodes)
        out, order = self._with_factor(factor, beside, arms), self._order(factor[:count])
        if order > 1:  # several loops pass together, and efforts may grow as the power of one of them
            root = np.sign(self.nodes - self.time) * np.abs(factor[:count]) ** (1.0 / order)
            simple = np.append(root, lagrange(self.nodes, self.rows) @ root)
            for power in range(order - 1, 0, -1):
                lower = self._with_factor(simple**power, beside, arms)
                out = np.where(np.isnan(lower), out, lower)
        return out

    def _order(self, factor: np.ndarray) -> int:
        """Return of which order the root of D is, from its values at the nodes (N,)."""
        away = np.abs(self.nodes - self.time)
        if not (away > 0.0).all() or not (factor != 0.0).all() or np.ptp(away) == 0.0:
            return 1
        slope = np.polynomial.Polynomial.fit(np.log(away), np.log(np.abs(factor)), 1).convert().coef[-1]
        return max(1, round(float(slope)))

    def _with_factor(self, factor: np.ndarray, beside: np.ndarray, arms: np.ndarray) -> np.ndarray:
        """Return values at rows where ``factor`` (N + R,) times the multipliers is smooth; NaN elsewhere."""
        count = len(self.nodes)
        scaled = factor / np.abs(factor[:count]).max()
        y = scaled[:count, None] * beside
        every = np.append(self.rows, self.time)
        weights = lagrange(self.nodes, every)
        inner = np.ones(count, bool)
        inner[np.argmax(np.abs(self.nodes - self.time))] = False
        fewer = lagrange(self.nodes[inner], every)
        at_root, doubt = weights[-1] @ y, np.abs(weights[-1] @ y - fewer[-1] @ y[inner])
        largest = np.abs(y).max(axis=0)
        rounding = np.maximum(FINITE * largest, NOISE * float((largest * arms).max(initial=0.0)) / arms)
        is_finite = np.abs(at_root) <= rounding + 10.0 * doubt
        limit, wrong = weights[:-1] @ beside, np.abs(weights[:-1] @ beside - fewer[:-1] @ beside[inner])
        most = np.abs(beside).max(axis=0)
        limit[wrong > TOLD * np.maximum(most, LEAST * float((most * arms).max(initial=0.0)) / arms)] = np.nan
        root = scaled[count:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            unbounded = np.where(np.abs(root) > AT_ROOT, (weights[:-1] @ y) / root, np.nan)
        return np.where(is_finite, limit, unbounded)


def efforts_beside(
    side: Side, factor: np.ndarray, lam: np.ndarray, wrench: np.ndarray, row_scale: np.ndarray, size: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return lam (R, m) and wrench (R, joints, 3 or 6) at the rows of a side; NaN without nodes.

    ``lam`` (N, m) and ``wrench`` (N, joints, 3 or 6) at its nodes; ``factor`` (N + R,): D at both. ``row_scale`` (m,)
    makes residuals dimensionless, lengths by ``size`` (m).
    """
    count, (joints, parts) = len(side.rows), wrench.shape[1:]
    turning = parts // 2
    ones = np.tile([1.0] * (parts - turning) + [size] * turning, joints)
    values = np.full((count, lam.shape[1] + parts * joints), np.nan)
    if len(side.nodes):
        arms = 1.0 / np.concatenate([1.0 / (row_scale * size), ones])
        values = side.efforts(factor, np.hstack([lam, wrench.reshape(len(wrench), -1)]), arms)
    return values[:, : lam.shape[1]], values[:, lam.shape[1] :].reshape(count, joints, parts)
