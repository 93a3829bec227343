"""The sums over stages of DOP853: the state of a stage, and the end of a step with its error.

Three columns go at once, because a sum waits for its last addition and six of them do not wait for one another; the
order of each sum stays.
"""

from __future__ import annotations

import math

from mbsd.compiling.jit import inlined
from mbsd.dynamics.integrators.dop853.tableau import E3, E5, A, B
from mbsd.dynamics.integrators.step_size import allowed

FEW = 9
"""Columns of a state below which it is summed entry by entry, coefficients that are zero too."""


@inlined
def sum_stages(y, k, s, h, trial):
    """Find the state of stage s from the derivatives k of those before it."""
    n3 = y.shape[1]
    if n3 < FEW:  # sums stay in registers
        for c in range(3, n3):
            rise = 0.0
            gain = 0.0
            for j in range(s):
                rise += A[s, j] * k[j, 0, c]
                gain += A[s, j] * k[j, 1, c]
            trial[0, c] = y[0, c] + h * rise
            trial[1, c] = y[1, c] + h * gain
        return
    c = 3
    while c + 3 <= n3:
        rise0 = A[s, 0] * k[0, 0, c]
        rise1 = A[s, 0] * k[0, 0, c + 1]
        rise2 = A[s, 0] * k[0, 0, c + 2]
        gain0 = A[s, 0] * k[0, 1, c]
        gain1 = A[s, 0] * k[0, 1, c + 1]
        gain2 = A[s, 0] * k[0, 1, c + 2]
        for j in range(1, s):
            factor = A[s, j]
            if factor != 0.0:
                rise0 += factor * k[j, 0, c]
                rise1 += factor * k[j, 0, c + 1]
                rise2 += factor * k[j, 0, c + 2]
                gain0 += factor * k[j, 1, c]
                gain1 += factor * k[j, 1, c + 1]
                gain2 += factor * k[j, 1, c + 2]
        trial[0, c] = y[0, c] + h * rise0
        trial[0, c + 1] = y[0, c + 1] + h * rise1
        trial[0, c + 2] = y[0, c + 2] + h * rise2
        trial[1, c] = y[1, c] + h * gain0
        trial[1, c + 1] = y[1, c + 1] + h * gain1
        trial[1, c + 2] = y[1, c + 2] + h * gain2
        c += 3
    while c < n3:
        rise = A[s, 0] * k[0, 0, c]
        gain = A[s, 0] * k[0, 1, c]
        for j in range(1, s):
            factor = A[s, j]
            if factor != 0.0:
                rise += factor * k[j, 0, c]
                gain += factor * k[j, 1, c]
        trial[0, c] = y[0, c] + h * rise
        trial[1, c] = y[1, c] + h * gain
        c += 1


@inlined
def sum_step(y, k, h, settings, trial):
    """Find the state at the end of a step; returns its error relative to what is allowed."""
    n3 = y.shape[1]
    fifth = 0.0
    third = 0.0
    for part in range(2):
        for c in range(3, n3):
            change = 0.0
            e5 = 0.0
            e3 = 0.0
            for j in range(12):
                change += B[j] * k[j, part, c]
                e5 += E5[j] * k[j, part, c]
                e3 += E3[j] * k[j, part, c]
            trial[part, c] = y[part, c] + h * change
            scale = allowed(settings, y, trial, part, c)
            fifth += (e5 / scale) ** 2
            third += (e3 / scale) ** 2
    both = (fifth + 0.01 * third) * max(2 * (n3 - 3), 1)
    return h * fifth / math.sqrt(both) if both > 0.0 else 0.0  # squares of what rests may be too small for a number
