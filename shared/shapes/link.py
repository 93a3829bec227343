"""Links: the straight bar with two joints, and the plate with any number of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import cadquery as cq

from shared.shapes import outline
from shared.shapes.build import bore, eased, extruded, with_boss
from shared.shapes.solid import placed


@dataclass(frozen=True)
class Eye:
    """One joint of a link (mm): outer radius, bore, and the height of its boss above and below."""

    radius: float
    bore: float
    above: float = 0.0
    below: float = 0.0
    boss: float = 0.0
    """Radius of the boss; 0 takes 2 mm less than ``radius``."""

    @property
    def boss_radius(self) -> float:
        """Radius of the boss (mm)."""
        return self.boss or self.radius - 2.0


def link(
    length: float,
    thickness: float,
    start: Eye,
    end: Eye,
    widths: tuple[float, float],
    fillet: float = 12.0,
    edge: float = 0.8,
    pocket: float = 0.0,
    rim: float = 2.5,
    inner: Sequence[tuple[float, float, Eye]] = (),
) -> cq.Workplane:
    """Return a bar from (0, 0) to (length, 0), between z = 0 and z = thickness.

    It has two through holes, and one an ``inner`` eye.

    The web tapers between ``widths`` and is milled out by ``pocket`` mm on both faces, which leaves a rim and an I
    section. ``inner`` are further eyes (x, y, eye) on it. Raises ValueError if ends, web or pocket do not fit.
    """
    shape = extruded(outline.bar(length, (start.radius, end.radius), widths, fillet), thickness)
    shape = _with_discs(shape, inner, thickness)
    shape = eased(shape, edge)
    if pocket > 0:
        if thickness - 2 * pocket < 1.0:
            raise ValueError(f"pockets of {pocket:g} mm leave less than 1 mm of a web of {thickness:g} mm")
        shape = _milled_out(shape, _pocket_outline(length, start, end, widths, rim), thickness, pocket)
    return with_eyes(shape, [(0.0, 0.0, start), (length, 0.0, end), *inner], thickness, edge)


def plate_link(
    joints: Sequence[tuple[float, float, Eye]],
    thickness: float,
    waist: float = math.inf,
    rims: Sequence[float] | None = None,
    corner: float = 2.5,
    edge: float = 0.8,
    inner: Sequence[tuple[float, float, Eye]] = (),
) -> cq.Workplane:
    """Return a plate from z = 0 to thickness that carries two or more joints.

    Joints are counter-clockwise x, y, eye.

    Its sides curve inwards with radius ``waist``. ``rims`` cuts a window: rims[i] is its distance from the line that
    joins joints i and i + 1. ``inner`` are joints within the plate or on a side of it. Through holes: one a joint, and
    the window; none for an eye without a bore. Raises ValueError if the window has no room.
    """
    holes = [outline.window([(x, y) for x, y, _ in joints], rims, corner)] if rims else []
    shape = extruded(outline.hull([(x, y, eye.radius) for x, y, eye in joints], waist), thickness, holes=holes)
    corners = [(x, y, eye.radius) for x, y, eye in joints]
    out = [(x, y, eye) for x, y, eye in inner if not outline.hull_holds(corners, (x, y, eye.radius))]
    shape = _with_discs(shape, out, thickness)
    return with_eyes(eased(shape, edge), [*joints, *inner], thickness, edge)


def _with_discs(shape: cq.Workplane, eyes: Sequence[tuple[float, float, Eye]], thickness: float) -> cq.Workplane:
    """Return the shape joined with a disc for each eye."""
    for x, y, eye in eyes:
        shape = shape.union(extruded(outline.circle(x, y, eye.radius), thickness))
    return shape


def with_eyes(
    shape: cq.Workplane, joints: Sequence[tuple[float, float, Eye]], thickness: float, edge: float, chamfer: float = 0.4
) -> cq.Workplane:
    """Return the shape with the boss and the bore of each eye."""
    for x, y, eye in joints:
        root = min(1.0, eye.radius - edge - eye.boss_radius - 0.2)  # ends on the flat, short of the rounded edge
        shape = with_boss(shape, x, y, thickness, eye.boss_radius, eye.above, root)
        shape = with_boss(shape, x, y, 0.0, eye.boss_radius, -eye.below, root)
        if eye.bore > 0:
            shape = shape.cut(placed(bore(eye.bore, -eye.below, thickness + eye.above, chamfer), x, y))
    return shape


def _pocket_outline(length: float, start: Eye, end: Eye, widths: tuple[float, float], rim: float) -> cq.Wire:
    """Return a tapered slot that keeps ``rim`` of the web at its sides and of the eyes at its ends."""

    def half_width(x: float) -> float:
        return (widths[0] + (widths[1] - widths[0]) * x / length) / 2 - rim

    first = start.radius + rim
    last = length - end.radius - rim
    r0, r1 = half_width(first), half_width(last)
    first, last = first + r0, last - r1
    if min(r0, r1) < 1.0 or last - first < 1.0:
        raise ValueError(f"a link of {length:g} mm leaves no room for a pocket with a rim of {rim:g} mm")
    return outline.hull([(first, 0.0, r0), (last, 0.0, r1)])


def _milled_out(shape: cq.Workplane, slot: cq.Wire, thickness: float, depth: float) -> cq.Workplane:
    """Cut the slot into both faces with a rounded floor and an eased rim."""
    floor = min(1.2, 0.6 * depth)
    tool = extruded(slot, depth + 1.0).faces("<Z").edges().fillet(floor)
    box = slot.BoundingBox()
    for z, cutter in (
        (thickness, tool.translate((0, 0, thickness - depth))),
        (0.0, tool.mirror("XY").translate((0, 0, depth))),
    ):
        shape = shape.cut(cutter)
        rim = cq.selectors.BoxSelector(
            (box.xmin - 0.01, box.ymin - 0.01, z - 0.01), (box.xmax + 0.01, box.ymax + 0.01, z + 0.01), True
        )
        shape = shape.edges(rim).chamfer(0.3)
    return shape
