"""From a plan to solids: plates, base and hardware, at last scaled to millimetres."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.stages.automatic.assembly.body_shape import PlacedEye, body_shape
from mechanisms.stages.automatic.assembly.bores import refuse_meeting_bores
from mechanisms.stages.automatic.assembly.frame import base
from mechanisms.stages.automatic.assembly.kernel_refusals import kernel_refusals
from mechanisms.stages.automatic.assembly.marks import marked
from mechanisms.stages.automatic.assembly.rod_shape import rod_shape
from mechanisms.stages.automatic.assembly.yoke_shape import yoke_shape
from mechanisms.stages.automatic.wheels.gear_solids import shape_of
from shared.shapes.build import extruded
from shared.shapes.link import Eye, with_eyes
from shared.shapes.outline import circle
from shared.shapes.solid import Solid, placed
from shared.stage.console import Shown

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.layout.sizes import Sizes
    from shared.shapes.outline import Circle


def built(plan: Plan, heights: Heights, engraved_too: bool = True) -> dict[str, list[Solid]]:
    """All solids by body, in mm; ``engraved_too``: the base with its names, rule and dial.

    Raises UserError where two bores of a body meet.
    """
    refuse_meeting_bores(plan)
    made: dict[str, list[Solid]] = {"ground": [*base(plan, engraved_too), *plan.solids.get("ground", [])]}
    shown = Shown("parts", plan.layout.m.name, len(plan.layout.moving), "plates shaped")
    for body in plan.layout.moving:
        shown.advance()
        with kernel_refusals(plan.layout.m.name, f"the plate of '{body}'"):
            shape, holes = _plate(plan, body, heights.thickness)
            for tool, through in plan.cuts.get(body, []):
                shape, holes = shape.cut(tool), holes + through
            shape = marked(shape, plan, body, heights.thickness)
        plate = Solid(plan.main[body], placed(shape, z=heights.bottom(body)), plan.materials[body], holes)
        made.setdefault(plan.layout.webs.get(body, body), []).extend([plate, *plan.solids.get(body, [])])
    return {body: [_scaled(solid, plan.layout.sizes) for solid in solids] for body, solids in made.items()}


def fitted(bodies: dict[str, list[Solid]]) -> dict[str, list[Solid]]:
    """The same, marked as pieces whose sizes were chosen for what is made."""
    return {body: [replace(solid, fitted=True) for solid in solids] for body, solids in bodies.items()}


def _plate(plan: Plan, body: str, thickness: float) -> tuple[cq.Workplane, int]:
    """All that is one piece in the layer of a body, and its number of through holes."""
    if body in plan.wheels:
        return _geared(plan, body, thickness)
    eyes = plan.eyes.get(body, [])
    if body in plan.layout.rods:
        return rod_shape(eyes, thickness)
    eyes = [*eyes, *_blanks(plan, body, eyes)]
    plates = plan.plates.get(body, [])
    if not plates:
        slots = plan.slots.get(body, [])
        yoke = yoke_shape(eyes, slots[0], thickness) if len(slots) == 1 else None
        return (yoke, sum(eye.bore > 0 for _, _, eye in eyes)) if yoke else body_shape(eyes, thickness)
    beside = [eye for eye in eyes if not any(_is_held(eye, plate.holds) for plate in plates)]
    shape, holes = plates[0].shape, sum(plate.through_holes for plate in plates)
    for plate in plates[1:]:
        shape = shape.union(plate.shape)
    if not beside and shape.solids().size() == 1:
        return with_eyes(shape, eyes, thickness, 0.0), holes + sum(eye.bore > 0 for _, _, eye in eyes)
    link, own = body_shape(eyes, thickness)
    bores = [(x, y, Eye(eye.radius, eye.bore)) for x, y, eye in eyes]
    return with_eyes(shape.union(link), bores, thickness, 0.0), holes + own


def _geared(plan: Plan, body: str, thickness: float) -> tuple[cq.Workplane, int]:
    """The plate of a body with teeth: a wheel that carries its eyes, or a wheel and a plate round its eyes."""
    eyes, own_wheel = plan.eyes.get(body, []), plan.wheels[body]
    wheel, holes = shape_of(own_wheel, thickness, [(x - own_wheel.x, y - own_wheel.y, eye) for x, y, eye in eyes])
    wheel = placed(wheel, own_wheel.x, own_wheel.y)
    for plate in plan.plates.get(body, []):
        wheel, holes = wheel.union(plate.shape), holes + plate.through_holes
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


def _is_held(eye: PlacedEye, circle: Circle) -> bool:
    return math.hypot(eye[0] - circle[0], eye[1] - circle[1]) + eye[2].radius <= circle[2] + 0.01


def _blanks(plan: Plan, body: str, eyes: list[PlacedEye]) -> list[PlacedEye]:
    """Places that the outline reaches without an eye there."""
    return [
        (anchor.x, anchor.y, Eye(anchor.radius, 0.0))
        for anchor in plan.layout.anchors[body]
        if all(math.hypot(anchor.x - x, anchor.y - y) > 0.01 for x, y, _ in eyes)
    ]


def _scaled(solid: Solid, sizes: Sizes) -> Solid:
    scale = sizes.scale
    if scale == 1.0:
        return solid
    shape = cq.Workplane(obj=solid.shape.val().scale(scale))
    holds = tuple(replace(hold, z=hold.z * scale, radius=hold.radius * scale) for hold in solid.holds)
    roll = solid.rolls
    if roll is not None:
        roll = replace(roll, x=roll.x * scale, y=roll.y * scale, radius=roll.radius * scale)
    return replace(solid, shape=shape, holds=holds, rolls=roll, tolerance=sizes.tolerance)
