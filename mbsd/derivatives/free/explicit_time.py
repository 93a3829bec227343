"""How equations change with time itself, all else held: by differences between moments beside each node.

    u = (q', v') of the motion solves   u' = A u + df/dt        of  v' = f(t, q, v)

It says what steps err (linear_motion.py). A step is as long as the motion lets it be, so that moments a small part of
it away tell df/dt to many digits: the part is larger for short steps, of which times themselves leave few digits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.derivatives.free.linear_motion import NODES

STENCILS = {0: (-2, -1, 0, 1, 2), 2: (0, 1, 2, 3, 4), -2: (-4, -3, -2, -1, 0)}
"""Moments beside a node inside, at the start, and at the end of a stretch, by how far they are shifted."""
WEIGHTS = {
    0: np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0,
    2: np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0,
    -2: np.array([3.0, -16.0, 36.0, -48.0, 25.0]) / 12.0,
}
"""Weights of their values in the slope, for a distance of 1 between them."""
SUDDEN = 100.0
"""Largest acceleration, as part of the mean, beyond which a motion is taken to pass a toggle."""
ABOVE = 3.0
"""Accelerations that belong to the toggle then, as part of the mean."""


@dataclass
class Beside:
    """Moments beside T times."""

    times: np.ndarray
    """(5, T) s."""
    weights: np.ndarray
    """(5, T) 1/s, of values there in their slope by time."""
    passing: np.ndarray
    """(T,) whether the motion passes a toggle."""

    def sliced(self, at: slice) -> Beside:
        """Return the moments beside some of the times."""
        return Beside(self.times[:, at], self.weights[:, at], self.passing[at])


def moments_beside(t: np.ndarray, nodes: np.ndarray, passing: np.ndarray) -> Beside:
    """Return moments beside times t (T,) (s) of a stretch, none before its first or after its last.

    ``nodes`` (8 d + 1,) are the nodes of its steps among them (s).
    """
    edges = nodes[::NODES]
    step = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, len(edges) - 2)
    length = np.diff(edges)[step]
    rounding = float(np.spacing(np.abs(t).max()))
    apart = np.maximum(np.rint(length * (rounding / length) ** 0.2 / rounding), 1.0) * rounding
    shift = np.where(t - t[0] < 2.0 * apart, 2, np.where(t[-1] - t < 2.0 * apart, -2, 0))
    times, weights = np.empty((2, 5, len(t)))
    for kind, places in STENCILS.items():
        at = shift == kind
        times[:, at] = t[at] + np.array(places)[:, None] * apart[at]
        weights[:, at] = WEIGHTS[kind][:, None] / apart[at]
    return Beside(times, weights, passing)


def find_toggles(t: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Return at which times t (T,) (s) accelerations a (T, n) are those of a toggle: nowhere if none are sudden."""
    size = np.linalg.norm(a, axis=1)
    mean = np.trapezoid(size, t) / (t[-1] - t[0])
    return (size > ABOVE * mean) & (size.max(initial=0.0) > SUDDEN * mean)
