"""Layouts by the names that engines go by: ``named("V8")``, ``named("flat-6")``, ``named("radial-5")``.

    I1 .. I6, I8                 in line
    V2, V4, V6, V8, V10, V12     two rods on each throw; V6 with split pins that fire evenly
    VR2 .. VR6                   narrow V of 15 degrees, a throw for each cylinder
    W3, W12, W16, W18            three or four banks
    flat-2, flat-4, flat-6       boxer: a throw for each cylinder, opposite pistons move in and out together
    radial-3 .. radial-9         one throw

Angles are in DEGREES. Other layouts: :func:`mbsd.machines.engines.layout.layout`, by lists of angles.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.machines.engines.layout import Layout
from mbsd.machines.engines.layouts import INLINE_THROWS, boxer, even_split, fan, inline, staggered, vee

V_THROWS: dict[int, tuple[float, ...]] = {
    2: (0,),
    4: (0, 180),
    6: (0, 120, 240),
    8: (0, 90, 270, 180),
    10: INLINE_THROWS[5],
    12: INLINE_THROWS[6],
}
"""By the number of cylinders: those that are built most."""
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
    """The layout of a name, with other angles where these are given.

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
            f"engine '{name}': {len(throws)} throws; it has {len(usual)}, "
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
