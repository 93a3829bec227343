"""Approach speeds of contacts by penalty at their beginnings, along a motion, for their damping.

A simulation notes it at each accepted step (mbsd/dynamics/prepare/prepared.py). A driven motion is known at its
outputs alone; there the depth between two outputs is the cubic through both with their rates, and the approach is its
slope where it begins to be above zero.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from mbsd.equations.interactions.switching import APPROACHED, REMEMBERS, SPEED_HERE, VALUE
from mbsd.equations.loads import Loads, tabulate_loads

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.equations.laws import Laws


def remembers(loads: Loads) -> bool:
    """Return True if any contact asks for the speed at which it began."""
    return bool(loads.switch[0, REMEMBERS])


def stretches(loads: Loads, approached: np.ndarray | None, count: int) -> Iterator[slice]:
    """Yield stretches of rows 0 .. ``count`` with equal approach (T, n) (m/s), set in ``loads`` meanwhile.

    With None it stays as it is.
    """
    if approached is None or not remembers(loads):
        yield slice(0, count)
        return
    own = loads.switch[1:, APPROACHED].copy()
    same = (approached[1:] == approached[:-1]) | (np.isnan(approached[1:]) & np.isnan(approached[:-1]))
    edges = [0, *(np.flatnonzero(~same.all(axis=1)) + 1).tolist(), count]
    try:
        for first, last in pairwise(edges):
            loads.switch[1:, APPROACHED] = approached[first]
            yield slice(first, last)
    finally:
        loads.switch[1:, APPROACHED] = own


def approached_along(
    packed: Packed, loads: Loads, laws: Laws, t: np.ndarray, q: np.ndarray, v: np.ndarray
) -> np.ndarray | None:
    """Return (T, n) approach speeds of all interactions (m/s) along a motion; None if none needs them.

    q, v (T, 3 nb) are given at times (T,).
    """
    if not remembers(loads):
        return None
    count, table = len(loads.switch) - 1, loads.switch
    depth, rate = np.zeros((2, len(t), count))
    for k in range(len(t)):
        at, load = slice(k, k + 1), np.zeros((1, q.shape[1]))
        tabulate_loads(packed.system, loads, laws, t[at], q[at], v[at], packed.ws, load, np.zeros(1))
        depth[k], rate[k] = table[1:, VALUE], table[1:, SPEED_HERE]
    packed.specials.check()
    out = np.full((len(t), count), np.nan)
    for c in range(count):
        for k in range(1, len(t)):
            inside = depth[k, c] > 0.0
            if not inside:
                continue
            if depth[k - 1, c] > 0.0:
                out[k, c] = out[k - 1, c]
            else:
                out[k, c] = _slope_at_zero(t[k] - t[k - 1], depth[k - 1 : k + 1, c], rate[k - 1 : k + 1, c])
    return out


def _slope_at_zero(h: float, depth: np.ndarray, rate: np.ndarray) -> float:
    """Return the slope at its zero of the cubic over h (s) through ``depth`` (2,) with ``rate`` (2,).

    The depth is below 0 at first and above 0 then.
    """
    rise, (a, b) = depth[1] - depth[0], h * rate
    cubic = np.polynomial.Polynomial([depth[0], a, 3 * rise - 2 * a - b, a + b - 2 * rise])
    roots = cubic.roots()
    real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > -1e-9) & (roots.real < 1 + 1e-9)]
    return float(cubic.deriv()(real.max() if len(real) else 1.0)) / h
