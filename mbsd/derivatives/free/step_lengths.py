"""Compiled: how long steps of tangents may be where a motion bends more or less.

Through five even times goes a polynomial of degree 4. Its second and fourth Legendre coefficients tell how fast they
fall, and so how large the eighth would be in a longer step.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel

EVEN = 4
"""Gaps of five even times."""


@kernel
def fill_lengths(t, motion, per, evenly, smooth, bounds, step, out):
    """Fill out (L - 1,) (s) with lengths of steps between times t (L,) of a motion (L, k), in parts 1 / per (k,).

    evenly (2, 5): what makes both coefficients of five values; smooth: what the eighth may be; bounds (3,): the least,
    the usual and the largest length (s); step (L - 4,) is scratch.
    """
    windows = step.shape[0]
    for w in range(windows):
        second = 0.0
        fourth = 0.0
        for c in range(motion.shape[1]):
            low = 0.0
            high = 0.0
            for n in range(EVEN + 1):
                low += evenly[0, n] * motion[w + n, c]
                high += evenly[1, n] * motion[w + n, c]
            second = max(second, abs(low) * per[c])
            fourth = max(fourth, abs(high) * per[c])
        widest = t[w + 1] - t[w]
        narrowest = widest
        for n in range(1, EVEN):
            gap = t[w + n + 1] - t[w + n]
            widest = max(widest, gap)
            narrowest = min(narrowest, gap)
        if widest - narrowest <= 1e-6 * widest and narrowest > 0.0:
            fall = min(fourth / max(second, 1e-300), 1.0)
            step[w] = (t[w + EVEN] - t[w]) * (smooth / max(fourth * fall * fall, 1e-300)) ** (1.0 / 9.0)
        else:
            step[w] = bounds[1]
    for g in range(out.shape[0]):
        least = bounds[2]
        for n in range(EVEN):
            least = min(least, step[min(max(g - n, 0), windows - 1)])
        out[g] = max(least, bounds[0])
