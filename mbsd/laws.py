"""Functions of one variable that kernels can evaluate: driver laws of time, characteristic curves of length or speed.

    POLYNOMIAL   c0 + c1 x + c2 x^2 + ...
    HARMONIC     mean + amplitude sin(rate x + phase)
    CYCLOIDAL    start + rise (u - sin(2 pi u) / 2 pi),  u = (x - begin) / duration within 0 .. 1
    PIECES       quintic pieces between rising breaks; beyond the ends along the tangent, or repeated

Every law gives value, first and second derivative. All numbers of all laws stand in one buffer.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mbsd.jit import inlined, kernel

POLYNOMIAL, HARMONIC, CYCLOIDAL, PIECES = 0, 1, 2, 3
TANGENT, PERIODIC = 0.0, 1.0
"""What pieces do beyond their breaks."""


class Laws(NamedTuple):
    """Laws as arrays; law 0 is the constant zero."""

    kind: Any
    """(n,) one of the codes above."""
    first: Any
    """(n + 1,) where the numbers of each law begin."""
    numbers: Any
    """All numbers."""


Compiled = tuple[int, np.ndarray]
"""Code and numbers of one law."""

ZERO: Compiled = (POLYNOMIAL, np.zeros(1))


def pack_laws(laws: Sequence[Compiled]) -> Laws:
    """One table of laws; the constant zero is put before them."""
    everything = [ZERO, *laws]
    sizes = [len(numbers) for _, numbers in everything]
    return Laws(
        np.array([kind for kind, _ in everything], np.int64),
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
        np.concatenate([np.asarray(numbers, float) for _, numbers in everything]),
    )


def pieces(breaks: np.ndarray, coefficients: np.ndarray, periodic: bool = False) -> Compiled:
    """Piecewise polynomials: breaks (p + 1,), coefficients (p, 6), lowest power of x - break first."""
    rows = np.column_stack([breaks[:-1], coefficients])
    return PIECES, np.concatenate([[len(rows), PERIODIC if periodic else TANGENT, breaks[-1]], rows.ravel()])


def breaks_of(law: Compiled) -> np.ndarray:
    """(p + 1,) rising breaks of pieces; none of another law."""
    kind, numbers = law
    return np.append(numbers[3::7], numbers[2]) if kind == PIECES else np.zeros(0)


def hermite_pieces(x: np.ndarray, samples: np.ndarray, periodic: bool = False) -> Compiled:
    """The quintic through value, first and second derivative, samples (p + 1, 3), at rising x (p + 1,)."""
    return pieces(x, hermite_coefficients(np.diff(x), samples[:-1], samples[1:]), periodic)


def hermite_coefficients(h: np.ndarray, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """(p, 6) quintics over widths h (p,) from value and two derivatives (p, 3) at both ends, lowest power first."""
    f, df, ddf = left.T
    rise = right[:, 0] - f - h * df - h**2 * ddf / 2
    return quintic_coefficients(h, left, rise, (right[:, 1] - df - h * ddf) * h, (right[:, 2] - ddf) * h**2)


def quintic_coefficients(
    h: np.ndarray, left: np.ndarray, rise: np.ndarray, slope: np.ndarray, bend: np.ndarray
) -> np.ndarray:
    """(p, 6) from what the right ends have beyond the parabola at the left: f, h f' and h^2 f'', each (p,)."""
    c3, c4, c5 = 10 * rise - 4 * slope + bend / 2, -15 * rise + 7 * slope - bend, 6 * rise - 3 * slope + bend / 2
    f, df, ddf = left.T
    return np.column_stack([f, df, ddf / 2, c3 / h**3, c4 / h**4, c5 / h**5])


def spline_pieces(spline: Any, periodic: bool = False) -> Compiled:
    """A scipy BSpline of degree 5 or less, piece by piece."""
    from scipy.interpolate import PPoly

    poly = PPoly.from_spline(spline)
    long_enough = np.flatnonzero(np.diff(poly.x) > 0)
    coefficients = np.zeros((len(long_enough), 6))
    coefficients[:, : len(poly.c)] = poly.c[::-1, long_enough].T
    breaks = np.append(poly.x[long_enough], poly.x[long_enough[-1] + 1])
    return pieces(breaks, coefficients, periodic)


@inlined
def evaluate_law(laws, k, x, out):
    """Fill out (3,): value, first and second derivative of law k at x."""
    kind = laws.kind[k]
    at = laws.first[k]
    numbers = laws.numbers
    if kind == POLYNOMIAL:
        value = 0.0
        slope = 0.0
        bend = 0.0
        for c in range(laws.first[k + 1] - 1, at - 1, -1):
            bend = bend * x + 2.0 * slope
            slope = slope * x + value
            value = value * x + numbers[c]
        out[0] = value
        out[1] = slope
        out[2] = bend
    elif kind == HARMONIC:
        amplitude = numbers[at]
        rate = numbers[at + 1]
        sine = math.sin(rate * x + numbers[at + 2])
        out[0] = numbers[at + 3] + amplitude * sine
        out[1] = amplitude * rate * math.cos(rate * x + numbers[at + 2])
        out[2] = -amplitude * rate * rate * sine
    elif kind == CYCLOIDAL:
        rise = numbers[at]
        duration = numbers[at + 1]
        u = min(max((x - numbers[at + 2]) / duration, 0.0), 1.0)
        turn = 2.0 * math.pi * u
        out[0] = numbers[at + 3] + rise * (u - math.sin(turn) / (2.0 * math.pi))
        out[1] = rise / duration * (1.0 - math.cos(turn))
        out[2] = rise / (duration * duration) * 2.0 * math.pi * math.sin(turn)
    else:
        _evaluate_pieces(laws, at, x, out)


@kernel
def _evaluate_pieces(laws, at, x, out):
    numbers = laws.numbers
    count = int(numbers[at])
    begin = numbers[at + 3]
    end = numbers[at + 2]
    if numbers[at + 1] == PERIODIC:
        x = begin + (x - begin) % (end - begin)
    beyond = 0.0
    if x > end:
        beyond = x - end
        x = end
    elif x < begin:
        beyond = x - begin
        x = begin
    low = 0
    high = count
    while high - low > 1:
        middle = (low + high) // 2
        if numbers[at + 3 + 7 * middle] <= x:
            low = middle
        else:
            high = middle
    row = at + 3 + 7 * low
    s = x - numbers[row]
    value = 0.0
    slope = 0.0
    bend = 0.0
    for c in range(row + 6, row, -1):
        bend = bend * s + 2.0 * slope
        slope = slope * s + value
        value = value * s + numbers[c]
    out[0] = value + slope * beyond
    out[1] = slope
    out[2] = bend if beyond == 0.0 else 0.0


@inlined
def evaluate_laws(laws, count, x, out):
    """Rows 0 .. count-1 of out (count, 3) at x: the drivers' laws, which come first; row 0 is zero."""
    for k in range(1, count):
        evaluate_law(laws, k, x, out[k])


@kernel
def tabulate_law(laws, k, x, out):
    """Law k at x (T,) into out (T, 3), for callers outside the compiled loops."""
    for row in range(x.shape[0]):
        evaluate_law(laws, k, x[row], out[row])
