"""Forces and couples of inertia that an engine leaves to its mounts, by orders of the shaft's turn.

    F_n = sum_i A_n cos n(theta + p_i - b_i) along b_i                    in units of m r w^2, m of the moving parts
        = forward_n e^(i n theta) + backward_n e^(-i n theta)             complex: x + i y
    M_n = sum_i z_i k x F_n,i                                             in units of m r w^2 times the spacing
    rotating masses: F = sum_i e^(i (theta + p_i)), which turns with the shaft

theta is the shaft's angle from where a throw of 0 points up, b_i the bank, p_i the throw, k the axis of the shaft. A
first order whose backward part is zero turns with the shaft, so counterweights on it cancel it. A_n are the harmonics
of one piston's inertia force:

    x = r cos phi + sqrt(l^2 - (r sin phi - e)^2)            from the shaft, phi from the cylinder's axis
    -x'' = r w^2 sum_n A_n cos(n phi + d_n)                  at constant speed w

With e = 0 all d_n are 0, A_1 = 1 and only even orders follow: A_2 = L + L^3/4 + 15 L^5/128 + ..., A_4 = -(L^3/4 +
3 L^5/16 + ...) with L = r / l. The series is summed to rounding by the trapezoidal rule, which is exact for what is
periodic and analytic. An offset e of the wrist pin or cylinder adds odd orders and phases.

Source: Maass, Klier 1981, ch. 3; Biezeno, Grammel, Technische Dynamik, ch. XII (exact coefficients); they agree with
Norton, Design of Machinery, ch. 14.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.machines.engines.layout import Layout
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
        """Return the row of an order."""
        return int(np.flatnonzero(self.order == order)[0])


def free_forces(plan: Layout, ratio: float | None = None, orders: Sequence[int] = ORDERS) -> FreeForces:
    """Return forces of the moving masses of a layout.

    ``ratio``: crank radius over rod; None: all A_n 1, the layout's share alone.
    """
    order = np.asarray(orders)
    size = np.ones(len(order), complex) if ratio is None else piston_harmonics(ratio, int(order.max()))[order - 1]
    axis = np.exp(1j * (plan.banks + 0.5 * np.pi))
    lead = order[:, None] * (plan.throws - plan.banks)
    forward = 0.5 * size[:, None] * np.exp(1j * lead) * axis
    backward = 0.5 * size.conj()[:, None] * np.exp(-1j * lead) * axis
    return _summed(order, forward, backward, plan.z)


def rotating_forces(plan: Layout) -> FreeForces:
    """Return forces of masses at the crank pins (the big ends and throws), one unit of m r w^2 each."""
    forward = 1j * np.exp(1j * plan.throws)[None, :]
    return _summed(np.array([1]), forward, np.zeros_like(forward), plan.z)


def _summed(order: np.ndarray, forward: np.ndarray, backward: np.ndarray, z: np.ndarray) -> FreeForces:
    """Return sums over (K, N) cylinders; k x F is F turned by a quarter."""
    return FreeForces(
        order,
        Turning(forward.sum(axis=1), backward.sum(axis=1)),
        Turning(1j * forward @ z, 1j * backward @ z),
    )


SAMPLES = 4096
"""Number of samples of a turn: coefficients fall as 1 / l to their order; these suffice up to r / (l - |e|) = 0.98."""
LONGEST = 0.98


def piston_harmonics(ratio: float, count: int = 8, offset: float = 0.0) -> np.ndarray:
    """Return (count,) complex A_n e^(i d_n) of orders 1 .. count, in units of r w^2.

    They are real where ``offset`` is 0. ``ratio``: crank radius over length of the rod, r / l. ``offset``: of the
    cylinder from the shaft over the crank radius, e / r, positive towards where the throw is at phi = 90 degrees.
    Raises ModelError for a rod that does not reach.
    """
    reach = ratio * (1.0 + abs(offset))
    if not (ratio >= 0.0 and reach <= LONGEST):
        raise ModelError(
            f"engine: the crank radius is {ratio:g} of the rod's length and the offset {offset:g} of the radius. "
            f"Together they must stay below {LONGEST:g} of the rod: use a longer rod"
        )
    phi = np.linspace(0.0, 2 * math.pi, SAMPLES, endpoint=False)
    # sqrt(1 - s^2) - 1 without the cancellation that small ratios would suffer from.
    s = ratio * (np.sin(phi) - offset)
    rod = -s / (1.0 + np.sqrt(1.0 - s**2)) * (np.sin(phi) - offset)
    order = np.arange(1, count + 1)
    return np.fft.rfft(np.cos(phi) + rod)[1 : count + 1] * (2.0 / SAMPLES) * order**2
