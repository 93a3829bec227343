"""How large a stand is: below all that moves, no larger than it needs, and so wide that it does not tip (mm)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mechanisms.stages.automatic.standing.back_plate import BackPlate
    from mechanisms.stages.automatic.standing.standing_masses import Standing

type Span = tuple[float, float]
TIPS = math.tan(math.radians(10.0))
"""A stand that is tilted by less than this, to any side, stands up again."""
CLEAR, CLEARANCE = 6.0, 0.02
"""Least gap under what moves: in units, and as a part of the height over the foot."""
FOOT, FOOT_HEIGHT = 9.0, 0.04
"""Least height of a foot: in units, and as a part of the larger side of what it carries."""
WIDE = 0.3
"""Half the width of a foot that a plate asks for by its looks, as a part of its own."""
AROUND = 14.0
"""Margin of the foot round what stands on it (units)."""
EVEN = 0.3
"""Sides of a foot that differ by less are made equal."""
COLUMN = (0.34, 26.0, 0.8, 0.10)
"""Width of a column, as a part of the plate's: wished, at least (units), at most; and what it grows by to its lower
end, as a part of its free length.
"""
COLUMN_THICK = (10.0, 0.045)
"""Thickness of a column, at least (units), and as a part of its length."""
OVERLAP = 0.66
"""Part of a plate's height to which a column is screwed."""
SCREWS_OF_FOOT = 1.5
"""Height that they take in the lower end of a column, in thicknesses of the plate."""


@dataclass(frozen=True)
class Dimensions:
    """Right, up and towards the viewer; the column stands on the foot and is behind the plate."""

    foot: tuple[Span, Span, Span]
    column: tuple[Span, Span]
    """Up, and towards the viewer."""
    middle: float
    """Middle of the column, right."""
    widths: Span
    """Widths of the column at its lower and upper end."""


def dimensions(plate: BackPlate, load: Standing) -> Dimensions:
    """Dimensions of the stand of a plate and all that it carries."""
    unit, x0, y0, x1, y1 = plate.unit, *plate.corners
    top = max(float(load.high[1]), y1)
    clear = max(CLEAR * unit, CLEARANCE * (top - min(load.moving, y0)))
    others = float(load.low[1]) - (plate.seat if load.moving > load.low[1] else clear)
    over = min(y0 - plate.seat, load.moving - clear, others)
    low, high = over + plate.seat, y0 + OVERLAP * plate.height
    thick = max(COLUMN_THICK[0] * unit, COLUMN_THICK[1] * (high - low))
    part, least, most, grows = COLUMN
    upper = min(max(part * plate.width, least * unit), most * plate.width)
    lower = upper + grows * (y0 - low)
    middle, rear = (x0 + x1) / 2, plate.back - plate.seat - thick
    deep = max(FOOT * unit, FOOT_HEIGHT * max(top - over, plate.width))
    around = AROUND * unit
    right, _, near = foot_spans(load, over - deep)
    half = max(lower / 2 + around, WIDE * plate.width)
    across = evened(min(right[0], middle - half), max(right[1], middle + half), middle)
    along = min(near[0], rear - 0.7 * around), max(near[1], plate.top + around)
    foot = across, (over - deep, over), along
    return Dimensions(foot, ((low, high), (rear, rear + thick)), middle, (lower, upper))


def foot_spans(load: Standing, ground: float) -> tuple[Span, Span, Span]:
    """Where what stands on ``ground`` has to reach, so that it does not tip: right, up, towards the viewer."""
    reach = TIPS * (load.centres[:, 1] - ground)
    spans = [(float((load.centres[:, k] - reach).min()), float((load.centres[:, k] + reach).max())) for k in range(3)]
    return spans[0], spans[1], spans[2]


def evened(low: float, high: float, middle: float) -> Span:
    """From ``low`` to ``high``, made symmetrical about ``middle`` where it nearly is."""
    left, right = middle - low, high - middle
    if abs(left - right) < EVEN * max(left, right):
        left = right = max(left, right)
    return middle - left, middle + right


def screw_places(plate: BackPlate, own: Dimensions, clear: float) -> list[tuple[float, float]]:
    """Where screws of a column go into the plate: near the corners of what they share, ``clear`` (radius) of all holes
    of its face.
    """
    (x0, x1), (y0, y1) = _shared(plate, own, 2.2 * clear)
    grid = [(x, y) for x in np.linspace(x0, x1, 9) for y in np.linspace(y0, y1, 13)]
    free = [
        (float(x), float(y))
        for x, y in grid
        if plate.inside(x, y) > 1.3 * clear
        and all(math.hypot(x - u, y - v) > radius + 1.3 * clear for u, v, radius in plate.holes)
    ]
    chosen: list[tuple[float, float]] = []
    for corner in ((x0, y0), (x1, y1), (x1, y0), (x0, y1)):
        beside = [place for place in free if all(math.dist(place, other) > 4.5 * clear for other in chosen)]
        if beside:
            chosen.append(min(beside, key=lambda place: (round(math.dist(place, corner), 6), place)))
    return chosen


def _shared(plate: BackPlate, own: Dimensions, inset: float) -> tuple[Span, Span]:
    """Right and up: what plate and column share, without its rim."""
    half = own.widths[1] / 2 - inset
    low = max(plate.corners[1], own.column[0][0] + SCREWS_OF_FOOT * plate.thickness) + inset
    high = own.column[0][1] - inset
    if high < low:
        low = high = (low + high) / 2
    return (own.middle - max(half, 0.0), own.middle + max(half, 0.0)), (low, high)
