"""The usual layouts: in line, V with shared or split pins, flat, W, radial. Angles in DEGREES, as engines are named."""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.errors import ModelError
from mbsd.machines.engines.layout import Layout, layout

INLINE_THROWS: dict[int, tuple[float, ...]] = {
    1: (0,),
    2: (0, 0),
    3: (0, 120, 240),
    4: (0, 180, 180, 0),
    5: (0, 144, 216, 288, 72),
    6: (0, 120, 240, 240, 120, 0),
    8: (0, 90, 270, 180, 180, 270, 90, 0),
}
"""By the number of throws: those that are built most."""


def inline(throws: Sequence[float]) -> Layout:
    """Cylinders one behind the other, a throw each: ``inline((0, 180, 180, 0))``."""
    return layout(f"I{len(throws)}", [0.0] * len(throws), throws)


def vee(angle: float, throws: Sequence[float], split: float = 0.0) -> Layout:
    """Two banks ``angle`` apart with two rods side by side on each throw; cylinders 1, 3, 5 in the right-hand bank.

    ``split``: how far the pin of the left-hand cylinder of a throw is ahead of that of the right-hand one;
    :func:`even_split` is the one with which the cylinders fire at equal intervals.
    """
    count = len(throws)
    banks = [side * angle / 2 for _ in throws for side in (-1, 1)]
    pins = [throw + side * split / 2 for throw in throws for side in (-1, 1)]
    places = [k - (count - 1) / 2 for k in range(count) for _ in (-1, 1)]
    return layout(f"V{2 * count}-{angle:g}", banks, pins, places)


def even_split(angle: float, cylinders: int) -> float:
    """The split with which the two cylinders of a throw fire one interval of a four-stroke engine apart."""
    return angle - 720.0 / cylinders


def boxer(throws: Sequence[float]) -> Layout:
    """Flat with a throw for each cylinder, sides taken in turns: opposite pistons move in and out together."""
    banks = [-90.0 if k % 2 == 0 else 90.0 for k in range(len(throws))]
    return layout(f"flat-{len(throws)}", banks, throws)


def staggered(angle: float, throws: Sequence[float]) -> Layout:
    """Narrow V (VR) with a throw for each cylinder, sides taken in turns."""
    banks = [-angle / 2 if k % 2 == 0 else angle / 2 for k in range(len(throws))]
    return layout(f"VR{len(throws)}-{angle:g}", banks, throws)


def fan(banks: Sequence[float], throws: Sequence[float]) -> Layout:
    """Several banks with a rod of each on every throw (W, or with one throw a radial engine)."""
    if not banks:
        raise ModelError("engine: a fan needs at least one bank; give the angles of its banks in degrees")
    count = len(throws)
    name = f"W{len(banks) * count}" if count > 1 else f"radial-{len(banks)}"
    places = [k - (count - 1) / 2 for k in range(count) for _ in banks]
    return layout(name, [bank for _ in throws for bank in banks], [t for t in throws for _ in banks], places)
