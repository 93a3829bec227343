"""The solids of wheels (rmm): a toothed disc with a milled-out web, a ring or a cup, and what holds them."""

from __future__ import annotations

import math
from functools import singledispatch
from typing import TYPE_CHECKING

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.pins.pins import SAME, Pin
from mechanisms.stages.automatic.wheels.wheels import TUBE, Wheel
from shared.shapes.build import extruded, turned
from shared.shapes.involute import toothed, wire
from shared.shapes.link import Eye
from shared.shapes.outline import circle
from shared.shapes.solid import placed

if TYPE_CHECKING:
    from mechanisms.stages.automatic.layout.layout import Carrier
    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan

WEB = 2.0
"""Depth to which a web is milled out on both faces."""
HUB = 14.0
"""Radius of a hub that stays."""
RIM_WALL = 4.0
POST = 3.2
"""Radius of a post under a ring: it stays under the rim, out of the way of planets that are as high as its top."""
WINDOWS = 5
"""In the bottom of a cup."""
BESIDE = 36.0
"""How far inside of a cup's rim the base plate counts it as standing."""


@build.register(Wheel)
def build_wheel(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """Give the plan the wheel as its body's plate, on its body's plate, or as a piece of the ground."""
    if wheel.body == "ground":
        _on_ground(wheel, plan, heights)
    elif wheel.ring:
        _cup(wheel, plan, heights)
    elif wheel.shares:
        plan.wheels[wheel.body] = wheel
    else:
        _on_tube(wheel, plan, heights)


def _on_ground(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    thickness, seat = heights.thickness, plan.layout.sizes.pivot.fit.seat
    z = heights.bottom(wheel.layer)
    shape, holes = shape_of(wheel, thickness, [])
    if not wheel.ring:
        pivot, here = plan.layout.sizes.pivot, (wheel.x, wheel.y)
        grounded = [pin for pin in plan.layout.features if isinstance(pin, Pin) and pin.on_ground]
        pinned = any(math.dist(pin.places["ground"], here) < SAME for pin in grounded)
        bore = pivot.held if pinned else pivot.bushing + 1.0
        shape = shape.cut(extruded(circle(0, 0, bore / 2), thickness + 2, -1.0))
        post = extruded(circle(0, 0, wheel.root - 1.5), z - 2 * seat, seat, [circle(0, 0, bore / 2)])
        plan.make("ground", f"post_{wheel.name}", placed(post, wheel.x, wheel.y), "aluminium", 1)
        plan.feet.append(Foot("", wheel.x, wheel.y, wheel.root))
        holes += 1
    for k, (x, y) in enumerate(wheel.posts(plan.layout) if wheel.ring else []):
        post = extruded(circle(0, 0, POST), z - 2 * seat, seat)
        plan.make("ground", f"post_{wheel.name}_{k + 1}", placed(post, x, y), "steel", 0)
        plan.feet.append(Foot("", x, y, 6.0))
    plan.make("ground", f"gear_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", holes)


def _on_tube(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """A wheel in a layer of its own: one piece with the tube that reaches to its body's plate."""
    inner, outer = TUBE
    thickness = heights.thickness
    shape, windows = shape_of(wheel, thickness, [(0.0, 0.0, Eye(outer, 0.0))])
    low, high = _to_plate(wheel, plan, heights)
    z = heights.bottom(wheel.layer)
    if high > low:
        tube = extruded(circle(0, 0, outer), high - low + 1.0, low - z - (1.0 if low > z else 0.0))
        shape = shape.union(tube)
    shape = shape.cut(extruded(circle(0, 0, inner), high - low + thickness + 4.0, min(low - z, 0.0) - 2.0))
    plan.make(wheel.body, f"gear_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", 1 + windows)


def _cup(wheel: Wheel, plan: Plan, heights: Heights) -> None:
    """A ring that turns: rim and wall are a piece, the bottom is the body's plate."""
    thickness = heights.thickness
    shape, holes = shape_of(wheel, thickness, [])
    low, high = _to_plate(wheel, plan, heights)
    z = heights.bottom(wheel.layer)
    if high > low:
        wall = extruded(circle(0, 0, wheel.outside), high - low, low - z, [circle(0, 0, wheel.root)])
        shape = shape.union(wall)
    plan.make(wheel.body, f"ring_{wheel.name}", placed(shape, wheel.x, wheel.y, z), "aluminium", holes)
    bottom = extruded(circle(0, 0, wheel.outside), thickness).faces("|Z").edges().chamfer(0.4)
    alone = all(math.hypot(a.x - wheel.x, a.y - wheel.y) < 0.01 for a in plan.layout.anchors[wheel.body])
    eye = plan.layout.sizes.eye
    room = wheel.root - eye - 4.0
    windows = WINDOWS if alone and room > 16.0 else 0
    for k in range(windows):
        at = (wheel.root + eye) / 2 - 1.0
        radius = min(0.38 * room, 0.8 * at * math.sin(math.pi / WINDOWS))
        tool = extruded(circle(at, 0, radius), thickness + 2.0, -1.0)
        bottom = bottom.cut(placed(tool, turn=360.0 * k / WINDOWS))
    holds = (wheel.x, wheel.y, eye + 0.1 if windows else wheel.outside - 0.5)
    plan.plate(wheel.body, placed(bottom, wheel.x, wheel.y), holds, windows)
    way = plan.layout.seen(wheel.body, (wheel.x, wheel.y), "ground")
    if np.ptp(way, axis=0).max() < 0.01:  # the base plate goes on under it
        aside = wheel.outside - BESIDE
        plan.feet += [
            Foot("", float(way[0, 0]) + u, float(way[0, 1]) + v, 1.0) for u in (-aside, aside) for v in (-aside, aside)
        ]


def _to_plate(wheel: Wheel, plan: Plan, heights: Heights) -> tuple[float, float]:
    """From where to where something between the wheel and its body's plate reaches."""
    seat = plan.layout.sizes.pivot.fit.seat
    if heights.bottom(wheel.body) < heights.bottom(wheel.layer):
        return heights.top(wheel.body) + seat, heights.bottom(wheel.layer)
    return heights.top(wheel.layer), heights.bottom(wheel.body) - seat


@singledispatch
def shape_of(wheel: Carrier, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """A wheel about the z axis from z = 0 up, with its eyes, and its number of through holes."""
    raise TypeError(f"{type(wheel).__name__} has no shape")


@shape_of.register(Wheel)
def wheel_shape(wheel: Wheel, thickness: float, eyes: list[tuple[float, float, Eye]]) -> tuple[cq.Workplane, int]:
    """The wheel about the z axis from z = 0 up, with its eyes, and its number of through holes."""
    phase = wheel.phase or 0.0
    if wheel.ring:
        space = phase + math.pi / wheel.teeth
        hole = toothed(wheel.teeth, wheel.module, wheel.root, wheel.tip, -wheel.play / 2, space)
        return extruded(circle(0, 0, wheel.outside), thickness, holes=[wire(hole)]), 1
    outline = toothed(wheel.teeth, wheel.module, wheel.tip, wheel.root, wheel.play / 2, phase)
    return with_hub(extruded(wire(outline), thickness), wheel.root, thickness, eyes)


def with_hub(
    shape: cq.Workplane, root: float, thickness: float, eyes: list[tuple[float, float, Eye]]
) -> tuple[cq.Workplane, int]:
    """A disc of that root radius with a milled-out web and its eyes, and its number of through holes."""
    alone = all(math.hypot(x, y) < 0.01 for x, y, _ in eyes)
    holes = 0
    if alone and root - RIM_WALL > HUB + 5.0:
        shape, holes = _milled(shape, root - RIM_WALL, thickness)
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
