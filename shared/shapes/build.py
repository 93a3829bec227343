"""Building steps that shapes share: extrude an outline, turn a profile, cut bores, ease edges."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, wraps

import cadquery as cq

from shared.shapes.outline import circle

# Cache of built solids, since screws, washers and bushings of the same numbers occur many times.


def built_once[**P](builder: Callable[P, cq.Workplane]) -> Callable[P, cq.Workplane]:
    """Return a builder that builds once for the same arguments; each call gives its own Workplane."""

    @cache
    def solid(*args: P.args, **kwargs: P.kwargs) -> cq.Shape:
        return builder(*args, **kwargs).val()  # pyright: ignore[reportReturnType]  (a builder's value is a shape)

    @wraps(builder)
    def build_once(*args: P.args, **kwargs: P.kwargs) -> cq.Workplane:
        return cq.Workplane(obj=solid(*args, **kwargs))

    return build_once


def extruded(outline: cq.Wire, height: float, z: float = 0.0, holes: Sequence[cq.Wire] = ()) -> cq.Workplane:
    """Return a prism on ``outline`` from z to z + height, without the ``holes``."""
    solid = cq.Solid.extrudeLinear(outline, list(holes), cq.Vector(0, 0, height))
    return cq.Workplane(obj=solid.translate(cq.Vector(0, 0, z)))


def turned(profile: Sequence[tuple[float, ...]]) -> cq.Workplane:
    """Turn a closed profile about the z axis.

    Entries are (r, z) corners; an entry (rm, zm, r, z) is an arc to (r, z) through (rm, zm).
    """
    work = cq.Workplane("XZ").moveTo(profile[0][0], profile[0][1])
    for entry in profile[1:]:
        if len(entry) == 2:
            work = work.lineTo(*entry)
        else:
            work = work.threePointArc((entry[0], entry[1]), (entry[2], entry[3]))
    return work.close().revolve(360, (0, 0, 0), (0, 1, 0))


def bore(diameter: float, z0: float, z1: float, chamfer: float = 0.0) -> cq.Workplane:
    """Return the tool that cuts a hole from z0 to z1 on the axis, with a chamfer at both mouths."""
    r, c, over = diameter / 2, chamfer, 0.5
    if c == 0:
        return extruded(circle(0, 0, r), z1 - z0 + 2 * over, z0 - over)
    wide = r + c + over
    return turned([(0, z0 - over), (wide, z0 - over), (r, z0 + c), (r, z1 - c), (wide, z1 + over), (0, z1 + over)])


def eased(shape: cq.Workplane, size: float, faces: str = "|Z", chamfer: bool = False) -> cq.Workplane:
    """Round (or chamfer) every edge of the selected faces by ``size``; 0 leaves them."""
    if size <= 0:
        return shape
    edges = shape.faces(faces).edges()
    return edges.chamfer(size) if chamfer else edges.fillet(size)


def with_boss(
    shape: cq.Workplane, x: float, y: float, z: float, radius: float, height: float, root: float, edge: float = 0.5
) -> cq.Workplane:
    """Add a round boss on the flat face at height z, with a fillet ``root`` at its foot and a rounded rim.

    ``height`` below 0 is a boss on the lower face. ``root`` is kept below the boss's height.
    """
    if height == 0:
        return shape
    up = 1.0 if height > 0 else -1.0
    reach = abs(height)
    cylinder = cq.Solid.makeCylinder(radius, reach + 1.0, cq.Vector(x, y, z - up), cq.Vector(0, 0, up))
    cap = f"{'>' if up > 0 else '<'}Z"
    boss = cq.Workplane(obj=cylinder)
    if edge > 0:
        boss = boss.faces(cap).edges().fillet(min(edge, 0.4 * reach))
    shape = shape.union(boss)
    root = min(root, 0.45 * reach)
    if root <= 0:
        return shape
    foot = [
        e
        for e in shape.edges("%CIRCLE").vals()
        if abs(e.Center().z - z) < 1e-6
        and abs(e.radius() - radius) < 1e-6
        and abs(e.arcCenter().x - x) < 1e-6
        and abs(e.arcCenter().y - y) < 1e-6
    ]
    return shape.newObject(foot).fillet(root)
