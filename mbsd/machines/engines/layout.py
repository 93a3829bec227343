"""Layouts of engines: places of cylinders and throws, by lists of angles or by usual names.

Angles are counted counter-clockwise, as the shaft turns, seen along it against the z axis (rad). The bank of a
cylinder is 0 where it stands upright, along y; a throw is 0 where it points up at the start, so that a piston is at its
top dead centre when shaft angle + throw = bank. Places along the shaft are counted in spacings of neighbouring throws.
:func:`layout` takes lists of angles, :func:`named` names, both in DEGREES:

    I1 .. I6, I8                 in line
    V2, V4, V6, V8, V10, V12     two rods on each throw; V6 with split pins that fire evenly
    VR2 .. VR6                   narrow V of 15 degrees, a throw for each cylinder
    W3, W12, W16, W18            three or four banks
    flat-2, flat-4, flat-6       boxer: a throw for each cylinder, opposite pistons move in and out together
    radial-3 .. radial-9         one throw
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.base.quantity import counted


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
    """Return an engine of N cylinders from lists in DEGREES: bank, throw and place along the shaft.

    ``z`` counts spacings; by default the cylinders stand one behind the other, and the middle is 0. Raises ModelError
    for lists of different lengths and what is no number.
    """
    count = len(banks)
    places = [k - (count - 1) / 2 for k in range(count)] if z is None else z
    if not count or len(throws) != count or len(places) != count:
        raise ModelError(
            f"engine '{name}': {counted(count, 'bank')}, {counted(len(throws), 'throw')} and "
            f"{counted(len(places), 'place')} along the shaft; give one of each for each cylinder"
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


INLINE_THROWS: dict[int, tuple[float, ...]] = {
    1: (0,),
    2: (0, 0),
    3: (0, 120, 240),
    4: (0, 180, 180, 0),
    5: (0, 144, 216, 288, 72),
    6: (0, 120, 240, 240, 120, 0),
    8: (0, 90, 270, 180, 180, 270, 90, 0),
}
"""Throws by their number: the layouts that are built most."""


def inline(throws: Sequence[float]) -> Layout:
    """Return cylinders one behind the other, a throw each: ``inline((0, 180, 180, 0))``."""
    return layout(f"I{len(throws)}", [0.0] * len(throws), throws)


def vee(angle: float, throws: Sequence[float], split: float = 0.0) -> Layout:
    """Return two banks ``angle`` apart, two rods side by side on each throw.

    Cylinders 1, 3, 5 are in the right-hand bank. ``split``: how far the pin of the left-hand cylinder of a throw is
    ahead of that of the right-hand one; :func:`even_split` is the one with which the cylinders fire at equal intervals.
    """
    count = len(throws)
    banks = [side * angle / 2 for _ in throws for side in (-1, 1)]
    pins = [throw + side * split / 2 for throw in throws for side in (-1, 1)]
    places = [k - (count - 1) / 2 for k in range(count) for _ in (-1, 1)]
    return layout(f"V{2 * count}-{angle:g}", banks, pins, places)


def even_split(angle: float, cylinders: int) -> float:
    """Return the split with which the two cylinders of a throw fire evenly.

    They fire one interval of a four-stroke engine apart.
    """
    return angle - 720.0 / cylinders


def boxer(throws: Sequence[float]) -> Layout:
    """Return a boxer: flat, a throw for each cylinder; opposite pistons move in and out together."""
    banks = [-90.0 if k % 2 == 0 else 90.0 for k in range(len(throws))]
    return layout(f"flat-{len(throws)}", banks, throws)


def staggered(angle: float, throws: Sequence[float]) -> Layout:
    """Return a narrow V (VR) with a throw for each cylinder, sides taken in turns."""
    banks = [-angle / 2 if k % 2 == 0 else angle / 2 for k in range(len(throws))]
    return layout(f"VR{len(throws)}-{angle:g}", banks, throws)


def fan(banks: Sequence[float], throws: Sequence[float]) -> Layout:
    """Return several banks with a rod of each on every throw (W, or with one throw a radial engine)."""
    if not banks:
        raise ModelError("engine: a fan needs at least one bank; give the angles of its banks in degrees")
    count = len(throws)
    name = f"W{len(banks) * count}" if count > 1 else f"radial-{len(banks)}"
    places = [k - (count - 1) / 2 for k in range(count) for _ in banks]
    return layout(name, [bank for _ in throws for bank in banks], [t for t in throws for _ in banks], places)


V_THROWS: dict[int, tuple[float, ...]] = {
    2: (0,),
    4: (0, 180),
    6: (0, 120, 240),
    8: (0, 90, 270, 180),
    10: INLINE_THROWS[5],
    12: INLINE_THROWS[6],
}
"""Banks by the number of cylinders: the layouts that are built most."""
V_ANGLES = {2: 90.0, 4: 90.0, 6: 60.0, 8: 90.0, 10: 72.0, 12: 60.0}
BOXER_THROWS: dict[int, tuple[float, ...]] = {2: (0, 180), 4: (0, 180, 180, 0), 6: (0, 180, 120, 300, 240, 60)}
NARROW = 15.0
"""Between the banks of a VR engine."""
W_BANKS = {3: (-60.0, 0.0, 60.0), 12: (-60.0, 0.0, 60.0), 16: (-43.5, -28.5, 28.5, 43.5), 18: (-60.0, 0.0, 60.0)}
NAMES = (
    *(f"I{n}" for n in INLINE_THROWS),
    *(f"V{n}" for n in V_THROWS),
    *(f"VR{n}" for n in (2, 3, 4, 5, 6)),
    *(f"W{n}" for n in W_BANKS),
    *(f"flat-{n}" for n in BOXER_THROWS),
    *(f"radial-{n}" for n in (3, 5, 7, 9)),
)


def named(
    name: str, angle: float | None = None, throws: Sequence[float] | None = None, split: float | None = None
) -> Layout:
    """Return the layout of a name, with other angles where these are given.

    ``angle`` between the banks of V and VR; ``throws`` their directions, of a V engine one for two cylinders; ``split``
    of a V engine: how far the left-hand pin of a throw is ahead, 0 for one common pin. Raises ModelError for an unknown
    name and for angles that the layout has not or that do not fit it.
    """
    if not isinstance(name, str) or name not in NAMES:
        raise ModelError(f"engine: {no_such('layout', str(name), NAMES)}; or give lists of angles with layout(...)")
    family, count = re.fullmatch(r"(\D+?)-?(\d+)", name).groups()  # pyright: ignore[reportOptionalMemberAccess]
    number = int(count)
    _refuse_angles(name, family, angle, split)
    wide = {"V": V_ANGLES.get(number, 0.0), "VR": NARROW}.get(family, 0.0) if angle is None else angle
    usual: Sequence[float] = {
        "I": lambda: INLINE_THROWS[number],
        "V": lambda: V_THROWS[number],
        "VR": lambda: INLINE_THROWS[number],
        "W": lambda: INLINE_THROWS[number // len(W_BANKS[number])],
        "flat": lambda: BOXER_THROWS[number],
        "radial": lambda: (0.0,),
    }[family]()
    if throws is not None and len(throws) != len(usual):
        raise ModelError(
            f"engine '{name}': {counted(len(throws), 'throw')}; it has {len(usual)}, "
            + ("one for two cylinders" if family == "V" else "one for each cylinder" if len(usual) == number else "")
            + f", as {tuple(usual)}"
        )
    used = usual if throws is None else throws
    if family == "V":
        pins = (even_split(wide, number) if number == 6 else 0.0) if split is None else split
        return vee(wide, used, pins)
    if family == "radial":
        return fan([360.0 * k / number for k in range(number)], used)
    if family == "W":
        return fan(W_BANKS[number], used)
    return {"I": inline, "flat": boxer}[family](used) if family != "VR" else staggered(wide, used)


def _refuse_angles(name: str, family: str, angle: float | None, split: float | None) -> None:
    if angle is not None and family not in ("V", "VR"):
        raise ModelError(f"engine '{name}': angle {angle:g}; only V and VR engines have one, so leave it out")
    if split is not None and family != "V":
        raise ModelError(f"engine '{name}': split {split:g}; only V engines share throws, so leave it out")
    if angle is not None and not 0.0 < angle <= 180.0:
        raise ModelError(f"engine '{name}': angle {angle:g} degrees; it must be above 0 and at most 180")


SAME = 1e-6
"""Difference of two angles (rad) or places (spacings) that are the same."""


def cylinders_by_throw(plan: Layout) -> list[list[int]]:
    """Return the indices of the cylinders on each throw; pins that are split are throws of their own."""
    by_throw: dict[tuple[int, int], list[int]] = {}
    for k, cylinder in enumerate(plan.cylinders):
        turned = round(math.remainder(cylinder.throw, 2 * math.pi) / SAME)
        by_throw.setdefault((turned, round(cylinder.z / SAME)), []).append(k)
    return list(by_throw.values())
