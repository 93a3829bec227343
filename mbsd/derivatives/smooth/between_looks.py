"""A smooth motion between the times at which it was looked at: the polynomial of degree 8 through three of them.

Each look gives q, q' and q''. Newton's divided differences with every look taken three times, evaluated with their
first two derivatives: q'' tells how well the polynomial follows the motion, since the equations give it as well.
Source: Stoer, Bulirsch, Introduction to Numerical Analysis, 2.1.5 (Hermite interpolation).
"""

from __future__ import annotations

import numpy as np

from mbsd.compiling.jit import internal, kernel

LOOKS = 3
TIMES = 3
"""Values that each look gives."""
ORDERS = LOOKS * TIMES


def between_looks(
    t: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray, times: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, v, a (R, n) at times (R,) (s), within the rising looks t (T,) at which they are (T, n); T is at least 3."""
    first = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    nearer = times - t[first] > t[first + 1] - times  # the third look is the one beyond the nearer end
    first = np.clip(np.where(nearer, first, first - 1), 0, len(t) - LOOKS)
    value, slope, bend = np.zeros((3, len(times), q.shape[1]))
    interpolate(t, q, v, a, times, first, np.zeros((ORDERS + 2, ORDERS)), np.zeros((3, LOOKS)), value, slope, bend)
    return value, slope, bend


@internal
def divide(per, given, column):
    """Make ``column`` (9,) divided differences of order 0 .. 8; ``given`` (3, 3): values, slopes, bends / 2.

    per (9, 9) is 1 / (x[k] - x[k - order]) by order and k, 0 where the two are one look.
    """
    for k in range(ORDERS):
        column[k] = given[0, k // TIMES]
    for order in range(1, ORDERS):
        for k in range(ORDERS - 1, order - 1, -1):
            if per[order, k] == 0.0:  # one look alone: a derivative by its factorial
                column[k] = given[order, k // TIMES]
            else:
                column[k] = (column[k] - column[k - 1]) * per[order, k]


@kernel
def interpolate(t, q, v, a, times, first, table, given, value, slope, bend):
    """Fill value, slope, bend (R, n) from looks ``first`` (R,) on; table (11, 9) and given (3, 3) are scratch."""
    x = table[ORDERS]
    column = table[ORDERS + 1]
    for r in range(times.shape[0]):
        at = first[r]
        span = t[at + LOOKS - 1] - t[at]
        for k in range(ORDERS):
            x[k] = (t[at + k // TIMES] - t[at]) / span
        for order in range(1, ORDERS):
            for k in range(order, ORDERS):
                table[order, k] = 0.0 if (k - order) // TIMES == k // TIMES else 1.0 / (x[k] - x[k - order])
        here = (times[r] - t[at]) / span
        for c in range(q.shape[1]):
            for look in range(LOOKS):
                given[0, look] = q[at + look, c]
                given[1, look] = v[at + look, c] * span
                given[2, look] = 0.5 * a[at + look, c] * span * span
            divide(table, given, column)
            p = 0.0
            dp = 0.0
            ddp = 0.0
            for k in range(ORDERS - 1, -1, -1):
                away = here - x[k]
                ddp = ddp * away + 2.0 * dp
                dp = dp * away + p
                p = p * away + column[k]
            value[r, c] = p
            slope[r, c] = dp / span
            bend[r, c] = ddp / (span * span)
