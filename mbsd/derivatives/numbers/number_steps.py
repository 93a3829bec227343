"""How far a number is moved for a derivative: a part of what its mechanism notices, whatever its own value is.

    places, coordinates                  the size of the mechanism
    angles                               1 rad
    lengths                              themselves, from a hundredth of the size to the size
    components of a vector               the vector
    masses, moments of inertia           themselves, or those of the heaviest body where they are next to nothing
    numbers of a law                     what changes the law by as much as it is over the motion, or by a size or 1 rad
    arguments of the author's function   themselves, from a hundredth of their bounds to their bounds
    others                               themselves, or 1 SI unit where they are zero

So a place of 1e-17 m has the step of one of 0.1 m, and so has one at 1 km. Steps are powers of two: what a number is
moved by is then what its difference is divided by, also far from zero.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import ModelError
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, law_with

LEAST = 1e-2
"""Least size of a length, as part of the mechanism's, and of an argument, as part of its bounds."""
NOTHING = 1e-12
"""Numbers below this (SI), masses below this part of the largest, count as zero."""
LENGTHS = ("length", "free_length", "radius", "radius_i", "radius_j")
ANGLES = ("angle", "free_angle", "direction")
LIMITS = ("at", "lower", "upper")
"""Lengths or angles."""
LOOKS = 65
"""Times at which a law is looked at."""
TRIAL = 1e-6
"""Part of a law's number, or of 1, that tells how the law changes."""


def step_of(part: float, size: float) -> float:
    """The power of two next below this ``part`` of the ``size`` of a number: what it is changed by."""
    return 2.0 ** math.floor(math.log2(part * size))


def size_of(number: Number, m: Model, packed: Packed, span: tuple[float, float]) -> float:
    """Return the size of a number of ``m``, which is ``packed``, along a motion over ``span`` (s)."""
    own, last = abs(number.value), number.name.rpartition(".")[2]
    if number.reach:
        return float(np.clip(own, LEAST * number.reach, number.reach))
    if last in ANGLES:
        return 1.0
    if number.is_place:
        return packed.size
    if last in LIMITS:
        return min(packed.size, 1.0)
    if last in LENGTHS or (number.within is not None and number.within.key in LENGTHS):
        return float(np.clip(own, LEAST * packed.size, packed.size))
    if last in ("mass", "inertia"):
        heaviest = float(packed.system.mass.max(initial=0.0)) or 1.0
        largest = heaviest if last == "mass" else heaviest * packed.size**2
        return own if own > NOTHING * largest else largest
    own = max(own, number.vector)
    of_law = _size_in_law(number, m, packed, span)
    if of_law:
        return of_law
    return own if own > NOTHING else 1.0


def _size_in_law(number: Number, m: Model, packed: Packed, span: tuple[float, float]) -> float:
    """The size of a number of a law; 0 of any other, and of one that changes nothing."""
    law = law_with(m, number)
    if law is None:
        return 0.0
    first, last = span
    times = np.linspace(first, last if last > first else first + 1.0, LOOKS)
    away = TRIAL * (abs(number.value) or 1.0)
    values: list[Any] = []
    for value in (number.value - away, number.value, number.value + away):
        try:
            values.append(law(value)(times)[:, 0])
        except (ModelError, ArithmeticError, ValueError):
            return 0.0
    before, now, after = values
    change = float(np.abs(after - before).max()) / (2.0 * away)
    unit, largest = _unit(number, m, packed), float(np.abs(now).max())
    unit = min(unit, largest) if unit and largest else unit or largest
    return unit / change if change > 0.0 and unit > 0.0 else 0.0


def _unit(number: Number, m: Model, packed: Packed) -> float:
    """Return the usual size of the law of a driver, a length or an angle; 0 for a law of a force."""
    driver = None if number.within is None else m.drivers.get(number.within.whole)
    if driver is None:
        return 0.0
    return 1.0 if driver.kind.angular else packed.size
