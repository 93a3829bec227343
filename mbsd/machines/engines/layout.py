"""Where the cylinders and throws of an engine are.

Angles are counted counter-clockwise, as the shaft turns, seen along it against the z axis (rad). The bank of a
cylinder is 0 where it stands upright, along y; a throw is 0 where it points up at the start, so that a piston is at its
top dead centre when shaft angle + throw = bank. Places along the shaft are counted in spacings of neighbouring throws.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError


@dataclass(frozen=True)
class Cylinder:
    """One cylinder: direction of its axis and of its throw (rad), place along the shaft (spacings)."""

    bank: float
    throw: float
    z: float


@dataclass(frozen=True)
class Layout:
    """Cylinders by their number, from 1 on the front end."""

    name: str
    cylinders: tuple[Cylinder, ...]

    @property
    def banks(self) -> np.ndarray:
        """(N,) directions of the cylinders (rad)."""
        return np.array([cylinder.bank for cylinder in self.cylinders])

    @property
    def throws(self) -> np.ndarray:
        """(N,) directions of the throws (rad)."""
        return np.array([cylinder.throw for cylinder in self.cylinders])

    @property
    def z(self) -> np.ndarray:
        """(N,) places along the shaft, in spacings from the middle."""
        return np.array([cylinder.z for cylinder in self.cylinders])


def layout(name: str, banks: Sequence[float], throws: Sequence[float], z: Sequence[float] | None = None) -> Layout:
    """An engine of N cylinders from lists in DEGREES: bank and throw of each, and its place along the shaft.

    ``z`` counts spacings; by default the cylinders stand one behind the other, and the middle is 0. Raises ModelError
    for lists of different lengths and what is no number.
    """
    count = len(banks)
    places = [k - (count - 1) / 2 for k in range(count)] if z is None else z
    if not count or len(throws) != count or len(places) != count:
        raise ModelError(
            f"engine '{name}': {count} banks, {len(throws)} throws and {len(places)} places along the shaft; "
            "there must be one of each for each cylinder"
        )
    cylinders = []
    for k, (bank, throw, place) in enumerate(zip(banks, throws, places, strict=True), start=1):
        what = f"engine '{name}': cylinder {k}"
        cylinders.append(
            Cylinder(
                math.radians(finite_number(f"{what}: bank", bank)),
                math.radians(finite_number(f"{what}: throw", throw)),
                finite_number(f"{what}: z", place),
            )
        )
    return Layout(name, tuple(cylinders))
