"""Normalised rises f(u) from 0 to 1 for u = 0 .. 1, with three derivatives.

    harmonic             (1 - cos pi u) / 2                         acceleration jumps at the ends
    cycloidal            u - sin(2 pi u) / (2 pi)
    3-4-5                10 u^3 - 15 u^4 + 6 u^5
    4-5-6-7              35 u^4 - 84 u^5 + 70 u^6 - 20 u^7          jerk starts at zero too
    modified_sine        quarter sines of period 1/2 at the ends, a half sine of period 3/2 between (Neklutin)
    modified_trapezoid   trapezoid of acceleration with its corners rounded by sines

The last two are made of arcs that join with a jump of jerk at INNER.

Source: Norton, Design of Machinery, ch. 8; Neklutin, Mechanisms and Cams for Automatic Machines, 1969.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

PI = math.pi


def _polynomial(*coefficients: float) -> Callable[[np.ndarray], np.ndarray]:
    law = np.polynomial.Polynomial(coefficients)
    return lambda u: np.stack([law(u), law.deriv(1)(u), law.deriv(2)(u), law.deriv(3)(u)], axis=1)


def _harmonic(u: np.ndarray) -> np.ndarray:
    s, c = np.sin(PI * u), np.cos(PI * u)
    return np.stack([(1 - c) / 2, PI * s / 2, PI**2 * c / 2, -(PI**3) * s / 2], axis=1)


def _cycloidal(u: np.ndarray) -> np.ndarray:
    s, c = np.sin(2 * PI * u), np.cos(2 * PI * u)
    return np.stack([u - s / (2 * PI), 1 - c, 2 * PI * s, 4 * PI**2 * c], axis=1)


def _mirrored(first_half: Callable[[np.ndarray], np.ndarray]) -> Callable[[np.ndarray], np.ndarray]:
    """A law that is point symmetric about its middle, from its first half."""

    def law(u: np.ndarray) -> np.ndarray:
        late = u > 0.5
        out = first_half(np.where(late, 1 - u, u))
        out[late] = [1, 0, 0, 0] + out[late] * [-1, 1, -1, 1]
        return out

    return law


def _modified_sine(u: np.ndarray) -> np.ndarray:
    k = 1 / (4 + PI)
    w = 4 * PI
    end = np.stack([k * (PI * u - np.sin(w * u) / 4), PI * k * (1 - np.cos(w * u)), PI * k * w * np.sin(w * u)], axis=1)
    end = np.column_stack([end, PI * k * w**2 * np.cos(w * u)])
    p = w * u / 3 - PI / 6
    a = PI * k * w
    middle = np.stack(
        [k * (2 + PI * u - 9 / 4 * np.cos(p)), PI * k * (1 + 3 * np.sin(p)), a * np.cos(p), -a * w / 3 * np.sin(p)],
        axis=1,
    )
    return np.where((u < 1 / 8)[:, None], end, middle)


def _modified_trapezoid(u: np.ndarray) -> np.ndarray:
    a, w = 8 * PI / (2 + PI), 4 * PI
    first = np.stack([(u - np.sin(w * u) / w) / w, (1 - np.cos(w * u)) / w, np.sin(w * u), w * np.cos(w * u)], axis=1)
    x = u - 1 / 8
    s1, v1 = (1 / 8 - 1 / w) / w, 1 / w
    second = np.stack([s1 + v1 * x + x**2 / 2, v1 + x, np.ones_like(u), np.zeros_like(u)], axis=1)
    x = u - 3 / 8
    s2, v2 = s1 + v1 / 4 + 1 / 32, v1 + 1 / 4
    third = np.stack(
        [s2 + v2 * x + (1 - np.cos(w * x)) / w**2, v2 + np.sin(w * x) / w, np.cos(w * x), -w * np.sin(w * x)], axis=1
    )
    return a * np.where((u < 1 / 8)[:, None], first, np.where((u < 3 / 8)[:, None], second, third))


RISES: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "harmonic": _harmonic,
    "cycloidal": _cycloidal,
    "3-4-5": _polynomial(0, 0, 0, 10, -15, 6),
    "4-5-6-7": _polynomial(0, 0, 0, 0, 35, -84, 70, -20),
    "modified_sine": _mirrored(_modified_sine),
    "modified_trapezoid": _mirrored(_modified_trapezoid),
}
"""By name: u (T,) to f, f', f'', f''' (T, 4)."""

INNER: dict[str, tuple[float, ...]] = {
    "modified_sine": (1 / 8, 7 / 8),
    "modified_trapezoid": (1 / 8, 3 / 8, 5 / 8, 7 / 8),
}
"""u where the arcs of a rise join; the other rises are one arc."""
