"""Forces and couples of inertia that an engine leaves to its mounts, by orders of the shaft's turn.

    F_n = sum_i A_n cos n(theta + p_i - b_i) along b_i                    in units of m r w^2, m of the moving parts
        = forward_n e^(i n theta) + backward_n e^(-i n theta)             complex: x + i y
    M_n = sum_i z_i k x F_n,i                                             in units of m r w^2 times the spacing
    rotating masses: F = sum_i e^(i (theta + p_i)), which turns with the shaft

theta is the shaft's angle from where a throw of 0 points up, b_i the bank, p_i the throw, k the axis of the shaft. A
first order whose backward part is zero turns with the shaft, so counterweights on it cancel it.

Source: Maass, Klier 1981, ch. 3; coefficients agree with Norton, Design of Machinery, ch. 14.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.machines.engines.layout import Layout
from mbsd.machines.engines.piston_harmonics import piston_harmonics
from mbsd.results.orders import Turning

ORDERS = (1, 2, 4, 6)


@dataclass(frozen=True, eq=False)
class FreeForces:
    """By order: forces in m r w^2, couples about the middle of the shaft in m r w^2 times the spacing."""

    order: np.ndarray
    """(K,) multiples of the shaft's turn."""
    force: Turning
    couple: Turning

    def index(self, order: int) -> int:
        """The row of an order."""
        return int(np.flatnonzero(self.order == order)[0])


def free_forces(of: Layout, ratio: float | None = None, orders: Sequence[int] = ORDERS) -> FreeForces:
    """Forces of the moving masses of a layout.

    ``ratio``: crank radius over rod; None: all A_n 1, the layout's share alone.
    """
    order = np.asarray(orders)
    size = np.ones(len(order), complex) if ratio is None else piston_harmonics(ratio, int(order.max()))[order - 1]
    axis = np.exp(1j * (of.banks + 0.5 * np.pi))
    lead = order[:, None] * (of.throws - of.banks)
    forward = 0.5 * size[:, None] * np.exp(1j * lead) * axis
    backward = 0.5 * size.conj()[:, None] * np.exp(-1j * lead) * axis
    return _summed(order, forward, backward, of.z)


def rotating_forces(of: Layout) -> FreeForces:
    """Forces of masses at the crank pins (the big ends and throws), one unit of m r w^2 each."""
    forward = 1j * np.exp(1j * of.throws)[None, :]
    return _summed(np.array([1]), forward, np.zeros_like(forward), of.z)


def _summed(order: np.ndarray, forward: np.ndarray, backward: np.ndarray, z: np.ndarray) -> FreeForces:
    """Sums over (K, N) cylinders; k x F is F turned by a quarter."""
    return FreeForces(
        order,
        Turning(forward.sum(axis=1), backward.sum(axis=1)),
        Turning(1j * forward @ z, 1j * backward @ z),
    )
