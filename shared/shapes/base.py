"""The frame: base plate, pedestals and feet."""

from __future__ import annotations

import math
from collections.abc import Sequence

import cadquery as cq

from shared.shapes import outline
from shared.shapes.build import bore, built_once, eased, extruded, turned
from shared.shapes.solid import placed


def base_plate(
    corners: tuple[float, float, float, float],
    thickness: float,
    corner: float,
    counterbores: Sequence[tuple[float, float]] = (),
    screw: float = 5.0,
    head: tuple[float, float] = (9.0, 5.4),
    tapped: Sequence[tuple[float, float, float, float]] = (),
    edge: float = 1.2,
) -> cq.Workplane:
    """Return a plate (x0, y0, x1, y1) with its top at z = 0 and its underside at z = -thickness.

    ``counterbores`` are through holes for screws of diameter ``screw``, with room for a ``head`` (diameter, depth);
    ``tapped`` are blind holes (x, y, diameter, depth). Through holes: the counterbores.
    """
    shape = extruded(outline.rounded_rectangle(*corners, corner), thickness, -thickness)
    shape = eased(shape, edge, ">Z", chamfer=True)
    shape = eased(shape, edge / 2, "<Z", chamfer=True)
    through = bore(screw + 0.5, -thickness, 0, 0)
    seat = turned([(0, -head[1]), (head[0] / 2, -head[1]), (head[0] / 2, -0.4), (head[0] / 2 + 0.9, 0.5), (0, 0.5)])
    for x, y in counterbores:
        shape = shape.cut(placed(through, x, y)).cut(placed(seat, x, y))
    for x, y, diameter, depth in tapped:
        drill = turned([(0, -depth), (diameter / 2, -depth), (diameter / 2, 0.5), (0, 0.5)])
        shape = shape.cut(placed(drill, x, y))
    return shape


@built_once
def pedestal(
    height: float,
    hole: float,
    top: float,
    foot: float,
    flange: float,
    flange_thickness: float,
    screws: int,
    screw: float,
    circle: float,
    root: float = 2.0,
    start: float = 90.0,
) -> cq.Workplane:
    """Return a bearing pedestal from z = 0 to height (mm, diameters).

    A flange held by ``screws`` screws on a pitch circle carries a column that tapers from ``foot`` to ``top``; the
    bore goes right through. Through holes: 1 + screws.
    """
    r, f, w, t = hole / 2, flange / 2, foot / 2, flange_thickness
    bend = root * (1 - math.cos(math.pi / 4))
    shape = turned(
        [
            (r, 0.4),
            (r + 0.4, 0),
            (f - 0.4, 0),
            (f, 0.4),
            (f, t - 0.7),
            (f - 0.7, t),
            (w + root, t),
            (w + bend, t + bend, w, t + root),
            (top / 2, height - 0.6),
            (top / 2 - 0.6, height),
            (r + 0.4, height),
            (r, height - 0.4),
        ]
    )
    tool = bore(screw + 0.4, 0, t, 0.2)
    for x, y in bolt_circle(circle, screws, start):
        shape = shape.cut(placed(tool, x, y))
    return shape


def column(height: float, hole: float, top: float, foot: float) -> cq.Workplane:
    """Return a plain post from z = 0 to height (mm), with its bore right through.

    It tapers from diameter ``foot`` to ``top``.
    """
    r = hole / 2
    return turned(
        [
            (r, 0.4),
            (r + 0.4, 0),
            (foot / 2 - 0.4, 0),
            (foot / 2, 0.4),
            (top / 2, height - 0.6),
            (top / 2 - 0.6, height),
            (r + 0.4, height),
            (r, height - 0.4),
        ]
    )


@built_once
def foot(diameter: float, height: float, hole: float) -> cq.Workplane:
    """Return a round tapered foot below z = 0, with a hole for its screw: one through hole."""
    r, a = diameter / 2, hole / 2
    return turned([(a, -height), (r - 1.2, -height), (r - 0.6, -height + 0.6), (r, -0.2), (r - 0.2, 0), (a, 0)])


def bolt_circle(diameter: float, count: int, start: float = 90.0) -> list[tuple[float, float]]:
    """Return points (x, y) on a pitch circle, the first at ``start`` degrees."""
    angles = [math.radians(start + 360.0 * i / count) for i in range(count)]
    return [(diameter / 2 * math.cos(a), diameter / 2 * math.sin(a)) for a in angles]
