"""Links in one plane: connecting rods with a split big end, and plates round any number of eyes (mm)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.assembly.body_shape import body_shape, first_made
from mechanisms.stages.automatic.shafts.cylinders import SHANK
from shared.shapes.genus import through_holes
from shared.shapes.link import Eye, link
from shared.shapes.rough_box import rough_box
from shared.shapes.solid import placed

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.shafts.bodies.kinds import Link

KERF = 0.03
"""Between a rod and its cap, on either side of the middle."""
WIDTHS = (4.0, 5.1, 4.4, 6.2)
"""Widths of the box that cuts a rod in two, in its reach: with some the kernel fails for no reason of the shape."""


def plate_shape(own: Link, eyes: list[tuple[float, float, Eye]], thickness: float, unit: float) -> cq.Workplane:
    """The plate from z = 0 up; ``unit`` millimetres are one rmm."""
    scaled = [(x / unit, y / unit, Eye(eye.radius / unit, eye.bore / unit)) for x, y, eye in eyes]
    shape, _ = body_shape(scaled, thickness / unit)
    return shape.newObject([shape.val().scale(unit)])


def rod_shape(eyes: list[tuple[float, float, Eye]], thickness: float, bore: float) -> cq.Workplane:
    """A connecting rod from z = 0 up, its big end first in ``eyes``."""
    unit = bore / 100
    (x0, y0, big), (x1, y1, small) = eyes
    length, turn = math.hypot(x1 - x0, y1 - y0) / unit, math.atan2(y1 - y0, x1 - x0)
    start, end = (Eye(eye.radius / unit, eye.bore / unit) for eye in (big, small))
    widths, thick = (200 * SHANK, 160 * SHANK), thickness / unit
    ways: list[Callable[[], cq.Workplane]] = [
        partial(link, length, thick, start, end, widths, fillet, edge=0.8, pocket=pocket, rim=3.0)
        for fillet, pocket in ((16.0, 0.3 * thick), (8.0, 0.3 * thick), (8.0, 0.0), (3.0, 0.0))
    ]
    ways.append(lambda: body_shape([(0.0, 0.0, start), (length, 0.0, end)], thick)[0])
    shape = first_made(ways)
    return placed(shape.newObject([shape.val().scale(unit)]), x0, y0, turn=math.degrees(turn))


type Cut = tuple[tuple[float, float], float, float]
"""Where a link is split, the direction (rad) in which its body lies ahead of that, and how far it reaches."""
type Piece = tuple[cq.Workplane, int]
"""A shape and its number of through holes."""


@lru_cache(maxsize=64)
def rod_pieces(
    eyes: tuple[tuple[float, float, Eye], ...], thickness: float, bore: float, cuts: tuple[Cut, ...]
) -> list[Piece]:
    """A connecting rod and its caps, once for all rods of an engine that are alike; from z = 0 up."""
    return cut_up(rod_shape([*eyes], thickness, bore), cuts)


def cut_up(shape: cq.Workplane, cuts: Sequence[Cut]) -> list[Piece]:
    """What is left of a link, and the cap of each cut."""
    caps = []
    for at, towards, reach in cuts:
        shape, cap = split(shape, at, towards, reach)
        caps.append(cap)
    return [(piece, through_holes(piece)) for piece in (shape, *caps)]


def split(
    shape: cq.Workplane, at: tuple[float, float], towards: float, reach: float
) -> tuple[cq.Workplane, cq.Workplane]:
    """What lies ahead of a line through ``at``, in the direction ``towards`` (rad), and what lies behind it."""
    import cadquery as cq

    low, high = rough_box(shape)
    along = float(low[2] + high[2]) / 2  # a plate may be far along its shaft

    def half(side: float, wide: float) -> cq.Workplane:
        box = cq.Workplane().box(2 * reach, wide * reach, wide * reach).translate((side * (reach + KERF), 0, along))
        return shape.intersect(placed(box, *at, turn=math.degrees(towards)))

    cuts = ((half(1.0, wide), half(-1.0, wide)) for wide in WIDTHS)
    sound = (cut for cut in cuts if all(piece.solids().size() == 1 for piece in cut))
    return next(sound, (half(1.0, WIDTHS[0]), half(-1.0, WIDTHS[0])))


def splits_at(own: Link, x: float, y: float) -> float | None:
    """Direction (rad) in which all other eyes lie ahead of a place; None if some do not."""
    others = [(eye.x - x, eye.y - y) for eye in own.eyes if math.hypot(eye.x - x, eye.y - y) > 1e-6]
    if not others:
        return None
    u, v = sum(o[0] for o in others), sum(o[1] for o in others)
    size = math.hypot(u, v)
    if size < 1e-6 or any(o[0] * u + o[1] * v <= 0.3 * math.hypot(*o) * size for o in others):
        return None
    return math.atan2(v, u)
