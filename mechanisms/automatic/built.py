"""From a plan to solids: plates, base and hardware, at last scaled to millimetres."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.automatic.body_shape import PlacedEye, body_shape
from mechanisms.automatic.frame import base
from shared.shapes.build import extruded
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed

if TYPE_CHECKING:
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.plan import Plan


def built(plan: Plan, heights: Heights) -> dict[str, list[Solid]]:
    """All solids by body, in mm."""
    made = {"ground": [*base(plan), *plan.solids.get("ground", [])]}
    for body in plan.layout.moving:
        shape, holes = _plate(plan, body, heights.thickness)
        for tool, through in plan.cuts.get(body, []):
            shape, holes = shape.cut(tool), holes + through
        plate = Solid(plan.main[body], placed(shape, z=heights.bottom(body)), plan.materials[body], holes)
        made[body] = [plate, *plan.solids.get(body, [])]
    scale = plan.layout.sizes.scale
    return {body: [_scaled(solid, scale) for solid in solids] for body, solids in made.items()}


def _plate(plan: Plan, body: str, thickness: float) -> tuple[cq.Workplane, int]:
    """A body's plate and its number of through holes: round its eyes, or a wheel that carries them, or both."""
    eyes = plan.eyes.get(body, [])
    if body not in plan.wheels:
        return body_shape([*eyes, *_blanks(plan, body, eyes)], thickness)
    x, y, wheel, holes = plan.wheels[body]
    wheel = placed(wheel, x, y)
    if not plan.layout.anchors[body]:
        return wheel, holes
    arm = [*eyes, *_blanks(plan, body, eyes)]
    shape, _ = body_shape(
        [(u, v, Eye(eye.radius, 0.0, eye.above, eye.below, eye.boss)) for u, v, eye in arm], thickness
    )
    shape = shape.union(wheel)
    bored = [(u, v, eye) for u, v, eye in eyes if eye.bore > 0]
    for u, v, eye in bored:
        shape = shape.cut(placed(extruded(circle(0, 0, eye.bore / 2), 400.0, -200.0), u, v))
    return shape, len(bored)


def _blanks(plan: Plan, body: str, eyes: list[PlacedEye]) -> list[PlacedEye]:
    """Places that the outline reaches without an eye there."""
    return [
        (anchor.x, anchor.y, Eye(anchor.radius, 0.0))
        for anchor in plan.layout.anchors[body]
        if all(math.hypot(anchor.x - x, anchor.y - y) > 0.01 for x, y, _ in eyes)
    ]


def _scaled(solid: Solid, scale: float) -> Solid:
    if scale == 1.0:
        return solid
    shape = solid.shape.val()
    return Solid(solid.name, cq.Workplane(obj=shape.scale(scale)), solid.material, solid.through_holes)
