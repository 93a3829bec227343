"""When the cylinders fire: angles of the shaft, and the intervals between them.

A piston is at its top dead centre when shaft angle = bank - throw; a four-stroke engine fires at every second of these,
a two-stroke engine at each. A firing order decides at which, because each cylinder fires at its first top dead centre
after the one before it in the order has fired.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.machines.engines.layout import Layout

TURN = 2 * math.pi
SAME = 1e-9
"""Angles nearer than this are one (rad)."""
MOST_TRIED = 17
"""Cylinders beside the first for which all turns are tried."""


@dataclass(frozen=True, eq=False)
class Firing:
    """The order and the shaft's angles."""

    order: tuple[int, ...]
    """Numbers of the cylinders, from 1."""
    angles: np.ndarray
    """(N,) at which they fire, in that order, from 0 on (rad)."""
    cycle: float
    """Angle after which they fire again: two turns of a four-stroke engine, one of a two-stroke engine (rad)."""

    @property
    def intervals(self) -> np.ndarray:
        """(N,) from each firing to the next, the last to the first of the next cycle (rad)."""
        return np.diff(np.append(self.angles, self.angles[0] + self.cycle))

    @property
    def even(self) -> bool:
        """True if all intervals are equal."""
        return bool(np.ptp(self.intervals) < 1e-6)


def firing(plan: Layout, order: Sequence[int] | None = None, strokes: int = 4) -> Firing:
    """Return the firing of an engine in a given order, or in the order that fires most evenly.

    Raises ModelError for an order that is no permutation of the cylinders' numbers, or that the throws do not allow,
    and for strokes other than 2 and 4.
    """
    if strokes not in (2, 4):
        raise ModelError(f"engine '{plan.name}': {strokes} strokes; an engine has 2 or 4")
    cycle = TURN * strokes / 2
    tops = (plan.banks - plan.throws) % TURN
    tops[TURN - tops < SAME] = 0.0
    if order is None:
        return _most_even(tops, cycle, plan.z, plan.name)
    numbers = tuple(order)
    if sorted(numbers) != list(range(1, len(tops) + 1)):
        raise ModelError(
            f"engine '{plan.name}': the firing order {'-'.join(map(str, numbers))} is no permutation of the cylinders "
            f"1 .. {len(tops)}; name each of them once"
        )
    angles = [float(tops[numbers[0] - 1])]
    for number in numbers[1:]:
        gap = (tops[number - 1] - angles[-1]) % TURN
        angles.append(angles[-1] + (0.0 if TURN - gap < SAME else gap))
    span = angles[-1] - angles[0]
    if span > cycle - SAME:
        raise ModelError(
            f"engine '{plan.name}': the firing order {'-'.join(map(str, numbers))} takes {math.degrees(span):.4g} "
            f"degrees of the shaft, but a cycle has {math.degrees(cycle):g}; these throws fire, as evenly as they can, "
            f"{'-'.join(map(str, _most_even(tops, cycle, plan.z).order))}"
        )
    return Firing(numbers, np.array(angles) - angles[0], cycle)


def _most_even(tops: np.ndarray, cycle: float, z: np.ndarray, name: str = "") -> Firing:
    """Return the firing whose intervals differ least from equal ones; among equal ones the smoothest.

    Smoothest: S_n = |sum_k e^(2 pi i n a_k / cycle)|, the n-th harmonic of equal pulses at the angles a_k, is smallest
    for n = 1, then 2 and so on, since low orders shake most. Of those that are as smooth, the one in which cylinders
    that fire one after the other are farthest apart along the shaft, so that main bearings share the load.
    """
    free = len(tops) - 1
    if cycle > TURN and free > MOST_TRIED:
        raise ModelError(f"engine '{name}': the firing order of {len(tops)} cylinders is not searched for; give it")
    turns = np.arange(2**free if cycle > TURN else 1)
    shift = np.concatenate([np.zeros((len(turns), 1)), turns[:, None] >> np.arange(free) & 1], axis=1)
    fired = np.sort((tops + TURN * shift) % cycle, axis=1)
    intervals = np.diff(fired, append=fired[:, :1] + cycle, axis=1)
    uneven = np.abs(intervals - cycle / len(tops)).max(axis=1)
    pulses = np.exp(2j * math.pi / cycle * fired)
    harmonics = [np.abs((pulses**n).sum(axis=1)) for n in range(1, len(tops) + 1)]
    keys = np.round([*harmonics[::-1], uneven], 6)
    first = np.lexsort(keys)[0]
    alike = np.flatnonzero((keys == keys[:, [first]]).all(axis=0))
    order = np.argsort(np.round((tops + TURN * shift[alike]) % cycle, 9), axis=1, kind="stable")
    apart = np.abs(z[order] - z[np.roll(order, -1, axis=1)]).sum(axis=1)
    best = alike[int(np.argmax(np.round(apart, 9)))]
    angles = tops + TURN * shift[best]
    angles = (angles - angles[0]) % cycle
    angles[cycle - angles < SAME] = 0.0
    order = np.argsort(np.round(angles, 9), kind="stable")
    return Firing(tuple(int(k) + 1 for k in order), angles[order], cycle)
