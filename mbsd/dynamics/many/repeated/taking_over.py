"""Rows that hold once an event has released those that they repeat."""

from __future__ import annotations

import math

from mbsd.compiling.jit import internal, lazy
from mbsd.dynamics.many.repeated.arrays import FOLLOWS, HELD
from mbsd.dynamics.many.repeated.exchange import find_rows, hold_independent


@internal
def _adds(repeated, i, count):
    """Whether row i of jac adds something to the ``count`` rows of order[0]; then it becomes what it adds, of length 1.

    Gram-Schmidt, done twice for rounding.
    """
    jac = repeated.jac
    columns = jac.shape[1]
    for turn in range(3):
        length = 0.0
        for c in range(columns):
            length += jac[i, c] * jac[i, c]
        length = math.sqrt(length)
        if not length > (repeated.clock[FOLLOWS] if turn > 0 else 0.0):
            return False
        if turn != 1:
            for c in range(columns):
                jac[i, c] /= length
        if turn == 2:
            break
        for n in range(count):
            other = repeated.order[0, n]
            part = 0.0
            for c in range(columns):
                part += jac[i, c] * jac[other, c]
            for c in range(columns):
                jac[i, c] -= part * jac[other, c]
    return True


@lazy(None)
def take_over(dyn, scratch, repeated, t, q):
    """Hold the rows at q (3 nb,) and t (s) that do not follow from those that hold; jac is overwritten."""
    find_rows(dyn, scratch, repeated, t, q)
    count = 0
    for spare in range(2):
        for i in range(repeated.place.shape[0]):
            if repeated.number[i, HELD] == 1.0 - spare and _adds(repeated, i, count):
                repeated.order[0, count] = i
                count += 1
                repeated.number[i, HELD] = 2.0
    for i in range(repeated.place.shape[0]):
        if repeated.number[i, HELD] == 2.0:
            repeated.number[i, HELD] = 1.0
    hold_independent(dyn, repeated)
