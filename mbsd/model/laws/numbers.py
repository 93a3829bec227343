"""Laws as numbers that kernels evaluate; the forms are those of mbsd/equations/laws.py."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.base.codes import PERIODIC, PIECES, POLYNOMIAL, TANGENT

Compiled = tuple[int, np.ndarray]
"""Code and numbers of one law."""


ZERO: Compiled = (POLYNOMIAL, np.zeros(1))


def pieces(breaks: np.ndarray, coefficients: np.ndarray, periodic: bool = False) -> Compiled:
    """Piecewise polynomials: breaks (p + 1,), coefficients (p, 6), lowest power of x - break first."""
    rows = np.column_stack([breaks[:-1], coefficients])
    return PIECES, np.concatenate([[len(rows), PERIODIC if periodic else TANGENT, breaks[-1]], rows.ravel()])


def breaks_of(law: Compiled) -> np.ndarray:
    """(p + 1,) rising breaks of pieces; none of another law."""
    kind, numbers = law
    return np.append(numbers[3::7], numbers[2]) if kind == PIECES else np.zeros(0)


def hermite_coefficients(h: np.ndarray, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return (p, ..., 6) quintics over widths h (p,), from values and derivatives at both ends.

    ``left`` and ``right`` (p, ..., 3) are value, first and second derivative. Coefficients go from the lowest power up.
    """
    h = h.reshape(-1, *[1] * (left.ndim - 2))
    f, df, ddf = np.moveaxis(left, -1, 0)
    rise = right[..., 0] - f - h * df - h**2 * ddf / 2
    return quintic_coefficients(h, left, rise, (right[..., 1] - df - h * ddf) * h, (right[..., 2] - ddf) * h**2)


def quintic_coefficients(
    h: np.ndarray, left: np.ndarray, rise: np.ndarray, slope: np.ndarray, bend: np.ndarray
) -> np.ndarray:
    """Return (p, ..., 6) coefficients from the right ends' differences from the parabola at the left.

    The differences are those of f, h f' and h^2 f'', each (p, ...).
    """
    c3, c4, c5 = 10 * rise - 4 * slope + bend / 2, -15 * rise + 7 * slope - bend, 6 * rise - 3 * slope + bend / 2
    f, df, ddf = np.moveaxis(left, -1, 0)
    return np.stack([f, df, ddf / 2, c3 / h**3, c4 / h**4, c5 / h**5], axis=-1)


def polynomial_pieces(poly: Any, periodic: bool = False) -> Compiled:
    """Return a scipy PPoly of degree 5 or less, without its pieces of no width."""
    wide = np.flatnonzero(np.diff(poly.x) > 0)
    coefficients = np.zeros((len(wide), 6))
    coefficients[:, : len(poly.c)] = poly.c[::-1, wide].T
    return pieces(np.append(poly.x[wide], poly.x[wide[-1] + 1]), coefficients, periodic)


def spline_pieces(spline: Any, periodic: bool = False) -> Compiled:
    """Return a scipy BSpline of degree 5 or less, piece by piece."""
    from scipy.interpolate import PPoly

    return polynomial_pieces(PPoly.from_spline(spline), periodic)


def evaluated(law: Compiled, x: np.ndarray) -> np.ndarray:
    """Return (T, 3) value and two derivatives of pieces or a polynomial at x (T,), bit for bit as kernels."""
    kind, numbers = law
    assert kind in (PIECES, POLYNOMIAL), "other laws evaluate themselves"
    beyond = np.zeros(len(x))
    if kind == POLYNOMIAL:
        s, rows = x, np.broadcast_to(numbers, (len(x), len(numbers)))
    else:
        begin, end = numbers[3], numbers[2]
        if numbers[1] == PERIODIC:
            x = begin + (x - begin) % (end - begin)
        inside = np.clip(x, begin, end)
        beyond = x - inside
        table = numbers[3:].reshape(-1, 7)
        at = np.maximum(np.searchsorted(table[:, 0], inside, side="right") - 1, 0)
        s, rows = inside - table[at, 0], table[at, 1:]
    value, slope, bend = np.zeros((3, len(x)))
    for c in range(rows.shape[1] - 1, -1, -1):
        bend = bend * s + 2.0 * slope
        slope = slope * s + value
        value = value * s + rows[:, c]
    return np.column_stack([value + slope * beyond, slope, np.where(beyond == 0.0, bend, 0.0)])
