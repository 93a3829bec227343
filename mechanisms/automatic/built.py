"""From a plan to solids: plates, base and hardware, at last scaled to millimetres."""

from __future__ import annotations

from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.automatic.body_shape import body_shape
from mechanisms.automatic.frame import base
from shared.shapes.solid import Solid, placed

if TYPE_CHECKING:
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.plan import Plan


def built(plan: Plan, heights: Heights) -> dict[str, list[Solid]]:
    """All solids by body, in mm."""
    made = {"ground": [*base(plan), *plan.solids.get("ground", [])]}
    for body in plan.layout.moving:
        shape, holes = body_shape(plan.eyes[body], heights.thickness)
        plate = Solid(plan.main[body], placed(shape, z=heights.bottom(body)), plan.materials[body], holes)
        made[body] = [plate, *plan.solids.get(body, [])]
    scale = plan.layout.sizes.scale
    return {body: [_scaled(solid, scale) for solid in solids] for body, solids in made.items()}


def _scaled(solid: Solid, scale: float) -> Solid:
    if scale == 1.0:
        return solid
    shape = solid.shape.val()
    return Solid(solid.name, cq.Workplane(obj=shape.scale(scale)), solid.material, solid.through_holes)
