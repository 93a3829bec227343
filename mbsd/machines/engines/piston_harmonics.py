"""Harmonics of the inertia force of a piston.

    x = r cos phi + sqrt(l^2 - (r sin phi - e)^2)            from the shaft, phi from the cylinder's axis
    -x'' = r w^2 sum_n A_n cos(n phi + d_n)                  at constant speed w

With e = 0 all d_n are 0, A_1 = 1 and only even orders follow: A_2 = L + L^3/4 + 15 L^5/128 + ..., A_4 = -(L^3/4 +
3 L^5/16 + ...) with L = r / l. The series is summed to rounding by the trapezoidal rule, which is exact for what is
periodic and analytic. An offset e of the wrist pin or cylinder adds odd orders and phases.

Source: Biezeno, Grammel, Technische Dynamik, ch. XII (exact coefficients).
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.base.errors import ModelError

SAMPLES = 4096
"""Number of samples of a turn: coefficients fall as 1 / l to their order; these suffice up to r / (l - |e|) = 0.98."""
LONGEST = 0.98


def piston_harmonics(ratio: float, count: int = 8, offset: float = 0.0) -> np.ndarray:
    """(count,) complex A_n e^(i d_n) of orders 1 .. count, in units of r w^2; real where ``offset`` is 0.

    ``ratio``: crank radius over length of the rod, r / l. ``offset``: of the cylinder from the shaft over the crank
    radius, e / r, positive towards where the throw is at phi = 90 degrees. Raises ModelError for a rod that does not
    reach.
    """
    reach = ratio * (1.0 + abs(offset))
    if not (ratio >= 0.0 and reach <= LONGEST):
        raise ModelError(
            f"engine: the crank radius is {ratio:g} of the rod's length and the offset {offset:g} of the radius; "
            f"radius and offset together must stay below {LONGEST:g} of the rod, so take a longer one"
        )
    phi = np.linspace(0.0, 2 * math.pi, SAMPLES, endpoint=False)
    # sqrt(1 - s^2) - 1 without the cancellation that small ratios would suffer from.
    s = ratio * (np.sin(phi) - offset)
    rod = -s / (1.0 + np.sqrt(1.0 - s**2)) * (np.sin(phi) - offset)
    order = np.arange(1, count + 1)
    return np.fft.rfft(np.cos(phi) + rod)[1 : count + 1] * (2.0 / SAMPLES) * order**2
