"""Workpieces of machines (mm): blocks, crates, sheets of paper, and standing cups and bottles.

In the plane x points right and y up; z is the height over the base, towards the viewer.
"""

from __future__ import annotations

from collections.abc import Sequence

import cadquery as cq

from shared.shapes.build import eased, extruded, turned
from shared.shapes.outline import Point, rounded_rectangle

type Box = tuple[float, float, float, float]
"""Left, lower, right and upper side in the plane."""


def prism(corners: Sequence[Point], low: float, high: float, edge: float = 0.0) -> cq.Workplane:
    """Return a plate with these corners between two heights, its upper edges chamfered by ``edge``."""
    outline = cq.Wire.makePolygon([cq.Vector(x, y, 0.0) for x, y in corners], close=True)
    return eased(extruded(outline, high - low, low), edge, ">Z", chamfer=True)


def block(box: Box, low: float, high: float, edge: float = 1.0) -> cq.Workplane:
    """Return a block, the edges of its upper face chamfered."""
    return eased(_box(box, low, high), edge, chamfer=True, faces=">Z")


def crate(box: Box, low: float, high: float, boards: int = 4) -> cq.Workplane:
    """Return a crate of level boards between two posts.

    Grooves part them, and a frame stands out at either end.
    """
    x0, y0, x1, y1 = box
    tall, wide, deep = (y1 - y0) / boards, 0.14 * (x1 - x0), 0.06 * (high - low)
    shape = _box(box, low, high - deep)
    gap = 0.05 * tall
    for k in range(1, boards):
        y = y0 + k * tall
        shape = shape.cut(_box((x0 - 1.0, y - gap, x1 + 1.0, y + gap), high - 2 * deep, high))
    for left in (x0, x1 - wide):
        shape = shape.union(_box((left, y0, left + wide, y1), low, high))
    return shape


def sheet(box: Box, low: float, thick: float = 0.6, corner: float = 1.0) -> cq.Workplane:
    """Return a sheet of paper that lies at a height."""
    return extruded(rounded_rectangle(*box, corner), thick, low)


def standing(profile: Sequence[tuple[float, ...]], x: float, y: float, z: float, scale: float = 1.0) -> cq.Workplane:
    """Return a closed profile turned about an axis that points up in the plane.

    The profile (radius, height) is that of :func:`turned`; the axis begins at (x, y) at height z over the base.
    """
    upright = turned([tuple(scale * value for value in entry) for entry in profile])
    return upright.rotate((0, 0, 0), (1, 0, 0), -90.0).translate((x, y, z))


def pen(low: float, high: float, radius: float) -> cq.Workplane:
    """Return a pen about the z axis that writes at a height ``low`` and is held at ``high``."""
    nib = min(4.0 * radius, 0.5 * (high - low))
    return turned([(0, low), (0.25 * radius, low), (radius, low + nib), (radius, high), (0, high)])


CUP = (
    (0.0, 0.0), (0.62, 0.0), (0.66, 0.08), (0.60, 0.16), (0.92, 0.70, 1.0, 1.5), (0.90, 1.5), (0.82, 0.76, 0.5, 0.26),
    (0.0, 0.26),
)  # fmt: skip
"""Profile of a cup of radius 1: it is open at its upper end."""
TEA = ((0.0, 0.265), (0.495, 0.265), (0.745, 0.72, 0.84, 1.1), (0.0, 1.1))
"""Profile of the tea in the cup."""


def _box(box: Box, low: float, high: float) -> cq.Workplane:
    x0, y0, x1, y1 = box
    return cq.Workplane().box(x1 - x0, y1 - y0, high - low, centered=False).translate((x0, y0, low))
