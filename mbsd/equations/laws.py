"""Functions of one variable for kernels: laws of time, characteristic curves of length or speed.

    POLYNOMIAL   c0 + c1 x + c2 x^2 + ...
    HARMONIC     mean + amplitude sin(rate x + phase)
    CYCLOIDAL    start + rise (u - sin(2 pi u) / 2 pi),  u = (x - begin) / duration within 0 .. 1
    PIECES       quintic pieces between rising breaks; beyond the ends along the tangent, or repeated

Every law gives value, first and second derivative. All numbers of all laws stand in one buffer.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from mbsd.base.codes import CYCLOIDAL, HARMONIC, PERIODIC, POLYNOMIAL
from mbsd.compiling.jit import inlined, kernel, lazy


class Laws(NamedTuple):
    """Laws as arrays; law 0 is the constant zero."""

    kind: Any
    """(n,) one of the codes above."""
    first: Any
    """(n + 1,) where the numbers of each law begin."""
    numbers: Any
    """All numbers."""


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


@lazy(None)
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


@lazy(None)
def law_at(laws, k, x, out):
    """Call evaluate_law as a function of its own."""
    evaluate_law(laws, k, x, out)


@lazy(None)
def evaluate_laws(laws, count, x, out):
    """Fill out (count, 3) with the first laws, those of drivers, at x; row 0 stays zero."""
    for k in range(1, count):
        evaluate_law(laws, k, x, out[k])


@kernel
def tabulate_law(laws, k, x, out):
    """Fill out (T, 3) with law k at x (T,), for callers in Python."""
    for row in range(x.shape[0]):
        evaluate_law(laws, k, x[row], out[row])
