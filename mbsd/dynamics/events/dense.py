"""The motion within one step: the quintic through coordinates, velocities and accelerations of both ends.

    x = t / h:   q = q0 + x (h v0) + x^2 (h^2 a0 / 2) + x^3 c3 + x^4 c4 + x^5 c5

It only shows where to look for an event; the event itself is found by integrating to it.
Source: Hairer, Norsett, Wanner, Solving ODEs I, II.6 (Hermite interpolation).
"""

from __future__ import annotations

import numpy as np

from mbsd.dynamics.state import TIME, State


class Quintic:
    """Between two states with valid derivatives."""

    def __init__(self, before: State, after: State) -> None:
        self.start = float(before.clock[TIME])
        self.length = h = float(after.clock[TIME]) - self.start
        q0, v0, a0 = before.y[0], h * before.y[1], h * h * before.dy[1]
        q1, v1, a1 = after.y[0], h * after.y[1], h * h * after.dy[1]
        rise, slope, bend = q1 - q0 - v0 - a0 / 2, v1 - v0 - a0, a1 - a0
        c3 = 10 * rise - 4 * slope + bend / 2
        c4 = -15 * rise + 7 * slope - bend
        c5 = 6 * rise - 3 * slope + bend / 2
        self.coefficients = np.stack([q0, v0, a0 / 2, c3, c4, c5])

    def times(self, x: np.ndarray) -> np.ndarray:
        """(S,) s, of parts x (S,) of the step."""
        return self.start + self.length * x

    def at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities (S, 3 nb)."""
        powers = x[:, None] ** np.arange(6)
        slopes = np.arange(1, 6) * x[:, None] ** np.arange(5)
        return powers @ self.coefficients, slopes @ self.coefficients[1:] / self.length
