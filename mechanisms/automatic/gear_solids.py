"""The solids of wheels (rmm): a toothed disc with a milled-out web, a ring, and what holds them on ground."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import cadquery as cq

from mechanisms.automatic.plan import Foot
from shared.shapes.build import extruded, turned
from shared.shapes.involute import toothed, wire
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.automatic.gears import Wheel
    from mechanisms.automatic.heights import Heights
    from mechanisms.automatic.plan import Plan

WEB = 2.0
"""Depth to which a web is milled out on both faces."""
HUB = 14.0
"""Radius of a hub that stays."""
RIM_WALL = 4.0


def build_wheel(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """Give the plan the wheel as its body's plate, or make it a piece of the ground."""
    thickness = heights.thickness
    if wheel.body != "ground":
        eyes = [(x - wheel.x, y - wheel.y, eye) for x, y, eye in plan.eyes.get(wheel.body, [])]
        plan.wheels[wheel.body] = (wheel.x, wheel.y, *wheel_shape(wheel, thickness, eyes))
        return
    seat = plan.layout.sizes.pivot.fit.seat
    z = heights.bottoms[heights.levels[wheel.layer]]
    shape, holes = wheel_shape(wheel, thickness, [])
    if not wheel.ring:
        bore = plan.layout.sizes.pivot.bushing + 1.0
        shape = shape.cut(extruded(circle(0, 0, bore / 2), thickness + 2, -1.0))
        post = extruded(circle(0, 0, wheel.root - 1.5), z - 2 * seat, seat, [circle(0, 0, bore / 2)])
        plan.make("ground", f"post_{wheel.name}", placed(post, wheel.x, wheel.y), "aluminium", 1)
        plan.feet.append(Foot("", wheel.x, wheel.y, wheel.root))
        holes = 1
    for k, (x, y) in enumerate(wheel.posts() if wheel.ring else []):
        post = extruded(circle(0, 0, 4.0), z - 2 * seat, seat)
        plan.make("ground", f"post_{wheel.name}_{k + 1}", placed(post, x, y), "steel", 0)
        plan.feet.append(Foot("", x, y, 6.0))
    plan.make("ground", f"gear_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", holes)


def wheel_shape(wheel: Wheel, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """The wheel about the z axis from z = 0 up, with its eyes, and its number of through holes."""
    phase = wheel.phase or 0.0
    if wheel.ring:
        space = phase + math.pi / wheel.teeth
        hole = toothed(wheel.teeth, wheel.module, wheel.root, wheel.tip, -wheel.play / 2, space)
        return extruded(circle(0, 0, wheel.outside), thickness, holes=[wire(hole)]), 1
    outline = toothed(wheel.teeth, wheel.module, wheel.tip, wheel.root, wheel.play / 2, phase)
    shape = extruded(wire(outline), thickness)
    alone = all(math.hypot(x, y) < 0.01 for x, y, _ in eyes)
    holes = 0
    if alone and wheel.root - RIM_WALL > HUB + 5.0:
        shape, holes = _milled(shape, wheel.root - RIM_WALL, thickness)
    for x, y, eye in eyes:
        if eye.above > 0:
            boss = extruded(circle(x, y, eye.boss_radius), eye.above + 1.0, thickness - 1.0)
            shape = shape.union(boss)
        if eye.below > 0:
            shape = shape.union(extruded(circle(x, y, eye.boss_radius), eye.below + 1.0, -eye.below))
        if eye.bore > 0:
            depth = thickness + eye.above + eye.below + 2.0
            shape = shape.cut(extruded(circle(x, y, eye.bore / 2), depth, -eye.below - 1.0))
            holes += 1
    return shape, holes


def _milled(shape: cq.Workplane, outer: float, thickness: float) -> tuple[cq.Workplane, int]:
    """A web between hub and rim, with round windows where there is room."""
    for z0, z1 in ((thickness - WEB, thickness + 1.0), (-1.0, WEB)):
        shape = shape.cut(turned([(HUB, z0), (outer, z0), (outer, z1), (HUB, z1)]))
    room = outer - HUB - 4.0
    if room < 8.0:
        return shape, 0
    middle, radius = (outer + HUB) / 2, 0.5 * room
    count = min(6, int(math.pi / math.asin(min((radius + 2.0) / middle, 1.0))))
    if count < 3:
        return shape, 0
    for k in range(count):
        angle = 2 * math.pi * k / count
        at = circle(middle * math.cos(angle), middle * math.sin(angle), radius)
        shape = shape.cut(extruded(at, thickness + 2.0, -1.0))
    return shape, count
