"""How accelerations change with coordinates and velocities: forward differences, for implicit methods.

    A = da/dq N(q),   B = da/dv,      q' = N(q) v,   a(t, q, v) with the multipliers eliminated

Loads of every kind, functions of the user too, and the turning of joints are in it. It costs two evaluations for each
coordinate, and full matrices; Newton's method needs no more than a few digits of it.
"""

from __future__ import annotations

from mbsd.compiling.jit import apart
from mbsd.dynamics.formulation import derivative, shift
from mbsd.dynamics.reference.arrays import Dynamics

ROOT = 1.5e-8
"""Square root of the rounding of doubles: the step of a difference, in sizes, rad, or parts of a velocity."""
MANY = 600
"""Coordinates beyond which full matrices are refused: one factorisation takes a tenth of a second there."""


def too_large(dynamics: Dynamics) -> str | None:
    """Return why an implicit method with full matrices cannot simulate this mechanism, or None."""
    count = len(dynamics.inertia) - 3
    if count <= MANY:
        return None
    return (
        f"{count // 3} bodies are too many for a method with full matrices (up to {MANY // 3}); "
        "take method='dop853', or 'scipy-lsoda' for stiff forces"
    )


@apart
def differentiate(dyn, scratch, t, y, a, trial, out):
    """Fill scratch.full.value[0] with A and [1] with B (n, n) at y (2, 3 nb), where the acceleration is a (3 nb,).

    ``trial`` and ``out`` (2, 3 nb) are scratch. Returns the number of evaluations.
    """
    n3 = y.shape[1]
    for part in range(2):
        for c in range(3, n3):
            trial[part, c] = y[part, c]
    for part in range(2):
        matrix = scratch.full.value[part]
        for c in range(3, n3):
            size = 1.0 / dyn.per_size[c]
            if part == 1 or c % 3 != 2:
                size = max(size, abs(y[part, c]))
            if part == 0:
                step = shift(dyn, y[0], c, ROOT * size, trial[0])
            else:
                trial[1, c] = y[1, c] + ROOT * size
                step = trial[1, c] - y[1, c]
            derivative(dyn, scratch, t, trial, out, scratch.ws.right[1])
            for i in range(3, n3):
                trial[part, i] = y[part, i]
            for r in range(3, n3):
                matrix[r - 3, c - 3] = (out[1, r] - a[r]) / step
    return 2 * (n3 - 3)
