"""Compiled residuals of the equations of motion along states beside a known motion.

Accelerations and lam are held.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel


@kernel
def leave(row_body, first, inertia, weight, drives, compact, v, a, lam, velocity, acceleration, load):
    """Fill velocity (S, m) with J v - nu, change gamma to J a - gamma, and finish load (S, 3 nb).

    gamma is in ``acceleration``.

    ``load`` has the forces: m g - M a - J^T lam are added. drives, a and lam are (T, ...), and S states v (S, 3 nb)
    with compact J (S, m, 6) are T of one kind after the other. ``first`` is the row of the first driver.
    """
    times = a.shape[0]
    for s in range(v.shape[0]):
        k = s % times
        for c in range(load.shape[1]):
            load[s, c] += weight[c] - inertia[c] * a[k, c]
        for r in range(row_body.shape[0]):
            rate = 0.0
            bend = 0.0
            push = lam[k, r]
            for side in range(2):
                at = 3 * row_body[r, side]
                for c in range(3):
                    entry = compact[s, r, 3 * side + c]
                    if at > 0:
                        rate += entry * v[s, at + c]
                        bend += entry * a[k, at + c]
                    load[s, at + c] -= entry * push
            velocity[s, r] = rate
            acceleration[s, r] = bend - acceleration[s, r]
        for d in range(1, drives.shape[1]):
            velocity[s, first + d - 1] -= drives[k, d, 1]
