"""Slopes of the equations by time alone, q and v held: by a five-point stencil of times at each node.

    u = (q', v') of the motion solves   u' = A u + df/dt        of  v' = f(t, q, v)

It tells the error of a step (linear_motion.py). A step is as long as the motion lets it be, so times a small part of it
away give df/dt to many digits. The part is larger for short steps, where t itself leaves few digits.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.derivatives.free.linear_motion import NODES

STENCILS = {0: (-2, -1, 0, 1, 2), 2: (0, 1, 2, 3, 4), -2: (-4, -3, -2, -1, 0)}
"""Places of the times about a node inside, at the start, and at the end of a stretch, by how far they are shifted."""
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
class Stencil:
    """Five times at each of T times, and the weights of values there in the slope by time."""

    times: np.ndarray
    """(5, T) s."""
    weights: np.ndarray
    """(5, T) 1/s."""
    passing: np.ndarray
    """(T,) True where the motion passes a toggle."""

    def sliced(self, at: slice) -> Stencil:
        """Return the stencil of some of the times."""
        return Stencil(self.times[:, at], self.weights[:, at], self.passing[at])


def stencil_at(t: np.ndarray, nodes: np.ndarray, passing: np.ndarray) -> Stencil:
    """Return the stencil of times t (T,) (s) of a stretch, within its first and its last.

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
    return Stencil(times, weights, passing)


def find_toggles(t: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Return (T,) True where accelerations a (T, n) at times t (s) are those of a toggle, if any are."""
    size = np.linalg.norm(a, axis=1)
    mean = np.trapezoid(size, t) / (t[-1] - t[0])
    return (size > ABOVE * mean) & (size.max(initial=0.0) > SUDDEN * mean)
